// SPDX-License-Identifier: Apache-2.0
#include "service/work_queue.h"

#include <atomic>
#include <latch>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum::work_queue_test {
namespace {

using wire::WorkQueue;

TEST(WorkQueue, AcceptsWorkForItsThreadsAndItsQueue) {
  WorkQueue queue(2, 3);
  std::latch gate(1), begun(2);
  std::atomic<int> done = 0;
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(queue.Offer([&, i] {
      if (i < 2) begun.count_down();
      gate.wait();
      ++done;
    }));
  }
  EXPECT_FALSE(queue.Offer([&] { ++done; }));
  begun.wait();
  EXPECT_EQ(queue.running(), 2);
  EXPECT_EQ(queue.waiting(), 3);
  EXPECT_FALSE(queue.Offer([&] { ++done; }));
  gate.count_down();
  while (queue.running() + queue.waiting() > 0) std::this_thread::yield();
  EXPECT_EQ(done, 5);
  EXPECT_TRUE(queue.Offer([] {}));
}

TEST(WorkQueue, AcceptsWorkForItsThreadsWithoutAQueue) {
  WorkQueue queue(1, 0);
  std::latch gate(1);
  EXPECT_TRUE(queue.Offer([&] { gate.wait(); }));
  EXPECT_FALSE(queue.Offer([] {}));
  gate.count_down();
}

TEST(WorkQueue, RunsWorkInTheOrderOffered) {
  WorkQueue queue(1, 10);
  std::latch gate(1), done(1);
  std::string order;
  EXPECT_TRUE(queue.Offer([&] { gate.wait(); }));
  for (const char name : std::string("abcdefgh")) EXPECT_TRUE(queue.Offer([&, name] { order += name; }));
  EXPECT_TRUE(queue.Offer([&] { done.count_down(); }));
  gate.count_down();
  done.wait();
  EXPECT_EQ(order, "abcdefgh");
}

TEST(WorkQueue, DropsWaitingWorkAndFinishesRunningWorkOnClose) {
  WorkQueue queue(1, 10);
  std::latch begun(1), gate(1);
  std::atomic<bool> has_run = false, has_run_later = false;
  EXPECT_TRUE(queue.Offer([&] {
    begun.count_down();
    gate.wait();
    has_run = true;
  }));
  const auto held = std::make_shared<int>(0);
  EXPECT_TRUE(queue.Offer([&, held] { has_run_later = true; }));
  begun.wait();
  std::thread opener([&] {
    while (held.use_count() > 1) std::this_thread::yield();  // until the waiting work is destroyed
    gate.count_down();
  });
  queue.Close();
  EXPECT_TRUE(has_run);
  EXPECT_FALSE(has_run_later);
  EXPECT_FALSE(queue.Offer([] {}));
  opener.join();
}

}  // namespace
}  // namespace pendulum::work_queue_test
