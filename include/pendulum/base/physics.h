// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace pendulum {

inline constexpr double kPi = std::numbers::pi;

inline constexpr double kRadFromDeg = kPi / 180.0;

/// Standard gravity [m/s^2], the default when the local value is not given (3rd CGPM, 1901). At sea level the local
/// value is between 9.780 and 9.833.
inline constexpr double kStandardGravity = 9.80665;

}  // namespace pendulum
