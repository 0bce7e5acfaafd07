// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace pendulum {

/// Little-endian numbers in binary files; zeros after the end of the bytes.
template <typename T>
T NumberAt(std::string_view bytes, std::size_t at) {
  std::uint64_t number = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) {
    number = number << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
  }
  T value{};
  if constexpr (sizeof(T) == sizeof(std::uint64_t)) {
    std::memcpy(&value, &number, sizeof value);
  } else {
    value = static_cast<T>(number);
  }
  return value;
}

}  // namespace pendulum
