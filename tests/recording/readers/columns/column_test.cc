// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/column.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum::column_test {
namespace {

using csv::Kind;
using csv::MeaningOf;
using csv::NameMeaning;

struct Expected {
  std::string_view name;
  Kind kind;
  std::string_view unit;  // Suffix; empty: not in the name.
};

TEST(MeaningOf, ReadsNamesInManyForms) {
  const std::vector<Expected> names = {
      {"t", Kind::kTime, ""},
      {"Time", Kind::kTime, ""},
      {"t [s]", Kind::kTime, "s"},
      {"t/s", Kind::kTime, "s"},
      {"t in s", Kind::kTime, "s"},
      {"Time_Elapsed(s)", Kind::kTime, "s"},
      {"seconds_elapsed", Kind::kTime, "s"},
      {"millis", Kind::kTime, "ms"},
      {"timeMs", Kind::kTime, "ms"},
      {"time (\u00B5s)", Kind::kTime, "us"},
      {"Zeit", Kind::kTime, ""},
      {"Zeit in Sekunden", Kind::kTime, "s"},
      {"Temps (s)", Kind::kTime, "s"},
      {"\"Zeit\" t / s", Kind::kTime, "s"},
      {"acc_time", Kind::kTime, ""},
      {"theta", Kind::kAngle, ""},
      {"\u03B8", Kind::kAngle, ""},
      {"phi/deg", Kind::kAngle, "deg"},
      {"angle in deg", Kind::kAngle, "deg"},
      {"degrees", Kind::kAngle, "deg"},
      {"angleDeg", Kind::kAngle, "deg"},
      {"\u00C1ngulo (grados)", Kind::kAngle, "deg"},
      {"\"Winkel\" w / rad", Kind::kAngle, "rad"},
      {"Winkel (\xB0)", Kind::kAngle, "deg"},  // Latin-1
      {"t (\xB5s)", Kind::kTime, "us"},
      {"position", Kind::kAngle, ""},
      {"Position (rad)", Kind::kAngle, "rad"},
      {"Voltage ( V )", Kind::kRaw, "volts"},
      {"CH1 (mV)", Kind::kRaw, "mv"},
      {"counts", Kind::kRaw, "counts"},
      {"gyro_rad_s", Kind::kRate, "rad_s"},
      {"Gyro [\u00B0/s]", Kind::kRate, "deg_s"},
      {"Rotation z (rad/s)", Kind::kRate, "rad_s"},
      {"Angular Velocity", Kind::kRate, ""},
      {"Linear Acceleration x (m/s^2)", Kind::kAcceleration, "m_s2"},
      {"Beschleunigung y (m/s\u00B2)", Kind::kAcceleration, "m_s2"},
      {"az", Kind::kAcceleration, ""},
      {"a_x", Kind::kAcceleration, ""},
      {"ay [g]", Kind::kAcceleration, "g"},
      {"acc_x_mg", Kind::kAcceleration, "mg"},
      {"x (mg)", Kind::kAcceleration, "mg"},
      {"x (m)", Kind::kLength, "m"},
      {"spot_mm", Kind::kLength, "mm"},
      {"bob_y_px", Kind::kLength, "px"},
  };
  for (const Expected& expected : names) {
    const NameMeaning meaning = MeaningOf(expected.name);
    EXPECT_EQ(meaning.kind, expected.kind) << expected.name;
    EXPECT_EQ(meaning.unit == nullptr ? "" : meaning.unit->suffix, expected.unit) << expected.name;
  }
}

TEST(MeaningOf, RecognisesOtherQuantities) {
  for (const char* const name : {"Temperature (\u00B0C)", "v (m/s)", "delay_s", "force (N)", "temperature_C", "battery",
                                 "alpha (rad/s^2)", "mass (mg)", "weight_g", "Masse (g)"}) {
    EXPECT_FALSE(MeaningOf(name).kind) << name;
    EXPECT_TRUE(MeaningOf(name).has_other_unit) << name;
  }
  for (const char* const name : {"theta_min", "n", "min", "comment"}) EXPECT_EQ(MeaningOf(name).unit, nullptr) << name;
  EXPECT_TRUE(MeaningOf("theta_setpoint (deg)").is_secondary);
}

/// The second bytes of Cyrillic letters are the degree sign and other signs in Latin-1.
TEST(MeaningOf, DoesNotReadPartsOfALetterAsSigns) {
  const NameMeaning coordinate = MeaningOf("\u041A\u043E\u043E\u0440\u0434\u0438\u043D\u0430\u0442\u0430 (\u043C)");
  EXPECT_EQ(coordinate.unit, nullptr);
  EXPECT_FALSE(coordinate.kind);
  EXPECT_EQ(csv::PlainName("\u0430\u0435\u0431"), "\u0430\u0435\u0431");
  EXPECT_EQ(csv::PlainName("\xB0 \xE4t \u00C4"), "deg at a");
}

TEST(MeaningOf, ReportsASecondUnit) {
  const NameMeaning meaning = MeaningOf("angle_deg [rad]");
  ASSERT_NE(meaning.second, nullptr);
  EXPECT_EQ(meaning.unit->suffix, "rad");
  EXPECT_EQ(meaning.second->suffix, "deg");
}

}  // namespace
}  // namespace pendulum::column_test
