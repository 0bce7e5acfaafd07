// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The readings without motion faster than 1 / length [Hz]: twice the mean over `length` [s] around each sample. An
/// oscillation with this period disappears, and one n times as slow keeps (sin(π/n) / (π/n))² of its amplitude. Turning
/// points stay at their times. Cost: O(N).
Recording LowBand(const Recording& recording, double length);

/// Twice the lower quartile of the times between turning points [s], as a length for LowBand.
double FastestPeriod(const TurningPointTable& table);

/// Lets a swing begin after a vibration with the period `length` [s], if it has died away early enough to leave most of
/// the swing. Otherwise sets swing.vibration to what remains of it; std::nullopt if it is within the noise.
void LeaveOutVibration(const Recording& recording, double noise, double length, FreeSwing& swing);

}  // namespace pendulum
