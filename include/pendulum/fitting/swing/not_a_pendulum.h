// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "pendulum/fitting/fit/fit.h"

namespace pendulum {

/// A motion whose period does not depend on its amplitude.
struct LinearMotion {
  std::string why;     ///< With numbers.
  std::string advice;  ///< The flags that may help.
};

/// Checks for a linear oscillator: linear gravity describes the recording much better than sine gravity, both with the
/// richest friction. Returns std::nullopt otherwise, and after a stop request. `report` is a fit with lack of fit.
/// Cost: two small fits.
std::optional<LinearMotion> FindLinearMotion(const Recording& recording, const FitReport& report,
                                             const std::stop_token& stop = {});

/// Why readings in this unit are beyond doubt, in a sentence; std::nullopt if angles in rad may be in degrees. The
/// period of small swings in degrees, taken for rad, would not depend on the amplitude either.
std::optional<std::string> ReasonForUnit(const Recording& recording);

/// Checks for two modes: much of the richest law's residual oscillates at one frequency different from the swing's.
/// Returns the reason in a sentence with numbers; std::nullopt otherwise, and after a stop request.
std::optional<std::string> TwoModesReason(const Recording& recording, const FitReport& report,
                                          const std::stop_token& stop = {});

}  // namespace pendulum
