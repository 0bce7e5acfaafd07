// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The swing with the part of its hold that is as steady as the readings of the swing, whose noise is `sigma`; slow
/// noise looks like a drift to the search for free swings, which does not know it. std::nullopt if there is no such
/// part.
std::optional<FreeSwing> WithSteadyHold(const Recording& recording, const FreeSwing& swing, double sigma);

}  // namespace pendulum
