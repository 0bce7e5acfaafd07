// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace pendulum {

void ParallelFor(int count, int threads, const std::function<void(int)>& work) {
  constexpr int kMostThreads = 256;
  const int cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  const int used = std::min({threads > 0 ? threads : cores, count, kMostThreads});
  std::atomic<int> next = 0;
  const auto take = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < used; ++i) others.emplace_back(take);
  take();
}

}  // namespace pendulum
