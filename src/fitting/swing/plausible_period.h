// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Why the period of a swing is not that of a pendulum, and what to do; std::nullopt if it is, or if the rig or the
/// options say how large the inertia is. A linear oscillator may have any period.
std::optional<std::string> ImplausiblePeriodReason(const Recording& recording, const FreeSwing& swing,
                                                   const FitOptions& options);

}  // namespace pendulum
