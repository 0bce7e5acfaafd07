// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace pendulum {

int ThreadsOrCores(int threads) {
  // Counted only once, because counting takes longer than some of the work.
  static const int cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  return threads > 0 ? threads : cores;
}

void ParallelFor(int count, int threads, const std::function<void(int)>& work) {
  constexpr int kMaxThreads = 256;
  const int used = std::min({ThreadsOrCores(threads), count, kMaxThreads});
  std::atomic<int> next = 0;
  const auto take = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  try {
    for (int i = 1; i < used; ++i) others.emplace_back(take);
  } catch (const std::system_error&) {
    // The threads started so far do the work.
  }
  take();
}

}  // namespace pendulum
