// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
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

/// Bytes of the first character of a text in UTF-8 (RFC 3629, section 4); 0 if it is invalid.
inline std::size_t Utf8Length(std::string_view text) {
  struct Form {
    unsigned char first_low, first_high, second_low, second_high;
    std::size_t length;
  };
  constexpr std::array<Form, 8> kForms = {{{0xC2, 0xDF, 0x80, 0xBF, 2},
                                           {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                           {0xE1, 0xEC, 0x80, 0xBF, 3},
                                           {0xED, 0xED, 0x80, 0x9F, 3},
                                           {0xEE, 0xEF, 0x80, 0xBF, 3},
                                           {0xF0, 0xF0, 0x90, 0xBF, 4},
                                           {0xF1, 0xF3, 0x80, 0xBF, 4},
                                           {0xF4, 0xF4, 0x80, 0x8F, 4}}};
  if (text.empty()) return 0;
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  for (const Form& form : kForms) {
    if (byte(0) < form.first_low || byte(0) > form.first_high) continue;
    if (text.size() < form.length || byte(1) < form.second_low || byte(1) > form.second_high) return 0;
    for (std::size_t i = 2; i < form.length; ++i) {
      if ((byte(i) & 0xC0) != 0x80) return 0;
    }
    return form.length;
  }
  return 0;
}

inline bool IsUtf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

/// Whether a UTF-8 character is a control character (C0, C1 or DEL), which terminals may interpret.
constexpr bool IsControl(std::string_view character) {
  if (character.size() == 1) return (character[0] >= 0 && character[0] < 0x20) || character[0] == 0x7F;
  return character.size() == 2 && character[0] == '\xC2' && (character[1] & 0xE0) == 0x80;
}

}  // namespace pendulum
