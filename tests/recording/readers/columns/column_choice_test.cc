// SPDX-License-Identifier: Apache-2.0
/// Which column carries the swing.
#include "recording/readers/columns/column_choice.h"

#include <array>
#include <cmath>
#include <cstdio>
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
  EXPECT_THAT(MessageText(recording.warnings.at(0)),
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
  EXPECT_THAT(MessageText(alone.warnings.at(0)), HasSubstr("or 'combined' for a sensor that is mounted askew"));
  EXPECT_LT(LargestError(RecordingOf(text, TimeAndValue("", "combined"))), 0.01);
}

/// Axes that are both askew by 45 degrees show the same, but neither is a copy of the other.
TEST(ChooseColumns, CombinesAxesThatShareTheSwingEqually) {
  const Recording recording = RecordingOf(Gyro({std::sqrt(0.5), std::sqrt(0.5), 0}, 0.0005));
  EXPECT_EQ(recording.warnings.at(0).code, "axes_combined");
  EXPECT_LT(LargestError(recording), 0.01);
}

/// The names of three axes: x, y and z stand for #, X, Y and Z for @.
std::string NamesOfAxes(const std::string& pattern) {
  std::string names = "Time (s)";
  for (const char axis : {'x', 'y', 'z'}) {
    names += ',';
    for (const char c : pattern) names += c == '#' ? axis : c == '@' ? static_cast<char>(axis - 'a' + 'A') : c;
  }
  return names;
}

TEST(ChooseColumns, RecognisesTheAxesOfAGyroByTheirNames) {
  for (const char* const pattern : {"Gyroscope # (rad/s)", "gyro@_rad_s", "gyro_#_rad_s", "w# (rad/s)",
                                    "Gyroscope @ [dps]", "rotationRate@(rad/s)", "# (rad/s)"}) {
    const Recording recording = RecordingOf(Gyro({0.6, 0, 0.8}, 0.002, NamesOfAxes(pattern)));
    EXPECT_EQ(recording.warnings.at(0).code, "axes_combined") << pattern;
  }
  for (const char* const pattern : {"gyro_#", "Gyr@"}) {
    const Recording recording = RecordingOf(Gyro({0.6, 0, 0.8}, 0.002, NamesOfAxes(pattern)), Unit("rad_s"));
    EXPECT_EQ(recording.warnings.at(0).code, "axes_combined") << pattern;
  }
}

/// The sum of two sensors on one axis would be 1.4 times the rate.
TEST(ChooseColumns, DoesNotCombineSensorsThatAreNotAxesInOneUnit) {
  for (const char* const names :
       {"time_s,gyro1_rad_s,gyro2_rad_s", "time_s,omega_encoder (rad/s),omega_gyro (rad/s)",
        "time_s,gyro_raw (rad/s),gyro_filtered (rad/s)", "time_s,gyro_x1_rad_s,gyro_x2_rad_s"}) {
    EXPECT_THAT(FaultOf(Gyro({1, 0.97}, 0.002, names)), HasSubstr("no single column carries the swing")) << names;
  }
  EXPECT_THAT(FaultOf(Gyro({0.6, 0.8 / kDegree}, 0.002, "time_s,gyro_x_rad_s,gyro_y_deg_s")),
              HasSubstr("no single column carries the swing"));
}

TEST(ChooseColumns, RefusesToCombineWhatIsNoRotation) {
  const ReadOptions combined = TimeAndValue("", "combined");
  for (const char* const names : {"time_s,Gyroscope x (rad/s)", "time_s,angle_deg", "time_s,Acceleration x (m/s^2)"}) {
    EXPECT_THAT(WrongFlag(Gyro({1}, 0.002, names), combined),
                HasSubstr("--value_column combined needs two or three gyro axes in one unit"))
        << names;
  }
  // An angle is preferred to a rate otherwise.
  const std::string both = Gyro({1, 0.6, 0.8}, 0.002, "time_s,angle_deg,gyro_x_rad_s,gyro_y_rad_s");
  EXPECT_LT(LargestError(RecordingOf(both, combined)), 0.02);
}

TEST(ChooseColumns, AsksForOneOfVeryManyColumns) {
  std::string text = "time_s";
  for (int column = 0; column < 65; ++column) text += ",c" + std::to_string(column) + "_deg";
  text += "\n";
  for (int i = 0; i < 300; ++i) {
    text += std::to_string(0.01 * i);
    for (int column = 0; column < 65; ++column) text += "," + std::to_string(20 * std::cos(0.1 * i + column));
    text += "\n";
  }
  EXPECT_THAT(FaultOf(text), HasSubstr("65 columns could all be the quantity: \"c0_deg\", "));
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
  EXPECT_THAT(recording.error().message(), HasSubstr("no single column carries the swing: \"lower_deg\" 53"));
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
  EXPECT_THAT(MessageText(recording.warnings.at(0)), HasSubstr("\"angle_rad\" shows the same"));
}

TEST(ChooseColumns, AColumnByItsNumberAlwaysWorks) {
  const std::string text = "a note\nanother, with commas, in it\ntime_s,comment,theta\n" + Rows("0.0{t},ok,{v}");
  ExpectTheRows(RecordingOf(text, TimeAndValue("1", "3", "deg")), kDegree);
  ExpectTheRows(RecordingOf(Rows("x,0.0{t},{v}"), TimeAndValue("2:s", "3", "deg")), kDegree);
}

TEST(ChooseColumns, ANumberOfAColumnIsWhole) {
  const std::string text = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  EXPECT_THAT(WrongFlag(text, TimeAndValue("", "1.5")), HasSubstr("--value_column is \"1.5\", which is none of the"));
}

TEST(ChooseColumns, QuotedNamesAreSeparatedByBlanks) {
  ExpectTheRows(RecordingOf("\"t\" \"theta\" \"omega\"\n" + Rows("0.0{t} {v} 0"), TimeAndValue("t:s", "theta", "deg")),
                kDegree);
  ExpectTheRows(RecordingOf("\"time s\" \"angle deg\"\n" + Rows("0.0{t} {v}")), kDegree);
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

std::string Refusal(const std::string& text) {
  const Result<Recording> recording = ParseRecording(text, "run.csv");
  EXPECT_FALSE(recording);
  return recording ? "" : recording.error().message();
}

/// A swing in degrees, with a time that grows by `step` in each row.
std::string Table(const std::string& header, double step) {
  std::string text = header + "\n";
  for (int i = 0; i < 1000; ++i) {
    text += std::to_string(step * i) + "," + std::to_string(20 * std::exp(-0.0005 * i) * std::cos(0.05 * i)) + "\n";
  }
  return text;
}

TEST(ChooseColumns, AsksForAnUnknownUnitInBrackets) {
  EXPECT_THAT(Refusal(Table("t (s),angle (brad)", 0.01)), HasSubstr("column \"angle (brad)\" is in \"brad\""));
  EXPECT_THAT(Refusal(Table("t (s),angle (0.1 deg)", 0.01)), HasSubstr("is in \"0.1 deg\""));
  EXPECT_THAT(Refusal(Table("t (10 ms),angle (deg)", 1)), HasSubstr("column \"t (10 ms)\" is in \"10 ms\""));
  EXPECT_THAT(Refusal(Table("t (cs),angle (deg)", 1)), HasSubstr("is in \"cs\""));
  for (const char* const header : {"t (s),theta (left)", "t (s),angle (encoder 1)"}) {
    EXPECT_NEAR(RecordingOf(Table(header, 0.01)).value[0], 20 * kDegree, 1e-6) << header;
  }
}

/// 0, 1, 2, ... are rows, or milliseconds at 1 kHz.
TEST(ChooseColumns, AsksWhetherATimeCountsRows) {
  EXPECT_THAT(Refusal(Table("t,angle_deg", 1)), HasSubstr("column \"t\" increases by 1 in each row"));
  EXPECT_NEAR(RecordingOf(Table("t,angle_deg", 1), TimeAndValue("t:ms", "")).time[1], 1e-3, 1e-12);
}

/// 125 rows a period and 0.4 a row are a period of 50 s, or of 0.05 s in milliseconds.
TEST(ChooseColumns, AsksWhetherASlowSwingIsInMilliseconds) {
  EXPECT_THAT(
      Refusal(Table("time,angle_deg", 0.4)),
      HasSubstr("column \"time\" does not give its unit, and the period is 50.3 s if the times are in s, and "
                "0.0503 s if they are in ms: give it with --time_column time:s and --gravity linear, or with :ms"));
  EXPECT_NEAR(RecordingOf(Table("time,angle_deg", 0.4), TimeAndValue("time:s", "")).time[1], 0.4, 1e-12);
}

/// A torsion pendulum with a period of 215 s, read every 10 s, and one of 8 s, read every second.
TEST(ChooseColumns, NamesSecondsFirstForWholeTimesOfASlowSwing) {
  const auto slow = [](double step, double period) {
    std::string text = "t,angle_deg\n";
    for (int i = 0; i < 90; ++i) {
      text += std::to_string(static_cast<int>(step * i)) + "," +
              std::to_string(20 * std::cos(2 * kPi * step * i / period)) + "\n";
    }
    return text;
  };
  EXPECT_THAT(Refusal(slow(10, 215)), HasSubstr("the period is 215 s if the times are in s, and 0.215 s"));
  EXPECT_THAT(Refusal(slow(1, 8)), HasSubstr("counts seconds, rows or milliseconds: give the unit with --time_column "
                                             "t:s and --gravity linear, or with :ms"));
}

TEST(ChooseColumns, ReadsTheDaysOfASpreadsheet) {
  for (const double step : {0.01, 1.0}) {  // s
    std::string text = "Date,angle_deg\n";
    for (int i = 0; i < 1000; ++i) {
      std::array<char, 32> day{};
      std::snprintf(day.data(), day.size(), "%.10f", 46331.507 + i * step / 86400);
      text += std::string(day.data()) + "," + std::to_string(20 * std::cos(0.05 * i)) + "\n";
    }
    const Recording recording = RecordingOf(text);
    EXPECT_EQ(recording.time[0], 0);
    EXPECT_NEAR(recording.time[999], 999 * step, 1e-4) << step;
  }
}

/// An angle and its rate in degrees: the sizes say nothing, because the units differ.
TEST(ChooseColumns, AsksWhichOfSeveralSwingsWithoutNames) {
  std::string text;
  for (int i = 0; i < 1000; ++i) {
    text += std::to_string(0.01 * i) + "," + std::to_string(20 * std::cos(0.05 * i)) + "," +
            std::to_string(-100 * std::sin(0.05 * i)) + "\n";
  }
  EXPECT_THAT(Refusal(text), HasSubstr("several columns swing, and their names do not say which is an angle"));
  EXPECT_NEAR(RecordingOf(text, TimeAndValue("", "2")).value[0], 20 * kDegree, 1e-6);
}

TEST(ChooseColumns, DerivativesAreNoAngles) {
  for (const std::string header : {"time,theta,omega,alpha", "t,theta,theta_dot,theta_ddot",
                                   "t,\u03B8,\u03B8\u0307,\u03B8\u0308", "t,phi,phi_punkt,phi_punktpunkt"}) {
    std::string text = header + "\n";
    for (int i = 0; i < 1000; ++i) {
      const double wave = 0.3 * std::cos(0.05 * i);
      text += std::to_string(0.01 * i) + "," + std::to_string(wave) + "," + std::to_string(-1.5 * std::sin(0.05 * i)) +
              "," + std::to_string(-25 * wave) + "\n";
    }
    EXPECT_NEAR(RecordingOf(text, Unit("rad")).value[0], 0.3, 1e-6) << header;
  }
}

TEST(ChooseColumns, AsksForMultiplesOfUnits) {
  for (const std::string unit : {"[1/25 s]", "(s x 10)", "(10ms)", "(ms*10)"}) {
    EXPECT_THAT(Refusal(Table("t " + unit + ",angle_deg", 0.01)), HasSubstr("which is not a unit known here")) << unit;
  }
  for (const std::string unit : {"[\u03C0 rad]", "(1/10 deg)", "(x0.1 rad)", "[rad/\u03C0]"}) {
    EXPECT_THAT(Refusal(Table("t (s),angle " + unit, 0.01)), HasSubstr("which is not a unit known here")) << unit;
  }
  EXPECT_NEAR(RecordingOf(Table("t (s),angle_gon", 0.01)).value[0], 18 * kDegree, 1e-6);
  EXPECT_NEAR(RecordingOf(Table("t (s),rate (rev/s)", 0.01)).value[0], 40 * kPi, 1e-6);
}

TEST(ChooseColumns, AsksWhetherWholeNumbersOfAnEncoderAreDegrees) {
  std::string text = "t (s),encoder\n";
  for (int i = 0; i < 1000; ++i) {
    text += std::to_string(0.01 * i) + "," + std::to_string(std::lround(190 * std::cos(0.05 * i))) + "\n";
  }
  EXPECT_THAT(Refusal(text), HasSubstr("the whole numbers of an encoder may be counts or degrees"));
}

TEST(ChooseColumns, FindsTheOtherCoordinateOfANameWithADot) {
  std::string text = "t (s),bob.x_px,bob.y_px\n";
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.5 * std::cos(0.05 * i);
    text += std::to_string(0.01 * i) + "," + std::to_string(300 + 200 * std::sin(angle)) + "," +
            std::to_string(100 + 200 * std::cos(angle)) + "\n";
  }
  EXPECT_TRUE(RecordingOf(text).arc);
}

TEST(ChooseColumns, TakesTheIncreasingOneOfXAndYForTheTime) {
  EXPECT_THAT(Refusal(Table("x,y", 0.01)), HasSubstr("\"y\" does not give its unit, and it may be a coordinate"));
  const Recording recording = RecordingOf(Table("x,y", 0.01), Unit("deg"));
  EXPECT_NEAR(recording.time[1], 0.01, 1e-9);
  EXPECT_EQ(recording.warnings.at(0).code, "time_column_assumed");
}

}  // namespace
}  // namespace pendulum::column_choice_test
