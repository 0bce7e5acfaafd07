// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <boost/math/special_functions/jacobi_elliptic.hpp>

namespace pendulum {

/// I_O / G of the reference rig [s^2]: 0.079 kg m² and 1.803 N m, the published fit of the activity "Modeling of a
/// Simple Pendulum" (Control Tutorials for MATLAB and Simulink).
inline constexpr double kReferenceInertia = 0.079 / 1.803;

/// θ [rad] at t s after an undamped pendulum was released at `amplitude`: sin(θ/2) = k cd(t / √I, k), k = sin(A/2)
/// (Abramowitz & Stegun, Handbook of Mathematical Functions, chapter 16). Computed in long double, because 1 - k²
/// cancels near 180 deg.
inline double UndampedAngle(double amplitude, double inertia, double time) {
  const long double modulus = std::sin(0.5L * amplitude);
  const long double phase = time / std::sqrt(static_cast<long double>(inertia));
  return static_cast<double>(2 * std::asin(modulus * boost::math::jacobi_cd(modulus, phase)));
}

}  // namespace pendulum
