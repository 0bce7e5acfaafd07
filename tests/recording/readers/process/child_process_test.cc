// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/process/child_process.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pendulum::child_process_test {
namespace {

using std::chrono::milliseconds, std::chrono::steady_clock;

/// The failure of work; expects that it fails.
ChildFailure FailureOf(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  const auto answer = RunInChildProcess(work, limits);
  EXPECT_FALSE(answer.has_value());
  return answer ? ChildFailure::kNotStarted : answer.error();
}

/// The open descriptors of this process.
std::string Descriptors() {
  std::vector<std::string> numbers;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    numbers.push_back(entry.path().filename().string());
  }
  std::ranges::sort(numbers);
  std::string list;
  for (const std::string& number : numbers) list += number + ' ';
  return list;
}

std::size_t CountOfDescriptors() {
  const std::string list = Descriptors();
  return static_cast<std::size_t>(std::ranges::count(list, ' '));
}

/// True if all children have been waited for.
bool HasNoChild() { return ::waitpid(-1, nullptr, WNOHANG) < 0; }

TEST(RunInChildProcess, ReturnsTheResultOfTheWork) {
  EXPECT_EQ(RunInChildProcess([] { return std::string(); }, {}), "");
  EXPECT_EQ(RunInChildProcess([] { return std::string("E\0E", 3); }, {}), std::string("E\0E", 3));
  std::string large(10'000'000, 'x');
  large[9'999'998] = 'y';
  EXPECT_TRUE(RunInChildProcess([&] { return large; }, {}) == large);
}

TEST(RunInChildProcess, DistinguishesACrashFromTimeAndMemory) {
  EXPECT_EQ(FailureOf([]() -> std::string { std::abort(); }), ChildFailure::kCrashed);
  EXPECT_EQ(FailureOf([]() -> std::string { ::_exit(0); }), ChildFailure::kCrashed);
  EXPECT_EQ(FailureOf([]() -> std::string { throw std::runtime_error("no"); }), ChildFailure::kCrashed);
  EXPECT_EQ(FailureOf([]() -> std::string { throw std::bad_alloc(); }), ChildFailure::kOutOfMemory);
  EXPECT_TRUE(HasNoChild());
}

TEST(RunInChildProcess, EndsWorkThatUsesTooMuchOfAProcessor) {
  ChildLimits limits;
  limits.processor_seconds = 1;
  const auto spin = []() -> std::string {
    while (steady_clock::now() > steady_clock::time_point()) continue;
    return "";
  };
  EXPECT_EQ(FailureOf(spin, limits), ChildFailure::kOutOfTime);
  EXPECT_TRUE(HasNoChild());
}

TEST(RunInChildProcess, EndsWorkThatWaitsTooLong) {
  ChildLimits limits;
  limits.time = milliseconds(100);
  const auto begin = steady_clock::now();
  const auto sleep = []() -> std::string {
    ::sleep(60);
    return "late";
  };
  EXPECT_EQ(FailureOf(sleep, limits), ChildFailure::kOutOfTime);
  EXPECT_LT(steady_clock::now() - begin, milliseconds(20'000));
  EXPECT_TRUE(HasNoChild());
}

TEST(RunInChildProcess, EndsWorkThatClosesItsPipeAndSleeps) {
  ChildLimits limits;
  limits.time = milliseconds(100);
  const auto hide = []() -> std::string {
    ::close(3);
    ::sleep(60);
    return "";
  };
  EXPECT_EQ(FailureOf(hide, limits), ChildFailure::kOutOfTime);
  EXPECT_TRUE(HasNoChild());
}

TEST(RunInChildProcess, RefusesAnAnswerThatIsTooLarge) {
  ChildLimits limits;
  limits.answer_bytes = 100'000;
  const auto answer_of = [](std::size_t size) { return [size] { return std::string(size, 'x'); }; };
  EXPECT_TRUE(RunInChildProcess(answer_of(100'000), limits).has_value());
  EXPECT_EQ(FailureOf(answer_of(100'001), limits), ChildFailure::kAnswerTooLarge);
  EXPECT_EQ(FailureOf(answer_of(50'000'000), limits), ChildFailure::kAnswerTooLarge);
  EXPECT_TRUE(HasNoChild());
}

TEST(RunInChildProcess, EndsWorkThatTakesTooMuchMemory) {
  if (!kMemoryIsLimited) GTEST_SKIP() << "memory cannot be limited under an address sanitizer";
  ChildLimits limits;
  limits.memory_bytes = 10'000'000;
  const auto take = [] { return std::string(std::string(500'000'000, 'x').size() > 0 ? "taken" : ""); };
  EXPECT_EQ(FailureOf(take, limits), ChildFailure::kOutOfMemory);
}

TEST(RunInChildProcess, HasNoDescriptorOfTheParent) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const std::string with_folder = "0 1 2 3 4 ";  // Standard ones, the answer's, the directory's.
  EXPECT_EQ(RunInChildProcess(Descriptors, {}), with_folder);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(RunInChildProcess, LeavesNoDescriptorBehind) {
  const std::size_t before = CountOfDescriptors();
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(RunInChildProcess([] { return std::string("x"); }, {}).has_value());
    EXPECT_EQ(FailureOf([]() -> std::string { ::_exit(1); }), ChildFailure::kCrashed);
  }
  EXPECT_EQ(CountOfDescriptors(), before);
}

/// If the process of a long task inherited the pipe of a short task, the pipe would stay open until the long task ends.
TEST(RunInChildProcess, ThreadsDoNotWaitForEachOther) {
  const auto begin = steady_clock::now();
  std::thread other([] {
    ChildLimits limits;
    limits.time = milliseconds(1500);
    EXPECT_EQ(FailureOf(
                  []() -> std::string {
                    ::sleep(60);
                    return "";
                  },
                  limits),
              ChildFailure::kOutOfTime);
  });
  std::vector<std::thread> threads;
  for (int t = 0; t < 2; ++t) {
    threads.emplace_back([] {
      for (int i = 0; i < 20; ++i) EXPECT_EQ(RunInChildProcess([] { return std::string("short"); }, {}), "short");
    });
  }
  for (std::thread& thread : threads) thread.join();
  const auto took = steady_clock::now() - begin;
  other.join();
  EXPECT_LT(took, milliseconds(10'000));
}

}  // namespace
}  // namespace pendulum::child_process_test
