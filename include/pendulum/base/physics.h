// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace pendulum {

inline constexpr double kPi = std::numbers::pi;

inline constexpr double kRadFromDeg = kPi / 180.0;

/// m/s^2, where nobody tells the local one (3rd CGPM, 1901); at sea level it is between 9.780 and 9.833.
inline constexpr double kStandardGravity = 9.80665;

}  // namespace pendulum
