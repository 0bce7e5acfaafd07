// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace pendulum {

/// Processes are filtered side by side in lanes: their recursions do not wait for each other and fill vector registers.
inline constexpr int kLanes = 8;
using Lanes = std::array<double, kLanes>;

}  // namespace pendulum
