// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/parallel.h"

#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::parallel_test {
namespace {

TEST(ParallelFor, CallsTheFunctionOnceForEachNumber) {
  for (const int threads : {0, 1, 3, 1000}) {
    for (const int count : {0, 1, 2, 500}) {
      std::vector<int> calls(static_cast<std::size_t>(count));
      ParallelFor(count, threads, [&](int i) { ++calls.at(static_cast<std::size_t>(i)); });
      EXPECT_THAT(calls, testing::Each(1)) << threads << " threads, " << count;
    }
  }
}

TEST(ParallelFor, UsesTheGivenNumberOfThreads) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  ParallelFor(50, 4, [&](int) {
    for (bool all = false; !all;) {  // No thread may finish before all four have begun.
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
      all = seen.size() >= 4;
    }
  });
  EXPECT_EQ(seen.size(), 4);
}

TEST(ParallelFor, IsALoopWithOneThread) {
  std::vector<int> order;
  ParallelFor(5, 1, [&](int i) { order.push_back(i); });
  EXPECT_THAT(order, testing::ElementsAre(0, 1, 2, 3, 4));
}

}  // namespace
}  // namespace pendulum::parallel_test
