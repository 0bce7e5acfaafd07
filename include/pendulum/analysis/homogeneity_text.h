// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/homogeneity.h"

namespace pendulum {

/// Sentences that say whether the recordings agree, which one does not, and the explanation.
std::string DescribeHomogeneity(const Homogeneity& result, const std::vector<RunAlone>& runs);

}  // namespace pendulum
