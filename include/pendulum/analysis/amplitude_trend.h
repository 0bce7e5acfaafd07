// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/part_fit.h"

namespace pendulum {

/// Cuts windows at `ends` of half swings [s, file's clock] (CutEvenly) and fits them. Adds the windows and their trends
/// with amplitude to the result. Returns the reason if there is no trend, otherwise an empty string.
std::string CompareWindows(const Recording& used, const Parts& parts, const std::vector<double>& ends,
                           const FitReport& fit, const FitOptions& options, Constancy& result);

}  // namespace pendulum
