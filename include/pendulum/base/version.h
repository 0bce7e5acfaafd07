// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// The version of this library and its tools; project(VERSION) in CMakeLists.txt says the same, and a test compares
/// them.
inline constexpr std::string_view kVersion = "0.1.0";

}  // namespace pendulum
