// SPDX-License-Identifier: Apache-2.0
// Tests of files with quantities other than an angle or a rate in known units.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/base/warning_matchers.h"

namespace pendulum::other_quantities_test {
namespace {

using testing::HasSubstr;

const std::string kRows = "0,0\n1,1\n2,0\n3,-1\n4,0\n5,1\n6,0\n7,-1\n";

Recording Of(const std::string& text) {
  const Result<Recording> recording = ParseRecording(text, "run.csv");
  EXPECT_TRUE(recording) << text << (recording ? "" : recording.error().message());
  return recording.value_or(Recording());
}

TEST(ParseRecording, ReadsAccelerationsAndCoordinates) {
  const Recording acceleration = Of("time_s,acc (m/s^2)\n" + kRows);
  EXPECT_EQ(acceleration.quantity, Quantity::kAcceleration);
  EXPECT_EQ(acceleration.value_unit(), "m/s^2");
  EXPECT_TRUE(acceleration.shows_gravity);
  EXPECT_FALSE(Of("time_s,Linear Acceleration x (m/s^2)\n" + kRows).shows_gravity);
  const Recording pixels = Of("time_s,bob_px\n" + kRows);
  EXPECT_EQ(pixels.quantity, Quantity::kPosition);
  EXPECT_EQ(pixels.value_unit(), "px");
  const Recording centimetres = Of("time_s,x_cm\n" + kRows);
  EXPECT_EQ(centimetres.value_unit(), "m");
  EXPECT_DOUBLE_EQ(centimetres.value[1], 0.01 * pixels.value[1]);
  const Recording gyro = Of("time_s,gyro_volts\n" + kRows);
  EXPECT_EQ(gyro.quantity, Quantity::kRate);
  EXPECT_EQ(gyro.value_unit(), "volts");
  EXPECT_EQ(Of("time_s,rate_volts\n" + kRows).quantity, Quantity::kRate);
  EXPECT_EQ(Of("time_s,calibrated_volts\n" + kRows).quantity, Quantity::kAngle);
}

TEST(ParseRecording, NamesUnitsAsTheFileHasThem) {
  std::string text = "time_s,acc\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(0.01 * i) + "," + std::to_string(1 + 0.05 * std::cos(i)) + "\n";
  const Recording acceleration = Of(text);
  EXPECT_THAT(acceleration.warnings,
              testing::Contains(MessageIs(HasSubstr("was assumed to be in g (it is about 1 at rest)"))));
  ReadOptions rad;
  rad.unit = "rad";
  const auto overridden = ParseRecording("time_s,angle_mrad\n" + kRows, "run.csv", rad);
  ASSERT_TRUE(overridden);
  EXPECT_THAT(MessageText(overridden->warnings.at(0)), HasSubstr("names mrad, but --unit says rad, which was used"));
}

TEST(ParseRecording, PrefersAnAngleToCoordinates) {
  std::string text = "time_s,height_m,angle_rad\n";
  for (int i = 0; i < 8; ++i) text += std::to_string(i) + ",1," + std::to_string(i) + "\n";
  EXPECT_EQ(Of(text).quantity, Quantity::kAngle);
}

TEST(ParseRecording, ComputesAnglesFromBothCoordinates) {
  std::string text = "time_s,bob_x_px,bob_y_px\n";
  std::string metres = "time_s,y (m),x (m)\n";
  constexpr int kCount = 40;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 0.5 * std::sin(0.3 * i);
    const double x = 640 + 400 * std::sin(angle);
    const double y = 120 + 400 * std::cos(angle);
    text += std::to_string(0.01 * i) + "," + std::to_string(x) + "," + std::to_string(y) + "\n";
    metres += std::to_string(0.01 * i) + "," + std::to_string(-y) + "," + std::to_string(x) + "\n";
  }
  for (const Recording& recording : {Of(text), Of(metres)}) {
    EXPECT_EQ(recording.quantity, Quantity::kAngle);
    EXPECT_TRUE(recording.is_calibrated());
    ASSERT_TRUE(recording.arc);
    EXPECT_NEAR(recording.arc->radius, 400, 1e-3);
    for (int i = 0; i < kCount; ++i) EXPECT_NEAR(recording.value[i], 0.5 * std::sin(0.3 * i), 1e-6);
  }
  ReadOptions x_alone;
  x_alone.value_column = "bob_x_px";
  EXPECT_EQ(ParseRecording(text, "run.csv", x_alone)->quantity, Quantity::kPosition);
  ReadOptions y_alone;
  y_alone.value_column = "bob_y_px";
  const auto height = ParseRecording(text, "run.csv", y_alone);
  ASSERT_FALSE(height);
  EXPECT_EQ(height.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(height.error().message(), HasSubstr("is the same on both sides"));
  const auto alone = ParseRecording("time_s,y_px\n" + kRows, "run.csv");
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(alone.error().message(), HasSubstr("is the same on both sides"));
}

TEST(ParseRecording, RemovesATruncatedLastValue) {
  std::string text = "time_s,x_px,y_px\n";
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.5 * std::sin(0.3 * i);
    text += std::to_string(0.01 * i) + "," + std::to_string(640 + 400 * std::sin(angle)) + "," +
            std::to_string(120 + 400 * std::cos(angle)) + "\n";
  }
  EXPECT_EQ(Of(text.substr(0, text.size() - 1)).size(), 40);
  const Recording cut = Of(text.substr(0, text.rfind(',') + 2));  // keeps one digit of the last value
  EXPECT_EQ(cut.size(), 39);
  ASSERT_EQ(cut.warnings.size(), 1);
  EXPECT_EQ(cut.warnings[0].code, "incomplete_row");
}

}  // namespace
}  // namespace pendulum::other_quantities_test
