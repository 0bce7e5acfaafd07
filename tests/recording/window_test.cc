// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/window.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::window_test {
namespace {

constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// 21 samples at 10, 10.5, ..., 20 s; each value is its index.
Recording Ramp() {
  Recording recording;
  recording.path = "swing.csv";
  recording.sha256 = "abc";
  recording.quantity = Quantity::kRate;
  recording.unit = "deg/s";
  recording.time = Eigen::VectorXd::LinSpaced(21, 10.0, 20.0);
  recording.value = Eigen::VectorXd::LinSpaced(21, 0.0, 20.0);
  recording.resolution = 0.5;
  recording.warnings = {{"gaps", "message"}};
  return recording;
}

Status FaultOf(double from, double to) {
  const Result<Recording> window = SelectWindow(Ramp(), from, to);
  EXPECT_FALSE(window.has_value());
  return window ? Status{StatusCode::kInternal, "no fault"} : window.error();
}

TEST(SelectWindow, IncludesBothEnds) {
  const Result<Recording> window = SelectWindow(Ramp(), 12.0, 16.0);
  ASSERT_TRUE(window.has_value());
  EXPECT_EQ(window->size(), 9);
  EXPECT_EQ(window->time[0], 12.0);
  EXPECT_EQ(window->time[8], 16.0);
  EXPECT_EQ(window->value[0], 4.0);
  EXPECT_EQ(window->value[8], 12.0);
}

TEST(SelectWindow, SelectsSamplesBetweenArbitraryTimes) {
  const Result<Recording> window = SelectWindow(Ramp(), 11.9, 16.1);
  ASSERT_TRUE(window.has_value());
  EXPECT_EQ(window->size(), 9);
  EXPECT_EQ(window->time[0], 12.0);
}

TEST(SelectWindow, KeepsTheRecordingsProperties) {
  const Result<Recording> window = SelectWindow(Ramp(), 12.0, 16.0);
  ASSERT_TRUE(window.has_value());
  EXPECT_EQ(window->path, "swing.csv");
  EXPECT_EQ(window->sha256, "abc");
  EXPECT_EQ(window->quantity, Quantity::kRate);
  EXPECT_EQ(window->unit, "deg/s");
  EXPECT_EQ(window->resolution, 0.5);
  EXPECT_EQ(window->warnings.size(), 1);
}

TEST(SelectWindow, LeavesABoundOpenForNaN) {
  EXPECT_EQ(SelectWindow(Ramp(), kOpen, kOpen)->time, Ramp().time);
  EXPECT_EQ(SelectWindow(Ramp(), kOpen, kOpen)->value, Ramp().value);
  EXPECT_EQ(SelectWindow(Ramp(), 15.0, kOpen)->size(), 11);
  EXPECT_EQ(SelectWindow(Ramp(), kOpen, 15.0)->size(), 11);
  EXPECT_EQ(SelectWindow(Ramp(), -kInf, kInf)->size(), 21);
}

TEST(SelectWindow, RefusesAStartNotBeforeTheEnd) {
  EXPECT_EQ(FaultOf(15.0, 12.0).code, StatusCode::kInvalidArgument);
  EXPECT_EQ(FaultOf(15.0, 15.0).code, StatusCode::kInvalidArgument);
  EXPECT_EQ(FaultOf(kInf, kOpen).code, StatusCode::kInvalidArgument);
  EXPECT_EQ(FaultOf(15.0, 12.5).message(), "the window [15, 12.5] s is empty; its start must be before its end");
}

TEST(SelectWindow, RefusesFewerThanEightSamplesAndNamesTheSpans) {
  const Status fault = FaultOf(12.0, 15.0);  // 12, 12.5, ..., 15: seven samples.
  EXPECT_EQ(fault.code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(fault.message(),
            "swing.csv: the window [12, 15] s leaves 7 samples of a recording that spans [10, 20] s; at least 8 are "
            "needed: widen the window");
}

TEST(SelectWindow, RefusesAWindowOutsideTheRecording) {
  EXPECT_EQ(FaultOf(30.0, 40.0).code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(FaultOf(kOpen, 5.0).code, StatusCode::kFailedPrecondition);
}

TEST(SelectWindow, RefusesAnEmptyRecording) {
  const Result<Recording> window = SelectWindow(Recording(), kOpen, kOpen);
  ASSERT_FALSE(window.has_value());
  EXPECT_EQ(window.error().code, StatusCode::kFailedPrecondition);
}

// ---- Thinned --------------------------------------------------------------------------------------------------------

TEST(Thinned, KeepsEveryKThSampleWithinTheLimit) {
  const Recording third = Thinned(Ramp(), 7);  // 21 samples
  EXPECT_EQ(third.value, Eigen::VectorXd::LinSpaced(7, 0.0, 18.0));
  EXPECT_EQ(third.time, Eigen::VectorXd::LinSpaced(7, 10.0, 19.0));
  EXPECT_EQ(Thinned(Ramp(), 20).value, Eigen::VectorXd::LinSpaced(11, 0.0, 20.0));
  EXPECT_EQ(Thinned(Ramp(), 6).value, Eigen::VectorXd::LinSpaced(6, 0.0, 20.0));
  EXPECT_EQ(Thinned(Ramp(), 1).value, Eigen::VectorXd::Zero(1));
}

TEST(Thinned, IsTheRecordingItselfIfShortEnough) {
  for (const Eigen::Index most : {21, 22, 1000}) {
    EXPECT_EQ(Thinned(Ramp(), most).time, Ramp().time) << most;
    EXPECT_EQ(Thinned(Ramp(), most).value, Ramp().value) << most;
  }
}

TEST(Thinned, KeepsTheRecordingsProperties) {
  const Recording thinned = Thinned(Ramp(), 7);
  EXPECT_EQ(thinned.path, "swing.csv");
  EXPECT_EQ(thinned.quantity, Quantity::kRate);
  EXPECT_EQ(thinned.resolution, 0.5);
  EXPECT_EQ(thinned.warnings.size(), 1);
}

// ---- Excerpt --------------------------------------------------------------------------------------------------------

TEST(Excerpt, HasTheRequestedDensityAndTheAllowedLength) {
  // 21 samples, one every half second from 10 s on.
  const Recording first = Excerpt(Ramp(), 9, 2, false);
  EXPECT_EQ(first.time[0], 10);
  EXPECT_LE(first.time[first.size() - 1], 14.5);
  EXPECT_LE(first.size(), 9);
  const Recording last = Excerpt(Ramp(), 9, 2, true);
  EXPECT_GE(last.time[last.size() - 1], 19.5);
  EXPECT_GE(last.time[0], 15.5);
}

TEST(Excerpt, IsTheWholeRecordingIfDenseEnough) { EXPECT_EQ(Excerpt(Ramp(), 100, 2, false).time, Ramp().time); }

}  // namespace
}  // namespace pendulum::window_test
