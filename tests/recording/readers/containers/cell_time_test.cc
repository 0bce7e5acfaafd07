// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/cell_time.h"

#include <string>

#include <gtest/gtest.h>

namespace pendulum::cell_time_test {
namespace {

TEST(IsTimeFormat, RecognisesDatesTimesAndDurations) {
  for (const char* const format :
       {"yyyy-mm-dd", "d.m.yy", "h:mm AM/PM", "mm:ss.0", "[h]:mm:ss", "[ss].000", "[$-409]dddd, mmmm d, yyyy",
        "dd/mm/yyyy\\ hh:mm:ss;@", "YYYY\"-\"MM", "[Red]hh:mm"}) {
    EXPECT_TRUE(IsTimeFormat(format)) << format;
  }
  for (const char* const format : {"General", "0.00", "0.00E+00", "#,##0.00", "0.0\" seconds\"", "0.0\\s", "[Red]0.0",
                                   "[$-409]0", "@", "", "0%", "_-* #,##0_-", "\"day", "[h"}) {
    EXPECT_FALSE(IsTimeFormat(format)) << format;
  }
}

/// ECMA-376 part 1, 18.8.30.
TEST(IsTimeFormat, KnowsTheBuiltInFormats) {
  for (const int format : {14, 18, 21, 22, 45, 46, 47}) EXPECT_TRUE(IsTimeFormat(format)) << format;
  for (const int format : {0, 1, 2, 10, 11, 12, 13, 37, 44, 48, 49, 164}) EXPECT_FALSE(IsTimeFormat(format)) << format;
}

/// Days of the Gregorian calendar as Excel and LibreOffice show them.
TEST(TimeText, GivesDatesAndTimes) {
  EXPECT_EQ(TimeText(45352, false), "2024-03-01T00:00:00");
  EXPECT_EQ(TimeText(45351.5, false), "2024-02-29T12:00:00");
  EXPECT_EQ(TimeText(61, false), "1900-03-01T00:00:00");
  EXPECT_EQ(TimeText(2958465, false), "9999-12-31T00:00:00");
  EXPECT_EQ(TimeText(43890, true), "2024-03-01T00:00:00");
  EXPECT_EQ(TimeText(0.5, false), "12:00:00");
  EXPECT_EQ(TimeText(0, false), "00:00:00");
  EXPECT_EQ(TimeText(1.25, false), "30:00:00");
  EXPECT_EQ(TimeText(-1, false), "");
  EXPECT_EQ(TimeText(1e9, false), "");
}

TEST(TimeText, GivesMillisecondsExactly) {
  for (int ms = 0; ms < 86'400'000; ms += 9'973) {
    const double part = ms / 86'400'000.0;
    const std::string text = TimeText(45352 + part, false);
    const auto number = [&](std::size_t at, std::size_t size) { return std::stoi(text.substr(at, size)); };
    ASSERT_LE(text.size(), std::string("2024-03-01T16:04:31.273").size()) << text;
    std::string padded = text.size() == 19 ? text + ".000" : text + std::string(23 - text.size(), '0');
    const int thousandths = std::stoi(padded.substr(20));
    ASSERT_EQ(((number(11, 2) * 60 + number(14, 2)) * 60 + number(17, 2)) * 1000 + thousandths, ms) << text;
    ASSERT_EQ(TimeText(part, false), text.substr(11)) << text;
  }
}

TEST(DurationText, ReadsDurationsOfOpenDocument) {
  EXPECT_EQ(DurationText("PT16H04M31.273S"), "16:04:31.273");
  EXPECT_EQ(DurationText("PT0S"), "00:00:00");
  EXPECT_EQ(DurationText("-PT1M"), "-00:01:00");
  for (const char* const text : {"", "P1D", "PTX", "PT1", "16:04"}) EXPECT_EQ(DurationText(text), "") << text;
}

TEST(WithoutEndZeros, KeepsWholeNumbers) {
  EXPECT_EQ(WithoutEndZeros("16:04:30"), "16:04:30");
  EXPECT_EQ(WithoutEndZeros("16:04:30.000"), "16:04:30");
  EXPECT_EQ(WithoutEndZeros("1.2500"), "1.25");
}

}  // namespace
}  // namespace pendulum::cell_time_test
