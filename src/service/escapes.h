// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pendulum {

/// The value of a hexadecimal digit in upper or lower case; -1 for other characters.
constexpr int HexValue(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return digit >= 'a' && digit <= 'f' ? digit - 'a' + 10 : -1;
}

/// The byte of an escape, "%7E", at the beginning of a text (RFC 3986, section 2.1); std::nullopt without an escape.
inline std::optional<char> EscapedByte(std::string_view text) {
  if (text.size() < 3 || text[0] != '%' || HexValue(text[1]) < 0 || HexValue(text[2]) < 0) return std::nullopt;
  return static_cast<char>(HexValue(text[1]) * 16 + HexValue(text[2]));
}

/// The decoded text; std::nullopt if a percent sign begins no escape.
inline std::optional<std::string> WithoutEscapes(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
    } else if (const auto byte = EscapedByte(text.substr(i))) {
      decoded += *byte;
      i += 2;
    } else {
      return std::nullopt;
    }
  }
  return decoded;
}

/// Whether a UTF-8 character is a control character (C0, C1 or DEL), which terminals may interpret.
constexpr bool IsControl(std::string_view character) {
  if (character.size() == 1) return (character[0] >= 0 && character[0] < 0x20) || character[0] == 0x7F;
  return character.size() == 2 && character[0] == '\xC2' && (character[1] & 0xE0) == 0x80;
}

}  // namespace pendulum
