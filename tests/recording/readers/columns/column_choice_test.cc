// SPDX-License-Identifier: Apache-2.0
/// Which column carries the swing.
#include "recording/readers/columns/column_choice.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::column_choice_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

/// The rate of a decaying swing, rad/s.
double RateAt(int row) { return 2 * std::exp(-0.0005 * row) * std::sin(2 * kPi * row / 130); }

/// A gyro whose axes show these parts of the rate, with white noise.
std::string Gyro(const std::vector<double>& direction, double noise, const std::string& names = "") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> error(0, noise);
  std::string text =
      names.empty() ? "Time (s),Gyroscope x (rad/s),Gyroscope y (rad/s),Gyroscope z (rad/s)\n" : names + "\n";
  for (int i = 0; i < 2000; ++i) {
    text += std::to_string(0.01 * i);
    for (const double part : direction) text += "," + std::to_string(part * RateAt(i) + error(random));
    text += "\n";
  }
  return text;
}

double LargestError(const Recording& recording) {
  double largest = 0;
  for (int i = 0; i < recording.size(); ++i) largest = std::max(largest, std::abs(recording.value[i] - RateAt(i)));
  return largest;
}

TEST(ChooseColumns, TakesTheAxisThatSwings) {
  const Recording recording = RecordingOf(Gyro({0, 0, 1}, 0.002));
  EXPECT_LT(LargestError(recording), 0.01);
  EXPECT_THAT(recording.warnings.at(0).message,
              HasSubstr("column \"Gyroscope z (rad/s)\" carries 100 % of the swing and was used, not"));
}

/// 5 % of the variance on another axis make its readings alone 2.5 % too small.
TEST(ChooseColumns, CombinesTheAxesOfAGyroThatIsMountedAskew) {
  const double part = std::sqrt(0.05);
  const Recording recording = RecordingOf(Gyro({0, -part, std::sqrt(1 - part * part)}, 0.002));
  EXPECT_EQ(recording.warnings.at(0).code, "axes_combined");
  EXPECT_LT(LargestError(recording), 0.01);
  double scale = 0, sum = 0;
  for (int i = 0; i < recording.size(); ++i) {
    scale += recording.value[i] * RateAt(i);
    sum += RateAt(i) * RateAt(i);
  }
  EXPECT_NEAR(scale / sum, 1, 2e-4);
}

/// 1 % of the variance may be the cross-axis sensitivity of the sensor; the user knows how it is mounted.
TEST(ChooseColumns, ASmallShareIsCombinedOnlyOnRequest) {
  const std::string text = Gyro({0, 0.1, std::sqrt(0.99)}, 0.002);
  const Recording alone = RecordingOf(text);
  EXPECT_EQ(alone.warnings.at(0).code, "value_column_assumed");
  EXPECT_THAT(alone.warnings.at(0).message, HasSubstr("or 'combined' for a sensor that is mounted askew"));
  EXPECT_LT(LargestError(RecordingOf(text, TimeAndValue("", "combined"))), 0.01);
}

TEST(ChooseColumns, OneAxisIsUsedAloneOnRequest) {
  const Recording recording = RecordingOf(Gyro({0, 0.6, 0.8}, 0), TimeAndValue("", "Gyroscope z (rad/s)"));
  EXPECT_NEAR(recording.value[30], 0.8 * RateAt(30), 1e-6);
}

/// Two pendulums in one file: each column would be another answer.
TEST(ChooseColumns, AsksIfTwoColumnsSwingOnTheirOwn) {
  std::string text = "time_s,upper_deg,lower_deg\n";
  for (int i = 0; i < 1000; ++i) {
    text += std::to_string(0.01 * i) + "," + std::to_string(20 * std::cos(0.05 * i)) + "," +
            std::to_string(21 * std::cos(0.05 * i + 1.5)) + "\n";
  }
  const Result<Recording> recording = ParseRecording(text, "run.csv");
  ASSERT_FALSE(recording);
  EXPECT_THAT(recording.error().message, HasSubstr("no single column carries the swing: \"lower_deg\" 52"));
  EXPECT_THAT(recording.error().try_flags, ElementsAre("--value_column lower_deg"));
}

TEST(ChooseColumns, TheSameAngleInTwoUnitsIsOneCandidate) {
  std::string text = "time_s,angle_deg,angle_rad\n";
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.3 * std::cos(0.05 * i);
    text += std::to_string(0.01 * i) + "," + std::to_string(angle / kDegree) + "," + std::to_string(angle) + "\n";
  }
  const Recording recording = RecordingOf(text);
  EXPECT_NEAR(recording.value[0], 0.3, 1e-6);
  EXPECT_THAT(recording.warnings.at(0).message, HasSubstr("\"angle_rad\" shows the same"));
}

TEST(ChooseColumns, AColumnByItsNumberAlwaysWorks) {
  const std::string text = "a note\nanother, with commas, in it\ntime_s,comment,theta\n" + Rows("0.0{t},ok,{v}");
  ExpectTheRows(RecordingOf(text, TimeAndValue("1", "3", "deg")), kDegree);
  ExpectTheRows(RecordingOf(Rows("x,0.0{t},{v}"), TimeAndValue("2:s", "3", "deg")), kDegree);
}

/// Milliseconds that a header calls seconds, and degrees called radians, are not guessed away: a name that gives a unit
/// is believed, and the fit judges the physics.
TEST(ChooseColumns, AUnitInANameIsBelieved) {
  std::string text = "time_s,angle_rad\n";
  for (int i = 0; i < 1000; ++i) {
    text += std::to_string(10 * i) + "," + std::to_string(20 * std::cos(0.05 * i)) + "\n";
  }
  const Recording recording = RecordingOf(text);
  EXPECT_EQ(recording.time[1], 10);
  EXPECT_EQ(recording.value[0], 20);
  EXPECT_TRUE(recording.warnings.empty());
}

}  // namespace
}  // namespace pendulum::column_choice_test
