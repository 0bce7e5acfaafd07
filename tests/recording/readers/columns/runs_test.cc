// SPDX-License-Identifier: Apache-2.0
// Tests of exports of Logger Pro, Graphical Analysis, Capstone and SPARKvue: several runs side by side, and Vernier's
// text format.
#include "recording/readers/columns/runs.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::runs_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> Split(std::string_view name) {
  const auto [run, rest] = csv::SplitRun(name);
  return {std::string(run), std::string(rest)};
}

TEST(SplitRun, SeparatesTheRunFromTheName) {
  EXPECT_THAT(Split("Latest: Time (s)"), ElementsAre("Latest", "Time (s)"));
  EXPECT_THAT(Split("Data Set 1:Time(s)"), ElementsAre("Data Set 1", "Time(s)"));
  EXPECT_THAT(Split("Angle (rad) Run #12"), ElementsAre("Run #12", "Angle (rad)"));
  EXPECT_THAT(Split("Angle (rad), Run #1"), ElementsAre("Run #1", "Angle (rad)"));
  EXPECT_THAT(Split("Angle (rad) Run down"), ElementsAre("", "Angle (rad) Run down"));
  EXPECT_THAT(Split("angle_deg"), ElementsAre("", "angle_deg"));
}

TEST(Runs, OneRunIsReadLikeAnOrdinaryTable) {
  ExpectTheRows(RecordingOf("Latest: Time (s),Latest: Angle (rad)\n" + Rows("0.0{t},{v}")));
  ExpectTheRows(RecordingOf("Data Set 1:Time(s),Data Set 1:Angle(\u00B0)\n" + Rows("0.0{t},{v}")), kDegree);
  ExpectTheRows(RecordingOf("\"Time (s) Run #1\"\t\"Angle (rad) Run #1\"\n" + Rows("0.0{t}\t{v}")));
  const Recording rate = RecordingOf("Time (s) Run #1,\"Angular Velocity (rad/s) Run #1\"\n" + Rows("0.0{t},{v}"));
  ExpectTheRows(rate);
  EXPECT_EQ(rate.quantity, Quantity::kRate);
  EXPECT_EQ(RecordingOf("Run 1: Time (s),Run 1: Potential (V)\n" + Rows("0.0{t},{v}")).unit, "volts");
}

const std::string kTwoRuns = "Time (s) Run #1,Angle (rad) Run #1,Time (s) Run #2,Angle (rad) Run #2\n";

TEST(Runs, SeveralRunsAreRefusedAndNamed) {
  EXPECT_EQ(
      FaultOf(kTwoRuns + Rows("0.0{t},1,0.0{t},{v}")),
      "run.csv:1:52: columns \"Angle (rad) Run #1\" and \"Angle (rad) Run #2\" could both be the quantity; choose "
      "one with --value_column");
  EXPECT_THAT(FaultOf("A:Time(s),A:Angle(rad),B:Time(s),B:Angle(rad),C:Time(s),C:Angle(rad)\n" + Rows("1,2,3,4,5,6")),
              HasSubstr("columns \"A:Angle(rad)\", \"B:Angle(rad)\" and \"C:Angle(rad)\" could all be the quantity"));
  EXPECT_THAT(FaultOf("A:Time(s),A:Angle(rad),A:Rate(rad/s),B:Time(s),B:Angle(rad),B:Rate(rad/s)\n" +
                      Rows("0.0{t},1,2,0.0{t},5,6")),
              HasSubstr("columns of 2 runs could be the quantity; choose one with --value_column, of the first run "
                        "\"A:Angle(rad)\" and \"A:Rate(rad/s)\""));
}

TEST(Runs, TheChosenRunHasItsOwnTime) {
  const std::string text = kTwoRuns + Rows("9{t},1,0.0{t},{v}");
  ExpectTheRows(RecordingOf(text, TimeAndValue("", "Angle (rad) Run #2")));
  ExpectTheRows(RecordingOf(text, TimeAndValue("", "4")));
  ExpectTheRows(RecordingOf(text, TimeAndValue("Time (s) Run #2", "Angle (rad) Run #2")));
  ExpectTheRows(RecordingOf(text, TimeAndValue("Time (s) Run #2", "")));
  EXPECT_EQ(RecordingOf(text, TimeAndValue("", "Angle (rad) Run #1")).time[0], 90);
}

TEST(Runs, TheShorterRunEndsInEmptyCells) {
  const std::string text = kTwoRuns + Rows("0.0{t},{v},{t}.5,1") + "1,200,,\n1.1,201,,\n";
  const Recording longer = RecordingOf(text, TimeAndValue("", "2"));
  EXPECT_EQ(longer.size(), 10);
  const Recording shorter = RecordingOf(text, TimeAndValue("", "4"));
  EXPECT_EQ(shorter.size(), 8);
  EXPECT_TRUE(shorter.warnings.empty());
  const Recording trimmed = RecordingOf(kTwoRuns + Rows("0.0{t},{v},{t}.5,1") + "1,200\n", TimeAndValue("", "4"));
  EXPECT_EQ(trimmed.size(), 8);
}

TEST(Runs, RowsWithAnEmptyCellAreRemovedWithAWarning) {
  const Recording recording =
      RecordingOf("Latest: Time (s),Latest: Angle (rad)\n" + Rows("0.0{t},{v}") + "0.08,\n0.09,109\n");
  EXPECT_EQ(recording.size(), 9);
  ASSERT_GE(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "empty_cells");
  EXPECT_EQ(MessageText(recording.warnings[0]),
            "run.csv: 1 row was left out, with no number in column \"Latest: Angle (rad)\" or in its time");
  EXPECT_EQ(RecordingOf("time_s,angle_rad\n" + Rows("0.0{t},{v}") + "0.08,\n0.09,109\n").size(), 9);
}

TEST(Runs, ALineOfRunNamesMayPrecedeTheColumnNames) {
  const std::string text = "Run 1,,Run 2,\nTime (s),Angle (rad),Time (s),Angle (rad)\n" + Rows("7,1,0.0{t},{v}");
  EXPECT_THAT(FaultOf(text), HasSubstr("columns \"Run 1: Angle (rad)\" and \"Run 2: Angle (rad)\" could both"));
  ExpectTheRows(RecordingOf(text, TimeAndValue("", "Run 2: Angle (rad)")));
}

// ---- Vernier Format ----------------------------------------------------------------------------------------------

std::string Vernier(const std::string& units, const std::string& rows) {
  return "Vernier Format 2\nswing.cmbl 3/2/2024 10:00:00 .\nLatest\nTime\tAngle\tPotential\nt\ta\tU\n" + units +
         "\n\n" + rows;
}

TEST(Vernier, FindsNamesUnitsAndRows) {
  ExpectTheRows(RecordingOf(Vernier("s\trad\t", Rows("0.0{t}\t{v}\t1"))));
  ExpectTheRows(RecordingOf(Vernier("s\t\u00B0\t", Rows("0.0{t}\t{v}\t1"))), kDegree);
  ExpectTheRows(RecordingOf(Vernier("s\t\t", Rows("0.0{t}\t{v}\t1")), TimeAndValue("", "Angle", "deg")), kDegree);
  EXPECT_EQ(RecordingOf(Vernier("s\t\tV", Rows("0.0{t}\t1\t{v}"))).unit, "volts");
  ExpectTheRows(RecordingOf(Vernier("ms\trad\t", Rows("{t}\t{v}\t1"))));
}

TEST(Vernier, ReportsTheLineOfAFaultyRow) {
  EXPECT_EQ(
      FaultOf(Vernier("s\trad\t", Rows("0.0{t}\tx\t1"))),
      "run.csv:8:6: column \"Angle (rad)\" holds \"x\", which is not a number; correct the field or delete the row");
  EXPECT_THAT(FaultOf(Vernier("s\trad\t", ""), {}, StatusCode::kFailedPrecondition),
              HasSubstr("rows of data found: 0"));
}

TEST(Vernier, ReadsTheFirstDataSet) {
  const Recording recording =
      RecordingOf(Vernier("s\trad\t", Rows("0.0{t}\t{v}\t1")) + Vernier("s\trad\t", Rows("0.0{t}\t9\t1")));
  ExpectTheRows(recording);
  EXPECT_EQ(recording.warnings.at(0).code, "second_table");
}

}  // namespace
}  // namespace pendulum::runs_test
