// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/time_limit.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum::time_limit_test {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kShort{40}, kNever{3'600'000};

/// Waits for a stop, much longer than it should take; returns whether it came.
bool IsStopped(const std::stop_token& token) {
  constexpr std::chrono::seconds kPatience{20};
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait_for(lock, token, kPatience, [] { return false; });
  return token.stop_requested();
}

TEST(TimeLimit, StopsOnlyWorkThatTakesTooLong) {
  TimeLimit limit(kShort);
  EXPECT_EQ(limit.limit(), kShort);
  const auto begin = Clock::now();
  const TimeLimit::Watch watch(limit);
  EXPECT_TRUE(IsStopped(watch.token()));
  EXPECT_GE(Clock::now() - begin, kShort);
}

TEST(TimeLimit, StopsWorkBeforeItBeginsIfThereIsNoTime) {
  TimeLimit limit(milliseconds(0));
  EXPECT_TRUE(TimeLimit::Watch(limit).token().stop_requested());
}

TEST(TimeLimit, StopsEachPieceOfWorkAfterItsOwnTime) {
  TimeLimit limit(kShort);
  const TimeLimit::Watch first(limit);
  std::this_thread::sleep_for(kShort / 2);
  const auto begin = Clock::now();
  const TimeLimit::Watch second(limit);
  EXPECT_TRUE(IsStopped(first.token()));
  EXPECT_TRUE(IsStopped(second.token()));
  EXPECT_GE(Clock::now() - begin, kShort);
}

TEST(TimeLimit, StopsWorkThatBeginsAfterAStop) {
  TimeLimit limit(kShort);
  const TimeLimit::Watch first(limit);
  ASSERT_TRUE(IsStopped(first.token()));
  const TimeLimit::Watch second(limit);
  EXPECT_TRUE(IsStopped(second.token()));
}

TEST(TimeLimit, DoesNotStopWorkDoneInTime) {
  TimeLimit limit(kNever);
  std::stop_token token;
  {
    const TimeLimit::Watch watch(limit);
    token = watch.token();
  }
  EXPECT_FALSE(token.stop_requested());
}

TEST(TimeLimit, StopsAllCurrentAndFutureWork) {
  TimeLimit limit(kNever);
  const TimeLimit::Watch one(limit), other(limit);
  EXPECT_FALSE(one.token().stop_requested() || other.token().stop_requested());
  limit.StopAll();
  EXPECT_TRUE(one.token().stop_requested() && other.token().stop_requested());
  EXPECT_TRUE(TimeLimit::Watch(limit).token().stop_requested());
}

TEST(TimeLimit, CanBeDestroyedWhileIdle) {
  { const TimeLimit limit(kNever); }
  { const TimeLimit limit(kShort); }
}

// Watches in many threads; some are stopped, each at its own time limit.
TEST(TimeLimit, WatchesManyThreads) {
  constexpr int kThreads = 8, kWatches = 200;
  TimeLimit limit(milliseconds{5});
  std::atomic<int> stopped = 0, wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < kWatches; ++i) {
          const auto begin = Clock::now();
          const TimeLimit::Watch watch(limit);
          if (i % 20 == 0 && IsStopped(watch.token())) ++stopped;
          if (watch.token().stop_requested() && Clock::now() - begin < milliseconds{5}) ++wrong;
        }
      });
    }
  }
  EXPECT_EQ(stopped, kThreads * kWatches / 20);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace pendulum::time_limit_test
