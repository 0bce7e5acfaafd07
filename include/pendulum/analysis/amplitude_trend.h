// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/part_fit.h"

namespace pendulum {

/// Fits windows between these ends of half swings [s, file's clock] (CutEvenly) and puts them and their trends with
/// amplitude into the result. Returns why there is no trend; empty when there is.
std::string CompareWindows(const Recording& used, const Parts& parts, const std::vector<double>& ends,
                           const FitReport& fit, const FitOptions& options, Constancy& result);

}  // namespace pendulum
