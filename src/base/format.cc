// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/format.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace pendulum {
namespace {

/// True when `text` begins with a letter such as ° or θ: two bytes of valid UTF-8 that control no terminal.
bool StartsWithLetterBeyondAscii(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  return text.size() > 1 && byte(0) >= 0xC2 && byte(0) <= 0xDF && (byte(1) & 0xC0) == 0x80 &&
         (byte(0) > 0xC2 || byte(1) >= 0xA0);
}

}  // namespace

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

std::string ProbabilityText(double p) {
  constexpr double kSmallest = 1e-99;
  return p < kSmallest ? "< 1e-99" : NumberText(p, 2);
}

std::string DegreesOfFreedomText(int degrees) {
  return std::to_string(degrees) + (degrees == 1 ? " degree of freedom" : " degrees of freedom");
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string shown = "\"";
  for (std::size_t i = 0; i < std::min(text.size(), kShown); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (StartsWithLetterBeyondAscii(text.substr(i))) {
      shown += text.substr(i++, 2);
    } else if (byte >= 0x20 && byte < 0x7F) {
      shown += text[i];
    } else {
      (shown += "\\x") += {HexDigit(byte >> 4), HexDigit(byte & 15)};
    }
  }
  return shown + (text.size() > kShown ? "...\"" : "\"");
}

}  // namespace pendulum
