// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/format.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>

namespace pendulum {
namespace {

/// The number of bytes of a letter beyond ASCII at the beginning of `text`, such as °, θ or 角, in valid UTF-8; 0 for
/// other text. Characters that could control a terminal or reverse the direction of a text have other first bytes.
std::size_t SizeOfLetterBeyondAscii(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  if (byte(0) >= 0xC2 && byte(0) <= 0xDF && follows(1)) return byte(0) > 0xC2 || byte(1) >= 0xA0 ? 2 : 0;
  const bool is_east_asian = byte(0) >= 0xE3 && (byte(0) <= 0xEC || (byte(0) == 0xED && byte(1) < 0xA0));  // to U+D7FF
  return is_east_asian && follows(1) && follows(2) ? 3 : 0;
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
  std::size_t i = 0;
  for (; i < text.size() && shown.size() <= kShown; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (const std::size_t size = SizeOfLetterBeyondAscii(text.substr(i)); size > 0) {
      shown += text.substr(i, size);
      i += size - 1;
    } else if (byte >= 0x20 && byte < 0x7F) {
      shown += text[i];
    } else {
      (shown += "\\x") += {HexDigit(byte >> 4), HexDigit(byte & 15)};
    }
  }
  return shown + (i < text.size() ? "...\"" : "\"");
}

std::string Capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string SizeText(std::size_t bytes) {
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  return bytes % kMiB == 0 ? std::to_string(bytes / kMiB) + " MiB" : std::to_string(bytes) + " bytes";
}

std::string ShellWord(const std::string& word) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = word;
  for (std::size_t at = quoted.find('\''); at != std::string::npos; at = quoted.find('\'', at + 4)) {
    quoted.replace(at, 1, "'\\''");
  }
  return "'" + quoted + "'";
}

std::string ListWithAnd(const std::vector<std::string>& names, std::size_t most) {
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    list += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return list + (names.size() > most ? ", ..." : "");
}

}  // namespace pendulum
