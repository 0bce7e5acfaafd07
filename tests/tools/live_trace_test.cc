// SPDX-License-Identifier: Apache-2.0
#include "tools/live_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pendulum::live_trace_test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

/// A trace of a function of time [s], sampled at 100 Hz from `begin` to `end`.
LiveTrace TraceOf(const std::function<double(double)>& value, double begin, double end) {
  LiveTrace trace("deg");
  for (int i = 0; i <= std::lround(100 * (end - begin)); ++i) {
    const double time = begin + i / 100.0;
    trace.Add(time, value(time), 512, 1023);
  }
  return trace;
}

/// The part of a row after the label and the bar.
std::string Picture(const std::string& row) { return row.substr(row.find('|') + 1); }

double Label(const std::string& row) { return std::stod(row); }

/// Columns of the plot that have a mark in some row.
std::vector<bool> MarkedColumns(const std::vector<std::string>& rows) {
  std::vector<bool> marked(Picture(rows.front()).size());
  for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
    for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = marked[i] || Picture(rows[row])[i] == '*';
  }
  return marked;
}

// ---- Plot --------------------------------------------------------------------------------------------------------

TEST(LiveTrace, ShowsTheNewestSamplesOnANarrowTerminal) {
  const LiveTrace trace = TraceOf([](double t) { return t < 9 ? 0.0 : 50.0; }, 0, 10);
  for (const std::size_t width : {20U, 40U, 60U, 80U, 200U}) {
    const auto rows = trace.Plot(width);
    for (const std::string& row : rows) EXPECT_LT(row.size(), width) << row;
    EXPECT_EQ(rows.front().back(), '*') << width;  // the last second is at the top right
  }
  EXPECT_THAT(trace.Plot(10), Each(""));
}

TEST(LiveTrace, IsBlankBeforeTheFirstSample) {
  const LiveTrace trace("deg");
  EXPECT_THAT(trace.Plot(), AllOf(SizeIs(LiveTrace::kRows), Each("")));
  EXPECT_EQ(trace.StatusLine("lost 0"), "waiting for samples");
}

TEST(LiveTrace, FitsATerminalOf80Columns) {
  for (const double size : {1e-3, 30.0, 1e5}) {
    const LiveTrace trace = TraceOf([=](double t) { return size * std::sin(4 * t) - size; }, 0, 25);
    const auto rows = trace.Plot();
    EXPECT_THAT(rows, SizeIs(LiveTrace::kRows));
    for (const std::string& row : rows) EXPECT_LE(row.size(), 79) << row;
  }
}

TEST(LiveTrace, SpansTheLowestToTheHighestValue) {
  const auto rows = TraceOf([](double t) { return 30 * std::sin(std::numbers::pi * t) + 10; }, 0, 10).Plot();
  EXPECT_THAT(rows[0], HasSubstr("*"));
  EXPECT_THAT(rows[LiveTrace::kRows - 2], HasSubstr("*"));
  EXPECT_EQ(Label(rows[0]), 40);
  EXPECT_EQ(Label(rows[5]), 10);
  EXPECT_EQ(Label(rows[10]), -20);
  EXPECT_THAT(rows.back(), AllOf(HasSubstr("deg"), HasSubstr("last 10 s")));
}

// A step up after 5 of 10 s: the left half of the plot has marks only at the bottom, the right half only at the top.
TEST(LiveTrace, DrawsAStepAtItsTime) {
  const auto rows = TraceOf([](double t) { return t < 5 ? -20.0 : 20.0; }, 0, 10).Plot();
  const std::string top = Picture(rows[0]), bottom = Picture(rows[10]);
  const std::size_t middle = top.size() / 2;
  EXPECT_NEAR(static_cast<double>(top.find('*')), static_cast<double>(middle), 1);
  EXPECT_EQ(top.rfind('*'), top.size() - 1);
  EXPECT_EQ(bottom.find('*'), 0);
  EXPECT_NEAR(static_cast<double>(bottom.rfind('*')), static_cast<double>(middle), 1);
}

TEST(LiveTrace, DrawsTheNewestSampleAtTheRight) {
  const auto marked = MarkedColumns(TraceOf([](double t) { return t; }, 0, 2).Plot());
  EXPECT_TRUE(marked.back());
  EXPECT_NEAR(static_cast<double>(std::ranges::count(marked, true)), 0.2 * static_cast<double>(marked.size()), 1.5);
  EXPECT_FALSE(marked.front());
}

TEST(LiveTrace, DropsSamplesOlderThanTenSeconds) {
  const auto rows = TraceOf([](double t) { return t < 5 ? 1000.0 : 3 * std::sin(t); }, 0, 20).Plot();
  EXPECT_LE(Label(rows[0]), 3);
  EXPECT_GE(Label(rows[10]), -3);
}

// Half a count of noise must not look like a swing: the axis spans at least 2 deg or counts.
TEST(LiveTrace, DrawsRestAsACentredLine) {
  const auto rows = TraceOf([](double t) { return 7 + 0.01 * std::sin(t); }, 0, 10).Plot();
  EXPECT_NEAR(Label(rows[0]), 8, 0.06);
  EXPECT_NEAR(Label(rows[10]), 6, 0.06);
  for (std::size_t row = 0; row < 11; ++row) {
    EXPECT_EQ(Picture(rows[row]).find('*') != std::string::npos, row == 5) << row;
  }
  EXPECT_THAT(Picture(rows[5]), Not(HasSubstr(" ")));
}

TEST(LiveTrace, LeavesAGapWithoutSamples) {
  LiveTrace trace("counts");
  for (int i = 0; i <= 1000; ++i) {
    if (i < 400 || i > 600) trace.Add(i / 100.0, i, i, 1023);
  }
  const auto marked = MarkedColumns(trace.Plot());
  EXPECT_FALSE(marked[marked.size() / 2]);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(marked, false)), 0.2 * static_cast<double>(marked.size()), 1.5);
}

// ---- StatusLine --------------------------------------------------------------------------------------------------

TEST(LiveTrace, ShowsTimeRateAndValue) {
  LiveTrace trace("deg");
  for (int i = 0; i <= 2480; ++i) trace.Add(i / 200.0, -12.34, 465, 1023);
  EXPECT_THAT(trace.StatusLine("lost 0"),
              AllOf(StartsWith("12.4 s  200 Hz  -12.3 deg  "), HasSubstr("["), EndsWith("]  lost 0")));
}

/// The text in the brackets and after them for this reading, full scale 1023 counts.
std::string LevelOf(double counts) {
  LiveTrace trace("counts");
  trace.Add(0, counts, counts, 1023);
  const std::string line = trace.StatusLine("|");
  return line.substr(line.find('['), line.find("  |") - line.find('['));
}

TEST(LiveTrace, ShowsTheLevelOfTheReading) {
  const std::string low = LevelOf(1), middle = LevelOf(511.5), high = LevelOf(1022);
  const auto share = [](const std::string& level) {
    return static_cast<double>(level.find('*') - 1) / static_cast<double>(level.find(']') - 2);
  };
  EXPECT_EQ(share(low), 0);
  EXPECT_NEAR(share(middle), 0.5, 0.05);
  EXPECT_GE(share(high), 0.9);
  for (const std::string& level : {low, middle, high}) EXPECT_THAT(level, EndsWith("]"));
}

TEST(LiveTrace, WarnsAtTheEndsOfTheConverter) {
  EXPECT_THAT(LevelOf(0), AllOf(StartsWith("[*"), EndsWith("] LOW")));
  EXPECT_THAT(LevelOf(1023), EndsWith("*] HIGH"));
}

TEST(LiveTrace, HasNoRateForOneSample) {
  LiveTrace trace("counts");
  trace.Add(3, 500, 500, 1023);
  EXPECT_THAT(trace.StatusLine("x"), StartsWith("3.0 s  0 Hz  500.0 counts  "));
}

// ---- RedrawnLines ------------------------------------------------------------------------------------------------

// ECMA-48: CSI n A moves the cursor up n lines, CSI K erases to the end of the line.
TEST(RedrawnLines, DrawsOverThePreviousLines) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  RedrawnLines lines(ends[1]);
  lines.Draw({"one", "two"}, 80);
  lines.Draw({"three", "four"}, 80);
  ::close(ends[1]);
  std::array<char, 256> text{};
  const ssize_t count = ::read(ends[0], text.data(), text.size());
  ::close(ends[0]);
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(count)),
            "one\x1b[K\ntwo\x1b[K\n"
            "\x1b[2Athree\x1b[K\n"
            "four\x1b[K\n");
}

}  // namespace
}  // namespace pendulum::live_trace_test
