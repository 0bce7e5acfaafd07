// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/ros.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::ros_test {
namespace {

using testing::HasSubstr;

ReadOptions Value(const std::string& column) { return TimeAndValue("", column); }

/// Seconds from the first stamp to the second, as one StampClock gives them.
double SecondsBetween(const std::string& first, const std::string& second) {
  csv::StampClock clock;
  double time = -1;
  EXPECT_TRUE(clock.Read(first, "", time));
  EXPECT_EQ(time, 0);
  EXPECT_TRUE(clock.Read(second, "", time)) << second;
  return time;
}

TEST(StampClock, KeepsNanosecondsLostInADouble) {
  EXPECT_DOUBLE_EQ(SecondsBetween("1700000000000000000", "1700000000000000001"), 1e-9);
  EXPECT_DOUBLE_EQ(SecondsBetween("1700000000.000000001", "1700000000.000000004"), 3e-9);
  EXPECT_DOUBLE_EQ(SecondsBetween("1700000000.5", "1700000001"), 0.5);
  EXPECT_DOUBLE_EQ(SecondsBetween("1.7000000005e+09", "1.700000001e+09"), 0.5);
  EXPECT_DOUBLE_EQ(SecondsBetween("5", "3.25"), -1.75);
}

TEST(StampClock, RefusesInvalidStamps) {
  csv::StampClock clock;
  double time = 0;
  for (const char* const text : {"", "x", "1.2.3", "1e300", "99999999999999999999", "1.5x"}) {
    EXPECT_FALSE(clock.Read(text, "", time)) << text;
  }
  // Beyond 64 bits: -2^63 s in nanoseconds, and the sum of 2^63 - 1 ns and 5 ns.
  EXPECT_FALSE(clock.Read("-9223372036854775808.0", "", time));
  EXPECT_FALSE(clock.Read("9223372036854775807", "5", time));
  for (const char* const text : {"x", "-1", "1000000000"}) EXPECT_FALSE(clock.Read("1700000000", text, time)) << text;
}

// ---- One row per message -----------------------------------------------------------------------------------------

/// Eight stamps at intervals of 10 ms that cross a full second.
std::string Stamped(const std::string& header, const std::string& pattern) {
  std::string text = header + "\n";
  for (int i = 0; i < 8; ++i) {
    const int ns = 950'000'000 + i * 10'000'000;
    std::string row = pattern;
    const std::string sec = std::to_string(1'700'000'000 + ns / 1'000'000'000);
    const std::string rest = std::to_string(ns % 1'000'000'000);
    const std::string nine = std::string(9 - rest.size(), '0') + rest;
    for (const auto& [mark, number] : {std::pair<std::string, std::string>{"{s}", sec},
                                       {"{n}", rest},
                                       {"{9}", nine},
                                       {"{v}", std::to_string(100 + i)}}) {
      for (std::size_t at = 0; (at = row.find(mark)) != std::string::npos;) row.replace(at, mark.size(), number);
    }
    text += row + "\n";
  }
  return text;
}

TEST(Ros, ReadsStampsInAnyFormat) {
  ExpectTheRows(RecordingOf(Stamped("%time,field.position0,field.velocity0", "{s}{9},{v},1")));
  ExpectTheRows(RecordingOf(Stamped("Time,header.stamp.secs,header.stamp.nsecs,position_0", "7,{s},{n},{v}")));
  ExpectTheRows(RecordingOf(Stamped("header.stamp.sec,header.stamp.nanosec,position[0]", "{s},{n},{v}")));
  ExpectTheRows(RecordingOf(Stamped("__time,/joint_states/pendulum/position", "{s}.{9},{v}")));
  ExpectTheRows(RecordingOf(Stamped("time,/joint_states/pendulum/position", "{s}.{9},{v}")));
  ExpectTheRows(RecordingOf(Stamped("%time,field.header.stamp,field.position", "{s}{n}99,{s}{9},{v}")));
}

TEST(Ros, SimulationStampsAreSmallButInNanoseconds) {
  ExpectTheRows(RecordingOf("%time,field.position\n" + Rows("{t}000000,{v}")));
}

TEST(Ros, SmallWholeNumbersOfAStampAreMilliseconds) {
  const std::string text = "stamp,angle_rad\n" + Rows("{t},{v}");
  ExpectTheRows(RecordingOf(text));
  EXPECT_EQ(RecordingOf(text).warnings.at(0).code, "time_unit_assumed");
  ExpectTheRows(RecordingOf(text, TimeAndValue("stamp:ms", "")));
  ExpectTheRows(RecordingOf("%time,field.position\n" + Rows("{t},{v}"), TimeAndValue("%time:ms", "")));
  ExpectTheRows(RecordingOf("stamp,angle_rad\n" + Rows("0.0{t},{v}")));
}

TEST(Ros, AStampBesideATimeIsIgnored) {
  ExpectTheRows(RecordingOf("time_ms,stamp,angle_rad\n" + Rows("{t},7,{v}")));
  ExpectTheRows(RecordingOf("time_ms,sec,nsec,angle_rad\n" + Rows("{t},7,8,{v}")));
}

TEST(Ros, WholeNumbersOfAPlainTimeAreMilliseconds) {
  const std::string text = "time,/js/a/position\n" + Rows("{t},{v}");
  ExpectTheRows(RecordingOf(text));
  ExpectTheRows(RecordingOf(text, TimeAndValue("time:ms", "")));
  ExpectTheRows(RecordingOf("time stamp,angle_rad\n" + Rows("{t},{v}")));
}

TEST(Ros, AJointGivesTheAngleUnlessTheRateIsRequested) {
  const std::string text = Stamped("__time,/js/a/position,/js/a/velocity,/js/a/effort", "{s}.{9},1,{v},2");
  EXPECT_EQ(RecordingOf(text).quantity, Quantity::kAngle);
  ExpectTheRows(RecordingOf(text, Value("/js/a/velocity")));
  ExpectTheRows(RecordingOf(text, Unit("rad_s")));
  EXPECT_EQ(RecordingOf(text, Unit("rad_s")).quantity, Quantity::kRate);
}

/// REP 145: drivers publish under this name the specific force, which includes gravity.
TEST(Ros, ImuAccelerationsIncludeGravity) {
  const Recording recording = RecordingOf(Stamped("%time,field.linear_acceleration.x", "{s}{9},{v}"));
  ExpectTheRows(recording);
  EXPECT_EQ(recording.quantity, Quantity::kAcceleration);
  EXPECT_TRUE(recording.shows_gravity);
  const std::string paths = Stamped("__time,/imu/linear_acceleration/x,/imu/linear_acceleration/y", "{s}.{9},{v},1");
  EXPECT_TRUE(RecordingOf(paths, Value("/imu/linear_acceleration/x")).shows_gravity);
  EXPECT_FALSE(RecordingOf("time_s,Linear Acceleration x (m/s^2)\n" + Rows("0.0{t},{v}")).shows_gravity);
}

TEST(Ros, BothCoordinatesOfAPointGiveTheAngle) {
  std::string text = "header.stamp.sec,header.stamp.nanosec,y_px,x_px\n";
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.5 * std::sin(0.3 * i);
    text += "1700000000," + std::to_string(10'000'000 * i) + "," + std::to_string(120 + 400 * std::cos(angle)) + "," +
            std::to_string(640 + 400 * std::sin(angle)) + "\n";
  }
  const Recording recording = RecordingOf(text);
  ASSERT_TRUE(recording.arc);
  for (int i = 0; i < 40; ++i) EXPECT_NEAR(recording.value[i], 0.5 * std::sin(0.3 * i), 1e-6);
}

TEST(Ros, RefusesTwoJointsAndAxes) {
  EXPECT_THAT(FaultOf(Stamped("__time,/js/a/position,/js/b/position", "{s}.{9},1,{v}")),
              HasSubstr("columns \"/js/a/position\" and \"/js/b/position\" could both be the quantity"));
  EXPECT_THAT(FaultOf(Stamped("%time,field.angular_velocity.x,field.angular_velocity.y", "{s}{9},1,{v}")),
              HasSubstr("could both be the quantity"));
  ExpectTheRows(RecordingOf(Stamped("%time,field.angular_velocity.x,field.angular_velocity.y", "{s}{9},1,{v}"),
                            Value("field.angular_velocity.y")));
}

TEST(Ros, RemovesRowsOfOtherTopics) {
  std::string text = Stamped("__time,/js/a/position,/temperature", "{s}.{9},{v},\n{s}.{9},,20");
  const Recording recording = RecordingOf(text);
  ExpectTheRows(recording);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "empty_cells");
}

TEST(Ros, ReportsAnInvalidStamp) {
  EXPECT_EQ(FaultOf("%time,field.position\nnow,1\n" + Rows("170000000{t},{v}")),
            "run.csv:2:1: column \"%time\" holds \"now\", which is not a time stamp of ROS; correct the field or "
            "delete the row");
}

// ---- One row per joint -------------------------------------------------------------------------------------------

const std::string kJoints = "header.stamp.sec,header.stamp.nanosec,name,position,velocity,effort";

TEST(JointTable, ChoosesTheOnlyMovingJoint) {
  ExpectTheRows(RecordingOf(Stamped(kJoints, "{s},{n},pendulum,{v},1,0")));
  ExpectTheRows(RecordingOf(Stamped(kJoints, "{s},{n},arm,0.5,0,0\n{s},{n},pendulum,{v},1,0")));
  ExpectTheRows(RecordingOf("time_s,joint,angle_deg\n" + Rows("0.0{t},a,1\n0.0{t},b,{v}")), kDegree);
}

TEST(JointTable, RefusesSeveralMovingJointsAndNamesThem) {
  const std::string text = Stamped(kJoints, "{s},{n},elbow,{v},1,0\n{s},{n},pendulum,{v},{v},0");
  EXPECT_EQ(FaultOf(text),
            "run.csv:1:1: \"elbow/position\" and \"pendulum/position\" could both be the quantity; choose one with "
            "--value_column");
  ExpectTheRows(RecordingOf(text, Value("pendulum")));
  ExpectTheRows(RecordingOf(text, Value("pendulum/position")));
  const Recording rate = RecordingOf(text, Value("pendulum/velocity"));
  ExpectTheRows(rate);
  EXPECT_EQ(rate.quantity, Quantity::kRate);
  EXPECT_EQ(WrongFlag(text, Value("wrist")),
            "run.csv:1:1: --value_column is \"wrist\", which is neither a column nor one of \"elbow\" and "
            "\"pendulum\"; give one of these");
}

TEST(JointTable, RefusesBothCoordinatesOfAPoint) {
  const std::string text = "time_s,joint,x_px,y_px\n" + Rows("0.0{t},bob,{v},5");
  EXPECT_EQ(FaultOf(text),
            "run.csv:1:19: columns \"x_px\" and \"y_px\" are both coordinates of a point, but only one is read if "
            "each row belongs to one joint; choose it with --value_column, or keep the rows of one joint and leave out "
            "column \"joint\"");
  EXPECT_EQ(RecordingOf(text, Value("x_px")).quantity, Quantity::kPosition);
}

TEST(JointTable, RefusesATextColumnWithoutJoints) {
  std::string text = "time_s,name,angle_deg\n";
  for (int i = 0; i < 1001; ++i) text += std::to_string(i) + ",n" + std::to_string(i) + ",1\n";
  EXPECT_THAT(FaultOf(text), HasSubstr("run.csv:1002:1: column \"name\" holds more than 1000 names up to here"));
}

TEST(JointTable, IgnoresANameColumnInAnOrdinaryTable) {
  ExpectTheRows(RecordingOf("time_ms,name,angle_rad\n" + Rows("{t},7,{v}")));
}

}  // namespace
}  // namespace pendulum::ros_test
