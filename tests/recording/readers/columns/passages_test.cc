// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/passages.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::passages_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Passages of a pendulum with a period of 1.6 s through a gate that stands beside its zero, so that the two halves of
/// a period differ; in units of `unit` [s].
std::vector<std::string> Passages(double unit) {
  std::vector<std::string> times;
  for (int i = 0; i < 41; ++i) {
    times.push_back(std::to_string(std::lround((3 + 0.8 * i + (i % 2 == 1 ? 0.02 : 0)) / unit)));
  }
  return times;
}

std::string Text(const std::string& header, const std::vector<std::string>& times, bool is_numbered) {
  std::string text = header;
  for (std::size_t i = 0; i < times.size(); ++i) {
    text += (is_numbered ? std::to_string(i + 1) + "," : std::string()) + times[i] + "\n";
  }
  return text;
}

TEST(RefusePassages, GivesTheMeanOfFullPeriods) {
  for (const bool is_numbered : {true, false}) {
    const std::string fault = FaultOf(Text("", Passages(1e-3), is_numbered));
    EXPECT_THAT(fault, HasSubstr("holds times of passages, not readings: the mean of full periods is 1.6 s (if the "
                                 "times are in ms); friction needs readings"));
  }
  EXPECT_THAT(
      FaultOf(Text("passage,time_us\n", Passages(1e-6), true)),
      HasSubstr("column \"time_us\" holds times of passages, not readings: the mean of full periods is 1.6 s; "));
}

TEST(RefusePassages, NamesTheUnitWithAPlausiblePeriod) {
  EXPECT_THAT(FaultOf(Text("", Passages(1e-6), false)), HasSubstr("1.6 s (if the times are in us); friction"));
}

TEST(RefusePassages, SaysThatPassagesInOneDirectionAreWholePeriods) {
  std::string text;
  for (int i = 0; i < 41; ++i) text += std::to_string(3000 + 800 * i + i * i % 7) + "\n";
  EXPECT_THAT(FaultOf(text),
              HasSubstr("1.6002 s (if the times are in ms), or 0.8001 s if all passages are in one direction"));
}

TEST(RefusePassages, SaysSoOfNearlyEqualSteps) {
  std::string text = "n,time_ms\n";
  for (int i = 0; i < 41; ++i) text += std::to_string(i + 1) + "," + std::to_string((162870 + 19306 * i) / 10) + "\n";
  EXPECT_THAT(FaultOf(text), HasSubstr("3.8612 s, or 1.9306 s if all passages are in one direction"));
}

TEST(RefusePassages, KnowsTheTimesForWhichTheGateIsBlocked) {
  std::string text;
  const std::vector<std::string> times = Passages(1e-3);
  for (std::size_t i = 0; i < times.size(); ++i)
    text += times[i] + "," + std::to_string(0.0057 + 3e-5 * static_cast<double>(i)) + "\n";
  EXPECT_THAT(FaultOf(text), HasSubstr("mean of full periods is 1.6 s"));
}

TEST(RefusePassages, IgnoreATrailingSeparator) {
  std::string text;
  for (const std::string& time : Passages(1e-3)) text += time + "\t\n";
  EXPECT_THAT(FaultOf(text), HasSubstr("mean of full periods is 1.6 s"));
}

TEST(RefusePassages, TakesNoClockForPassages) {
  std::vector<std::string> even;
  for (int i = 0; i < 40; ++i) even.push_back(std::to_string(20 * i));
  EXPECT_THAT(FaultOf(Text("n,time_ms\n", even, true)), Not(HasSubstr("passages")));
}

}  // namespace
}  // namespace pendulum::passages_test
