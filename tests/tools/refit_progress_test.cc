// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include "tools/refit_text.h"

namespace pendulum::refit_progress_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

// 500 of 2000 in 10 s: 50 per second, and the other 1500 take 30 s.
TEST(ProgressText, ShowsRateAndRemainingTime) {
  RefitCounts counts;
  counts.runs = 2000;
  counts.refitted = 400;
  counts.current = 100;
  EXPECT_EQ(ProgressText(counts, 10), "500 of 2000 runs (25 %), 50 a second, 30 s left");
  counts.unfitted = 3;
  EXPECT_THAT(ProgressText(counts, 10), EndsWith(", 3 could not be fitted"));
}

TEST(ProgressText, ShowsNoRateBeforeTheFirstRun) {
  RefitCounts counts;
  counts.runs = 5;
  EXPECT_EQ(ProgressText(counts, 1), "0 of 5 runs (0 %)");
  counts.runs = 0;
  EXPECT_EQ(ProgressText(counts, 1), "0 of 0 runs (100 %)");
}

/// The text available from a descriptor.
std::string ReadFrom(int descriptor) {
  std::array<char, 4096> text{};
  const ssize_t got = ::read(descriptor, text.data(), text.size());
  return {text.data(), static_cast<std::size_t>(got > 0 ? got : 0)};
}

/// The time point after a delay from now.
RefitProgress::Clock::time_point After(RefitProgress::Clock::duration wait) {
  return RefitProgress::Clock::now() + wait;
}

TEST(RefitProgress, DrawsABarOnATerminalAndClearsIt) {
  int leader = -1, follower = -1;
  ASSERT_EQ(::openpty(&leader, &follower, nullptr, nullptr, nullptr), 0);
  RefitProgress progress("refit_pendulums", follower);
  RefitCounts counts;
  counts.runs = 4;
  counts.refitted = 1;
  progress.Show(counts, After(std::chrono::milliseconds(250)));
  EXPECT_THAT(ReadFrom(leader), AllOf(StartsWith("\r[#####...............] 1 of 4 runs (25 %)"), EndsWith("\x1b[K")));
  progress.Finish();
  EXPECT_EQ(ReadFrom(leader), "\r\x1b[K");
  ::close(leader);
  ::close(follower);
}

TEST(RefitProgress, WritesOccasionalPlainLinesWithoutATerminal) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  RefitProgress progress("refit_pendulums", ends[1], std::chrono::milliseconds(100));
  RefitCounts counts;
  counts.runs = 4;
  for (counts.refitted = 1; counts.refitted <= 2; ++counts.refitted) {
    const auto begin = std::chrono::seconds(counts.refitted);
    progress.Show(counts, After(begin));
    progress.Show(counts, After(begin + std::chrono::milliseconds(90)));  // too early for the next update
  }
  progress.Finish();
  ::close(ends[1]);
  EXPECT_THAT(ReadFrom(ends[0]),
              MatchesRegex("refit_pendulums: 1 of 4 runs \\(25 %\\), [0-9.]+ a second, [0-9]+ s left\n"
                           "refit_pendulums: 2 of 4 runs \\(50 %\\), [0-9.]+ a second, [0-9]+ s left\n"));
  ::close(ends[0]);
}

TEST(RefitProgress, DrawsNothingOnAPipeAtFirst) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  RefitProgress progress("refit_pendulums", ends[1]);
  RefitCounts counts;
  counts.runs = 4;
  progress.Show(counts, After(std::chrono::milliseconds(250)));
  progress.Finish();
  ::close(ends[1]);
  EXPECT_EQ(ReadFrom(ends[0]), "");
  ::close(ends[0]);
}

}  // namespace
}  // namespace pendulum::refit_progress_test
