// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/closed_form/half_swings.h"

namespace pendulum {

/// Period of an undamped pendulum over its small-angle period: (2/π) K(sin(A/2)), by the arithmetic-geometric mean.
/// MODEL.md eq. (20). amplitude A in rad, |A| < π.
double PeriodRatio(double amplitude);

/// The angle amplitude [rad] that goes with the amplitude of a reading: itself for an angle, 2 asin(ω_peak / 2 ω0) for
/// the peak of a rate (MODEL.md eq. (21)), at most 3.1 rad. With linear gravity ω_peak / ω0, and no limit.
double AngleAmplitude(Quantity quantity, double amplitude, double natural_frequency, Gravity gravity = Gravity::kSine);

/// Small-angle natural frequency ω0 [rad/s] from the crossings, whose spacing is (π/ω0) PeriodRatio(amplitude between
/// them). Friction enters to second order, ω_d = ω0 sqrt(1 - ζ²).
double NaturalFrequency(const HalfSwingTable& table);

}  // namespace pendulum
