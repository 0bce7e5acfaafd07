// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

/// What the fuzzers share: a broken promise ends the process, which the fuzzer reports with its input.
namespace pendulum {

inline void Require(bool promise) {
  if (!promise) std::abort();
}

/// A message names the file first and is short enough to be read.
inline void RequireSentence(const std::string& message, const std::string& name) {
  Require(message.starts_with(name + ":") && message.size() < 2000);
}

inline std::string_view TextOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace pendulum
