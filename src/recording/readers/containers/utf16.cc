// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/utf16.h"

#include <cstddef>
#include <cstdint>

namespace pendulum {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

void Append(std::uint32_t code, std::string& text) {
  const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  const auto add_rest = [&](int shift) { add(0x80 | (code >> shift & 0x3F)); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0 | code >> 6);
    add_rest(0);
  } else if (code < 0x10000) {
    add(0xE0 | code >> 12);
    add_rest(6);
    add_rest(0);
  } else {
    add(0xF0 | code >> 18);
    add_rest(12);
    add_rest(6);
    add_rest(0);
  }
}

}  // namespace

std::string Utf8OfUtf16(std::string_view bytes, ByteOrder order) {
  const auto unit = [&](std::size_t at) -> std::uint32_t {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return order == ByteOrder::kLittle ? first | second << 8 : first << 8 | second;
  };
  const auto is_within = [](std::uint32_t code, std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    if (is_within(code, 0xD800, 0xDBFF) && at + 3 < bytes.size() && is_within(unit(at + 2), 0xDC00, 0xDFFF)) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(at + 2) - 0xDC00);
      at += 2;
    } else if (is_within(code, 0xD800, 0xDFFF)) {
      code = kReplacement;
    }
    Append(code, text);
  }
  if (bytes.size() % 2 != 0) Append(kReplacement, text);
  return text;
}

std::string Utf8OfLatin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) Append(static_cast<unsigned char>(c), text);
  return text;
}

}  // namespace pendulum
