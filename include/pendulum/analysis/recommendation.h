// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// Sets `recommended` and its reason from the rows: of the models within kWithinBic of the smallest BIC the one of the
/// fewest physical parameters, then of the smallest BIC; none where there is no criterion. A model whose residuals are
/// more than noise is passed over when it does not predict better than simpler ones (MODEL.md section 9).
void Recommend(const std::vector<FitReport>& fits, Comparison& comparison);

}  // namespace pendulum
