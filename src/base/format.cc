// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/format.h"

#include <array>
#include <charconv>

namespace pendulum {

std::string NumberText(double value, int significant_digits) {
  std::array<char, 64> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, significant_digits);
  return {text.data(), end};
}

std::string NumberText(double value) {
  constexpr std::size_t kLongest = 32;  // "-2.2250738585072014e-308" has 24 characters.
  std::array<char, kLongest> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

}  // namespace pendulum
