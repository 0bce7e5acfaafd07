// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/calibration_source.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::calibration_source_test {
namespace {

using testing::HasSubstr;

constexpr const char* kJson = R"({"input": "volts", "angle_unit": "deg", "coefficients": [-135, 54]})";

TEST(CalibrationFromText, ReadsJson) {
  const auto calibration = CalibrationFromText(std::string("\n ") + kJson, "cal.json");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->coefficients[1], 54);
  EXPECT_EQ(calibration->note, "");
}

TEST(CalibrationFromText, FitsALineToATable) {
  // angle = 54 V - 135 deg, with the errors -0.1, 0.3, -0.3, 0.1 deg, to which no parabola is similar.
  const auto calibration = CalibrationFromText("pot_volts,angle_deg\n1,-81.1\n2,-26.7\n3,26.7\n4,81.1\n", "table.csv");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_NEAR(calibration->coefficients[0], -135, 1e-9);
  EXPECT_NEAR(calibration->coefficients[1], 54, 1e-9);
  // The residual variance is 0.2 / 2 degrees of freedom.
  EXPECT_EQ(calibration->note,
            "the calibration is a straight line through the 4 points of table.csv: slope 54 deg per volt, residual "
            "standard deviation 0.32 deg");
  EXPECT_EQ(calibration->doubt, "");
}

TEST(CalibrationFromText, ReadsLinesThatEndWithReturns) {
  const auto calibration = CalibrationFromText("pot_volts,angle_deg\r1,-81\r2,-27\r", "table.csv");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_NEAR(calibration->coefficients[1], 54, 1e-9);
}

TEST(CalibrationFromText, SaysIfACurveFitsBetter) {
  std::string table = "adc_counts,angle_deg\n";
  for (int i = 0; i < 12; ++i) {
    table += std::to_string(80 * i) + "," + std::to_string(10 * i + 0.3 * i * i + (i % 2 == 0 ? 0.01 : -0.01)) + "\n";
  }
  const auto calibration = CalibrationFromText(table, "table.csv");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_THAT(calibration->doubt, HasSubstr("a parabola fits the points"));
}

TEST(CalibrationFromText, RefusesOtherTexts) {
  EXPECT_THAT(CalibrationFromText("{", "cal.json").error().message(), HasSubstr("cal.json:"));
  EXPECT_THAT(CalibrationFromText("", "cal.json").error().message(), HasSubstr("cal.json"));
  EXPECT_EQ(CalibrationFromText("PK\3\4 of a workbook", "cal.xlsx").error().message(),
            "cal.xlsx: this is neither CSV nor JSON in UTF-8; save the table of the calibration as CSV");
  EXPECT_THAT(CalibrationFromText("time_s,angle_deg\n0,1\n", "run.csv").error().message(),
              HasSubstr("A calibration is JSON, or a table with a column of counts or volts"));
}

TEST(CalibrationFromFile, NamesAMissingFile) {
  const auto calibration = CalibrationFromFile("nowhere/table.csv");
  ASSERT_FALSE(calibration);
  EXPECT_EQ(calibration.error().code, StatusCode::kNotFound);
}

}  // namespace
}  // namespace pendulum::calibration_source_test
