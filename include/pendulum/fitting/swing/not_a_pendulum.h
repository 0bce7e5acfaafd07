// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "pendulum/fitting/fit/fit.h"

namespace pendulum {

/// Why a recording is that of a linear oscillator, in a sentence with numbers, or nothing: linear gravity describes it
/// much better than sine gravity, both with the richest friction. `report` lacks fit. Nothing, too, once a stop is
/// requested. Cost: two small fits.
std::optional<std::string> WhyLinear(const Recording& recording, const FitReport& report,
                                     const std::stop_token& stop = {});

/// The same for two modes: much of what the richest law leaves oscillates at one frequency, which is not the swing's.
std::optional<std::string> WhyTwoModes(const Recording& recording, const FitReport& report,
                                       const std::stop_token& stop = {});

}  // namespace pendulum
