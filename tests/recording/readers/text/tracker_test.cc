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

TEST(TrackerColumnMeaning, AssignsUnitsToTimesAndLengths) {
  EXPECT_EQ(csv::TrackerColumnMeaning("t"), "time_s");
  EXPECT_EQ(csv::TrackerColumnMeaning("t (s)"), "time_s");
  EXPECT_EQ(csv::TrackerColumnMeaning("x"), "x (m)");
  EXPECT_EQ(csv::TrackerColumnMeaning("\u03B8"), "\u03B8");
}

TEST(Tracker, IgnoresTheLengthOfTheVector) {
  const std::string text = "mass_A\nt\tr\t\u03B8\n" + Rows("0.0{t}\t1\t{v}");
  EXPECT_THAT(WrongFlag(text, Value("r", "")), HasSubstr("column \"r\" is the length of a vector"));
  EXPECT_THAT(FaultOf(text), HasSubstr("none of the columns \"t\", \"r\", \"\u03B8\" is an angle"));
  ExpectTheRows(RecordingOf(text, Unit("deg")), kDegree);
  ExpectTheRows(RecordingOf("mass_A\nt\tx\tr\n" + Rows("0.0{t}\t{v}\t1")));
}

TEST(Tracker, ReadsTheRequestedAngleBesideCoordinates) {
  const std::string text = "mass_A\nt\tx\ty\t\u03B8\n" + Rows("0.0{t}\t0.1\t0.2\t{v}");
  ExpectTheRows(RecordingOf(text, Unit("deg")), kDegree);
  EXPECT_THAT(FaultOf("mass_A\nt\tx\t\u03B8\t\u03C9\n" + Rows("0.0{t}\t0.1\t1\t2"), Unit("deg")),
              HasSubstr("columns \"\u03B8\" and \"\u03C9\" could both be the quantity"));
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

TEST(Tracker, RequiresTheUnitOfAnAngle) {
  EXPECT_THAT(FaultOf("mass_A\nt\t\u03B8\n" + Rows("0.0{t}\t{v}"), Value("\u03B8", "")),
              HasSubstr("does not give its unit; end its name in _rad, _deg, _rad_s, _deg_s, _counts, _volts, _m_s2, "
                        "_px, _m, _cm or _mm, or give --unit"));
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
  EXPECT_TRUE(recording.warnings.empty());
}

TEST(Tracker, ALineAboveTheNamesMustContainLabels) {
  EXPECT_THAT(FaultOf("a recording of mine\nangle\trate\n" + Rows("{t}\t{v}")), HasSubstr("run.csv:1:1: none of the"));
  EXPECT_THAT(FaultOf("1\t2\nt\tx\n" + Rows("{t}\t{v}")), HasSubstr("run.csv:1:1: the first row has numbers"));
}

}  // namespace
}  // namespace pendulum::tracker_test
