// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include <tl/expected.hpp>

namespace pendulum {

/// False under an address sanitizer, which maps the whole address space and keeps freed memory.
extern const bool kMemoryIsLimited;

/// Limits for a child process.
struct ChildLimits {
  int processor_seconds = 2;
  std::chrono::milliseconds time{15'000};           // Elapsed time.
  std::size_t memory_bytes = std::size_t{1} << 32;  // In addition to the memory in use, if it is limited.
  std::size_t answer_bytes = std::size_t{1} << 29;
};

enum class ChildFailure {
  kNotStarted,
  kCrashed,
  kOutOfTime,
  kOutOfMemory,  // In the child, or in this process for the answer.
  kAnswerTooLarge,
};

/// Returns the result of `work`, executed in a separate process that may crash, hang or run out of memory, as libraries
/// do that read untrusted binary files (see ReadMatTable). The output of the separate process is discarded, it has none
/// of this process's descriptors, and it ends with the thread that waits for it. Any number of threads may call this at
/// the same time.
tl::expected<std::string, ChildFailure> RunInChildProcess(const std::function<std::string()>& work,
                                                          const ChildLimits& limits);

}  // namespace pendulum
