// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include <tl/expected.hpp>

namespace pendulum {

/// Not under an address sanitizer, which maps all addresses that there are and keeps what is freed.
extern const bool kMemoryIsLimited;

/// What a process may use.
struct ChildLimits {
  int processor_seconds = 2;
  std::chrono::milliseconds time{15'000};           // By the clock on the wall.
  std::size_t memory_bytes = std::size_t{1} << 32;  // Beyond what is in use, where it is limited.
  std::size_t answer_bytes = std::size_t{1} << 29;
};

enum class ChildFailure {
  kNotStarted,
  kCrashed,
  kOutOfTime,
  kOutOfMemory,  // Of its own, or this process has none for the answer.
  kAnswerTooLarge,
};

/// What `work` gives, done in a process of its own that may crash, hang or eat memory: libraries that read binary files
/// of strangers do so (see MatTable). Its output goes nowhere, it has none of this process's descriptors, and it ends
/// with the thread that waits for it. Any number of threads may ask at once.
tl::expected<std::string, ChildFailure> InChild(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace pendulum
