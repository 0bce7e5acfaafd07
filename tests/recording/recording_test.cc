// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/recording.h"

#include <cstdlib>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"

namespace pendulum::recording_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Recording Ramp(Eigen::Index size) {
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(size, 0.0, static_cast<double>(size - 1));
  recording.value = Eigen::VectorXd::Constant(size, 0.25);
  return recording;
}

Status FaultOf(const Recording& recording) {
  const Result<Recording> made = MakeRecording(recording);
  EXPECT_FALSE(made.has_value());
  return made ? Status{StatusCode::kInternal, "no fault"} : made.error();
}

TEST(MakeRecording, KeepsAValidRecordingUnchanged) {
  Recording recording = Ramp(kMinimumSamples);
  recording.path = "swing.csv";
  recording.unit = "deg";
  recording.resolution = 0.01;
  recording.warnings = {{"gaps", "message"}};
  const Result<Recording> made = MakeRecording(recording);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(made->path, "swing.csv");
  EXPECT_EQ(made->unit, "deg");
  EXPECT_EQ(made->resolution, 0.01);
  EXPECT_EQ(made->warnings.size(), 1);
  EXPECT_EQ(made->size(), kMinimumSamples);
  EXPECT_EQ(made->time, recording.time);
  EXPECT_EQ(made->value, recording.value);
}

TEST(MakeRecording, RefusesFewerThanEightSamples) {
  const Status fault = FaultOf(Ramp(7));
  EXPECT_EQ(fault.code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(fault.message(), "7 samples are too few for a recording; at least 8 are needed");
}

TEST(MakeRecording, RefusesAnEmptyRecording) { EXPECT_EQ(FaultOf(Recording()).code, StatusCode::kFailedPrecondition); }

TEST(MakeRecording, RefusesTimesAndValuesOfDifferentNumber) {
  Recording recording = Ramp(9);
  recording.value.conservativeResize(8);
  const Status fault = FaultOf(recording);
  EXPECT_EQ(fault.code, StatusCode::kDataLoss);
  EXPECT_THAT(fault.message(), HasSubstr("9 times and 8 values"));
}

TEST(MakeRecording, NamesTheFirstNonFiniteSample) {
  for (const double bad : {kNan, kInf, -kInf}) {
    Recording recording = Ramp(9);
    recording.value[3] = bad;
    recording.value[5] = bad;
    EXPECT_EQ(FaultOf(recording).code, StatusCode::kDataLoss);
    EXPECT_THAT(FaultOf(recording).message(), StartsWith("sample 3 is (3, "));

    recording = Ramp(9);
    recording.time[0] = bad;
    EXPECT_THAT(FaultOf(recording).message(), StartsWith("sample 0 is ("));
  }
}

TEST(MakeRecording, NamesTheFirstTimeThatDoesNotIncreaseAndThePath) {
  Recording recording = Ramp(9);
  recording.path = "swing.csv";
  recording.time[4] = 3.0;
  const Status fault = FaultOf(recording);
  EXPECT_EQ(fault.code, StatusCode::kDataLoss);
  EXPECT_EQ(fault.message(), "swing.csv: time 3 s of sample 4 does not follow 3 s; times must increase");
}

TEST(MakeRecording, RefusesAnInvalidResolution) {
  for (const double bad : {-0.1, kNan, kInf}) {
    Recording recording = Ramp(9);
    recording.resolution = bad;
    EXPECT_EQ(FaultOf(recording).code, StatusCode::kDataLoss);
    EXPECT_THAT(FaultOf(recording).message(), StartsWith("the resolution is " + NumberText(bad)));
  }
}

}  // namespace
}  // namespace pendulum::recording_test
