// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/fitting/fit.h"

namespace pendulum {

/// A sentence with numbers that says why a recording is that of a linear oscillator, whose period does not depend on
/// the amplitude, or nothing: linear gravity leaves less than half of what sine gravity leaves with the richest
/// friction. `report` is a fit of `recording` that lacks fit. Cost: two fits of a few thousand samples.
std::optional<std::string> WhyLinear(const Recording& recording, const FitReport& report);

/// The same for two modes: much of what the richest law leaves is one oscillation at another frequency than the
/// swing's. Cost: one fit of a few thousand samples and a periodogram, some 10 ms.
std::optional<std::string> WhyTwoModes(const Recording& recording, const FitReport& report);

}  // namespace pendulum
