// SPDX-License-Identifier: Apache-2.0
// Tests of text pasted from a serial monitor, and of rows that are cut off.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/rows.h"

namespace pendulum::pasted_rows_test {
namespace {

using testing::StartsWith;

// ---- Serial monitors ---------------------------------------------------------------------------------------------

TEST(PastedRows, ReadAPasteOfASerialMonitor) {
  const std::string text = ":03:22.113 -> -10,99\n" + Rows("14:03:22.123 -> {t},{v}") + "14:03:22.203 -> 80";
  const Recording recording = RecordingOf(text, TimeAndValue("1:ms", "", "counts"));
  ASSERT_EQ(recording.size(), 9);  // Only the host's stamp is cut; the device's row is whole.
  EXPECT_EQ(recording.value[0], 99);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "incomplete_row");
  EXPECT_EQ(MessageText(recording.warnings[0]),
            "run.csv:10: the row \"14:03:22.203 -> 80\" is incomplete; it was left out");
}

TEST(PastedRows, UseTheHostsTimeIfThereIsNoOtherTime) {
  std::string text = "99.990 -> 7\n";
  for (int i = 0; i < 8; ++i)
    text += (i < 4 ? "23:59:59.9" + std::to_string(6 + i) : "00:00:00.0" + std::to_string(i - 4)) + "0 -> " +
            std::to_string(100 + i) + "\n";
  const Recording recording = RecordingOf(text, Unit("counts"));
  ASSERT_EQ(recording.size(), 8);
  for (int i = 0; i < 8; ++i) EXPECT_DOUBLE_EQ(recording.time[i], 86399.96 + i / 100.0);
  ASSERT_EQ(recording.warnings.size(), 2);
  EXPECT_EQ(MessageText(recording.warnings[0]), "run.csv:1: the row \"99.990 -> 7\" is incomplete; it was left out");
  EXPECT_EQ(recording.warnings[1].code, "host_time");
  EXPECT_EQ(MessageText(recording.warnings[1]),
            "run.csv: the times are those at which the host received each line; if there is a column of the device's "
            "own times, name it with --time_column");
}

TEST(PastedRows, ReadAHeaderAfterTheHostsStamp) {
  ExpectTheRows(RecordingOf("14:03:22.123 -> time_ms,adc_counts\n" + Rows("14:03:22.123 -> {t},{v}")));
}

TEST(PastedRows, RefuseALineWithoutTheHostsStamp) {
  EXPECT_EQ(FaultOf(Rows("14:03:22.1{t} -> {v}") + "5\n14:03:23.000 -> 7\n", Unit("counts")),
            "run.csv:9:1: this line does not begin with the host's time, such as 14:03:22.123 ->, although others do; "
            "complete "
            "the row or delete it");
}

// ---- Rows that are cut off ---------------------------------------------------------------------------------------

TEST(PastedRows, RemoveATruncatedFirstRowWithoutAHeader) {
  for (const std::string cut : {"5", ",5", "-,5", "> 90,5", "e-5,5"}) {
    const Recording recording = RecordingOf(cut + "\n" + Rows("{t},{v}"), TimeAndValue("1:ms", "", "deg"));
    ExpectTheRows(recording, kDegree);
    ASSERT_EQ(recording.warnings.size(), 1) << cut;
    EXPECT_EQ(MessageText(recording.warnings[0]), "run.csv:1: the row \"" + cut + "\" is incomplete; it was left out");
  }
}

TEST(PastedRows, RemoveAFirstRowWithATruncatedTime) {
  std::string text = "90,99\n";  // What remains of 11990.
  for (int i = 0; i < 10; ++i) text += std::to_string(12000 + 10 * i) + ",5\n";
  const Recording recording = RecordingOf(text, TimeAndValue("1:ms", "", "deg"));
  EXPECT_EQ(recording.size(), 10);
  EXPECT_EQ(recording.time[0], 12);
  EXPECT_EQ(recording.warnings.at(0).code, "incomplete_row");
}

TEST(PastedRows, RemoveATruncatedLastRow) {
  const std::string text = "time_ms,angle_deg\n" + Rows("{t},{v}");
  for (const std::string cut : {"80", "80\n", "80,", "80,-", "80,1e", "80,1.5x"}) {
    const Recording recording = RecordingOf(text + cut);
    ExpectTheRows(recording, kDegree);
    ASSERT_EQ(recording.warnings.size(), 1) << cut;
    EXPECT_EQ(recording.warnings[0].code, "incomplete_row");
    EXPECT_THAT(MessageText(recording.warnings[0]), StartsWith("run.csv:10: the row \"80")) << cut;
  }
  EXPECT_EQ(RecordingOf(text + "80,108").size(), 9);
}

TEST(PastedRows, RemoveATruncatedLastValue) {
  const std::string text = "time_ms,adc_counts\n" + Rows("{t},{v}") + "80,107\n";
  const Recording recording = RecordingOf(text + "90,10");
  EXPECT_EQ(recording.size(), 9);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(MessageText(recording.warnings[0]), "run.csv:11: the row \"90,10\" is incomplete; it was left out");
  EXPECT_EQ(RecordingOf(text + "90,10\n").size(), 10);  // The line end shows that it is whole.
  EXPECT_EQ(RecordingOf(text + "90,105").size(), 10);
}

TEST(PastedRows, RefuseAnIncompleteRowInTheMiddleWithoutTimes) {
  const std::string text = "# sample_rate_hz: 100\ntorque,angle_deg\n" + Rows("{t},{v}");
  EXPECT_EQ(
      FaultOf(text + "80\n90,1\n"),
      "run.csv:11:3: the row ends after 1 of 2 fields, before column \"angle_deg\"; complete the row or delete it");
}

TEST(PastedRows, NameTheLineOfClockRepairs) {
  const std::string text = "# a\ntime_ms,angle_deg\n" + Rows("{t},{v}");
  const Recording recording = RecordingOf(text + "\n\n70,5\n80,5\n90,5\n100,5\n110,5\n");
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(MessageText(recording.warnings[0]),
            "run.csv:13: 2 of 13 rows were left out because they share their time with another row, first 70 ms; of "
            "rows with equal times and values, one was kept");
}

}  // namespace
}  // namespace pendulum::pasted_rows_test
