// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// Sets `recommended` and its reason from the rows. Among the models within kWithinBic of the smallest BIC it chooses
/// the one with the fewest physical parameters, then the smallest BIC. There is no recommendation without a criterion.
/// A model with more than noise in its residuals is skipped if it does not predict better than simpler ones (MODEL.md
/// section 9).
void Recommend(const std::vector<FitReport>& fits, Comparison& comparison);

}  // namespace pendulum
