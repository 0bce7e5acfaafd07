// SPDX-License-Identifier: Apache-2.0
// The files of Sensor Logger, whose header names neither sensor nor unit (its documentation: rates in rad/s,
// accelerations in m/s^2, TotalAcceleration with gravity, Accelerometer without).
#include "recording/readers/text/phone_log.h"

#include <cmath>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"
#include "tests/recording/zip_files.h"

namespace pendulum::phone_log_test {
namespace {

using testing::HasSubstr;

/// A swing of amplitude 2 about an axis askew: 0.8 in the second axis, 0.6 in the last.
std::string Log(const std::string& axes = "z,y,x") {
  std::string text = "time,seconds_elapsed," + axes + "\n";
  for (int i = 0; i < 500; ++i) {
    const double value = 2 * std::cos(0.1 * i);
    text += std::to_string(1'700'000'000'000'000'000 + 10'000'000LL * i) + "," + std::to_string(0.01 * i) + ",0," +
            std::to_string(0.8 * value) + "," + std::to_string(0.6 * value) + "\n";
  }
  return text;
}

Recording Read(const std::string& name, const ReadOptions& options = {}) {
  const Result<Recording> recording = ParseRecording(Log(), name, options);
  EXPECT_TRUE(recording.has_value()) << name << (recording ? "" : recording.error().message());
  return recording.value_or(Recording());
}

void ExpectRates(const Recording& recording) {
  EXPECT_EQ(recording.quantity, Quantity::kRate);
  ASSERT_EQ(recording.size(), 500);
  EXPECT_NEAR(recording.value[0], 2, 1e-5);
  EXPECT_NEAR(recording.time[1] - recording.time[0], 0.01, 1e-9);
}

TEST(PhoneLog, ReadsARateAboutAnAskewAxis) {
  for (const char* const name : {"Gyroscope.csv", "a/gyro.csv", "run.zip:Gyroscope.csv"}) ExpectRates(Read(name));
}

TEST(PhoneLog, KnowsWhichAccelerationContainsGravity) {
  EXPECT_TRUE(Read("TotalAcceleration.csv").shows_gravity);
  EXPECT_FALSE(Read("Accelerometer.csv").shows_gravity);
  EXPECT_EQ(Read("Accelerometer.csv").quantity, Quantity::kAcceleration);
}

TEST(PhoneLog, AsksForTheUnitOfAnotherNameAndThenCombinesTheAxes) {
  const auto refused = ParseRecording(Log(), "run.csv");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("x, y and z may be rates, accelerations or coordinates"));
  EXPECT_THAT(refused.error().try_flags, testing::ElementsAre("--unit rad_s"));
  ExpectRates(Read("run.csv", Unit("rad_s")));
  ExpectRates(Read("run.csv", TimeAndValue("", "combined", "rad_s")));
}

TEST(PhoneLog, CombinesEachTwoOfTheThreeAxes) {
  for (const char* const axes : {"z,y,x", "x,z,y", "y,x,z"}) {
    ExpectRates(RecordingOf(Log(axes), Unit("rad_s")));
    ExpectRates(RecordingOf(Log(axes), TimeAndValue("", "combined", "rad_s")));
  }
}

TEST(PhoneLog, ProposesTheUnitOfAnAccelerationIfTheReadingsContainGravity) {
  for (const auto& [rest, unit] : {std::pair{9.81, "--unit m_s2"}, {1.0, "--unit g"}}) {
    std::string text = "t_s,x,y,z\n";
    for (int i = 0; i < 500; ++i) {
      text += std::to_string(0.01 * i) + "," + std::to_string(0.1 * rest * std::cos(0.1 * i)) + ",0," +
              std::to_string(rest * (1 + 0.01 * std::cos(0.2 * i))) + "\n";
    }
    EXPECT_THAT(ParseRecording(text, "run.csv").error().try_flags, testing::ElementsAre(unit));
  }
}

TEST(PhoneLog, PrefersTheGyroInAnArchive) {
  const Recording recording = RecordingOf(
      ZipOf({{"Accelerometer.csv", Log()}, {"GyroscopeUncalibrated.csv", Log()}, {"Gyroscope.csv", Log()}}));
  ExpectRates(recording);
  EXPECT_EQ(recording.warnings.at(0).code, "member_assumed");
}

TEST(PhoneLog, AsksWhichOfSeveralGyrosOrOtherFilesIsMeant) {
  EXPECT_THAT(FaultOf(ZipOf({{"gyro_1.csv", Log()}, {"gyro_2.csv", Log()}})), HasSubstr("could all be the quantity"));
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const std::string rate = "time_s,rate_deg_s\n" + Rows("0.0{t},{v}");
  EXPECT_THAT(FaultOf(ZipOf({{"angle.csv", angle}, {"gyro.csv", rate}})), HasSubstr("could both be the quantity"));
}

TEST(PhoneLog, LeavesOtherColumnsAlone) {
  std::string preamble = "Vertical Units,m\n" + Log();
  EXPECT_FALSE(ParseRecording(preamble, "run.csv"));
  std::string two = "t_s,a,b\n";
  for (int i = 0; i < 500; ++i) {
    const double value = std::cos(0.1 * i);
    two += std::to_string(0.01 * i) + "," + std::to_string(value) + "," + std::to_string(0.3 * value * value * value) +
           "\n";
  }
  EXPECT_THAT(FaultOf(two, Unit("rad")), HasSubstr("several columns swing"));
}

}  // namespace
}  // namespace pendulum::phone_log_test
