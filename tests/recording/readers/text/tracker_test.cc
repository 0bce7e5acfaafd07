// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/tracker.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::tracker_test {
namespace {

using testing::HasSubstr;

ReadOptions Value(const std::string& column, const std::string& unit) { return TimeAndValue("", column, unit); }

TEST(TrackerColumnMeaning, AssignsUnitsToLengths) {
  EXPECT_EQ(csv::TrackerColumnMeaning("x"), "x (m)");
  EXPECT_EQ(csv::TrackerColumnMeaning("\u03B8"), "\u03B8");
}

TEST(Tracker, IgnoresTheLengthOfTheVector) {
  const std::string text = "mass_A\nt\tr\t\u03B8\n" + Rows("0.0{t}\t1\t{v}");
  EXPECT_THAT(WrongFlag(text, Value("r", "")), HasSubstr("column \"r\" is the length of a vector"));
  ExpectTheRows(RecordingOf(text), kDegree);
  ExpectTheRows(RecordingOf(text, Unit("deg")), kDegree);
  ExpectTheRows(RecordingOf("mass_A\nt\tx\tr\n" + Rows("0.0{t}\t{v}\t1")));
}

TEST(Tracker, ReadsTheRequestedAngleBesideCoordinates) {
  const std::string text = "mass_A\nt\tx\ty\t\u03B8\n" + Rows("0.0{t}\t0.1\t0.2\t{v}");
  ExpectTheRows(RecordingOf(text, Unit("deg")), kDegree);
  ExpectTheRows(RecordingOf("mass_A\nt\tx\t\u03B8\t\u03C9\n" + Rows("0.0{t}\t0.1\t{v}\t2"), Unit("deg")), kDegree);
  EXPECT_THAT(WrongFlag("mass_A\nt\tx\n" + Rows("0.0{t}\t{v}"), Unit("deg")),
              HasSubstr("column \"x\" is in m, so --unit deg contradicts it"));
}

TEST(Tracker, ReadsOneTrackByItsName) {
  const std::string text = "mass_A\nt\tx\ty\t\u03B8\n" + Rows("0.0{t}\t0.1\t0.2\t{v}");
  ExpectTheRows(RecordingOf(text, Value("\u03B8", "deg")), kDegree);
  ExpectTheRows(RecordingOf(text, Value("\u03B8", "rad")));
  ExpectTheRows(RecordingOf("mass A\nt,\u03B8\n" + Rows("0.0{t},{v}"), Unit("deg")), kDegree);
  ExpectTheRows(RecordingOf("mass_A\nt  \u03B8\n" + Rows("0.0{t}  {v}"), Unit("rad")));
}

TEST(Tracker, AssumesTheUnitOfAnAngle) {
  const Recording recording = RecordingOf("mass_A\nt\t\u03B8\n" + Rows("0.0{t}\t{v}"), Value("\u03B8", ""));
  ExpectTheRows(recording, kDegree);
  EXPECT_EQ(recording.warnings.back().code, "value_unit_assumed");
}

TEST(Tracker, ChoosesAmongSeveralTracks) {
  const std::string text = "#multi:\n\tbob\t\tpivot\t\t\nt\tx\t\u03B8\tx\t\u03B8\t\n" + Rows("0.0{t}\t1\t2\t3\t{v}");
  ExpectTheRows(RecordingOf(text, Value("pivot: \u03B8", "deg")), kDegree);
  EXPECT_EQ(RecordingOf(text, Value("bob: \u03B8", "rad")).value[3], 2);
}

TEST(Tracker, RemovesRowsWithoutAVelocity) {
  const std::string text = "mass_A\nt\t\u03B8\t\u03C9\n-0.01\t1\t\n" + Rows("0.0{t}\t1\t{v}") + "0.08\t1\t\n";
  const Recording recording = RecordingOf(text, Value("\u03C9", "rad_s"));
  ExpectTheRows(recording);
  EXPECT_EQ(recording.warnings.at(0).code, "time_unit_assumed");
  EXPECT_EQ(recording.warnings.size(), 1);
}

TEST(Tracker, ALineAboveTheNamesMustContainLabels) {
  EXPECT_THAT(FaultOf("a recording of mine\nangle\trate\n" + Rows("{t}\t{v}")), HasSubstr("is a time: give the rate"));
  ExpectTheRows(RecordingOf("1\t2\nt\tx\n" + Rows("{t}\t{v}")));
}

TEST(LabelledColumns, HaveASharedColumnOfTimes) {
  const std::string text = "Common\tRun 1\tRun 2\nTime (s)\tAngle (deg)\tAngle (deg)\n" + Rows("0.0{t}\t{v}\t1");
  ExpectTheRows(RecordingOf(text, Value("Run 1: Angle (deg)", "")), kDegree);
}

}  // namespace
}  // namespace pendulum::tracker_test
