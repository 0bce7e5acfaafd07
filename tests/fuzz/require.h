// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

/// Shared by the fuzzers: a violated requirement ends the process, and the fuzzer reports the input.
namespace pendulum {

inline void Require(bool promise) {
  if (!promise) std::abort();
}

/// A message starts with the file's name and is short enough to read.
inline void RequireSentence(const std::string& message, const std::string& name) {
  Require(message.starts_with(name + ":") && message.size() < 2000);
}

inline std::string_view TextOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace pendulum
