// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pendulum/closed_form/turning_points.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The angle amplitude [rad] that belongs to the amplitude of a reading. For an angle it is the amplitude itself, for
/// the peak of a rate 2 asin(ω_peak / 2 ω0), at most 3.1 rad (MODEL.md eq. (6.2)). Linear gravity has no highest point
/// and no limit.
double AngleAmplitude(Quantity quantity, double amplitude, double natural_frequency, Gravity gravity = Gravity::kSine);

/// The time at which the reading passes the table's zero between turning points `point` - 1 and `point` [s, the
/// recording's clock].
double ZeroCrossing(const Recording& recording, const TurningPointTable& table, std::size_t point);

/// Small-angle natural frequency ω0 [rad/s] from the zero crossings, whose spacing is (π/ω0) PeriodRatio(amplitude
/// between them). Friction changes it only to second order, ω_d = ω0 sqrt(1 - ζ²). table: FindTurningPoints(recording).
/// kFailedPrecondition: no two half swings without a gap follow each other.
Result<double> NaturalFrequency(const Recording& recording, const TurningPointTable& table, Gravity gravity);

}  // namespace pendulum
