// SPDX-License-Identifier: Apache-2.0
#include "tools/progress_line.h"

#include <array>
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include "tests/tools/with_variable.h"

namespace pendulum::progress_line_test {
namespace {

using std::chrono::milliseconds;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

TEST(DurationText, UsesCommonUnits) {
  EXPECT_EQ(DurationText(0.2), "0 s");
  EXPECT_EQ(DurationText(59.4), "59 s");
  EXPECT_EQ(DurationText(60), "1 min 00 s");
  EXPECT_EQ(DurationText(185), "3 min 05 s");
  EXPECT_EQ(DurationText(3600), "1 h 00 min");
  EXPECT_EQ(DurationText(7800), "2 h 10 min");
}

// 2 of 5 parts took 12 s, so the other 3 take 18 s.
TEST(ProgressLineText, SaysWhatHowFarAndHowLong) {
  EXPECT_EQ(ProgressLineText({"fitting stribeck", 2, 5}, 20, 12, 80),
            "fitting stribeck (2 of 5 done), 20 s, about 18 s left");
}

TEST(ProgressLineText, EstimatesNoTimeBeforeTheFirstPartIsDone) {
  EXPECT_EQ(ProgressLineText({"fitting coulomb", 0, 5}, 3, 3, 80), "fitting coulomb (0 of 5 done), 3 s");
  EXPECT_EQ(ProgressLineText({"comparing the laws"}, 3, 1, 80), "comparing the laws, 3 s");
  EXPECT_EQ(ProgressLineText({}, 3, 3, 80), "working, 3 s");
}

TEST(ProgressLineText, IsNotWiderThanTheTerminal) {
  EXPECT_EQ(ProgressLineText({"fitting stribeck", 2, 5}, 20, 12, 16), "fitting stribeck");
}

/// The text that arrives within `patience`; empty if none does.
std::string ReadFrom(int descriptor, milliseconds patience) {
  pollfd ready{descriptor, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(patience.count())) <= 0) return "";
  std::array<char, 4096> text{};
  const ssize_t got = ::read(descriptor, text.data(), text.size());
  return {text.data(), static_cast<std::size_t>(got > 0 ? got : 0)};
}

class ProgressLineTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::openpty(&leader_, &follower_, nullptr, nullptr, nullptr), 0); }

  void TearDown() override {
    ::close(leader_);
    ::close(follower_);
  }

  int leader_ = -1, follower_ = -1;
};

TEST_F(ProgressLineTest, AppearsOnATerminalAndIsCleared) {
  const WithVariable term("TERM", "xterm");
  {
    ProgressLine line(follower_, milliseconds(1));
    line.Show({"fitting stribeck", 2, 5});
    std::string text;
    while (text.find("stribeck") == std::string::npos) {
      const std::string more = ReadFrom(leader_, milliseconds(10'000));
      ASSERT_FALSE(more.empty()) << text;
      text += more;
    }
    EXPECT_THAT(text, HasSubstr("\rfitting stribeck (2 of 5 done), "));
    EXPECT_THAT(text, EndsWith("\x1b[K"));
  }
  EXPECT_THAT(ReadFrom(leader_, milliseconds(10'000)), EndsWith("\r\x1b[K"));
}

TEST_F(ProgressLineTest, StaysAwayFromAShortComputation) {
  const WithVariable term("TERM", "xterm");
  {
    ProgressLine line(follower_, std::chrono::hours(1));
    line.Show({"fitting stribeck", 2, 5});
  }
  EXPECT_EQ(ReadFrom(leader_, milliseconds(0)), "");
}

TEST(ProgressLine, WritesNothingToAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  {
    ProgressLine line(ends[1], milliseconds(0));
    line.Sink()({"fitting stribeck", 2, 5});
  }
  ::close(ends[1]);
  EXPECT_EQ(ReadFrom(ends[0], milliseconds(0)), "");
  ::close(ends[0]);
}

}  // namespace
}  // namespace pendulum::progress_line_test
