// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/format.h"

#include <array>
#include <charconv>

namespace pendulum {

std::string FormatNumber(double value, int significant_digits) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.begin(), text.end(), value, std::chars_format::general, significant_digits).ptr;
  return {text.begin(), end};
}

}  // namespace pendulum
