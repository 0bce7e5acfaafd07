// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace pendulum {

inline constexpr double kPi = std::numbers::pi;

inline constexpr double kRadFromDeg = kPi / 180.0;

}  // namespace pendulum
