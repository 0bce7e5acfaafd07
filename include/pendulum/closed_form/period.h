// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/closed_form/half_swings.h"

namespace pendulum {

/// Period of an undamped pendulum divided by its small-angle period: (2/π) K(sin(A/2)), by the arithmetic-geometric
/// mean. MODEL.md eq. (6.1). amplitude A in rad, |A| < π.
double PeriodRatio(double amplitude);

/// The angle amplitude [rad] that belongs to the amplitude of a reading. For an angle it is the amplitude itself, for
/// the peak of a rate 2 asin(ω_peak / 2 ω0), at most 3.1 rad (MODEL.md eq. (6.2)). With linear gravity it is ω_peak /
/// ω0, without a limit.
double AngleAmplitude(Quantity quantity, double amplitude, double natural_frequency, Gravity gravity = Gravity::kSine);

/// Small-angle natural frequency ω0 [rad/s] from the crossings, whose spacing is (π/ω0) PeriodRatio(amplitude between
/// them). Friction changes it only to second order, ω_d = ω0 sqrt(1 - ζ²).
double NaturalFrequency(const HalfSwingTable& table);

}  // namespace pendulum
