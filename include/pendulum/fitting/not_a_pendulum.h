// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/fitting/fit.h"

namespace pendulum {

/// Why a recording is that of a linear oscillator, in a sentence with numbers, or nothing: linear gravity describes it
/// much better than sine gravity, both with the richest friction. `report` is a fit that lacks fit. Cost: two small
/// fits.
std::optional<std::string> WhyLinear(const Recording& recording, const FitReport& report);

/// The same for two modes: much of what the richest law leaves is one oscillation at another frequency than the
/// swing's.
std::optional<std::string> WhyTwoModes(const Recording& recording, const FitReport& report);

}  // namespace pendulum
