// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::sensor_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kDegree = 0.017453292519943295;  // rad, NIST SP 811, table 6

/// The text of a calibration with one key replaced or added.
std::string With(const std::string& key, const std::string& value) {
  auto json =
      nlohmann::ordered_json::parse(R"({"input": "counts", "angle_unit": "deg", "coefficients": [-49.6, 0.2]})");
  json[key] = nlohmann::ordered_json::parse(value);
  return json.dump();
}

Calibration CalibrationOf(const std::string& text) {
  const Result<Calibration> calibration = ParseCalibration(text, "cal.json");
  EXPECT_TRUE(calibration.has_value()) << (calibration ? "" : calibration.error().message());
  return calibration.value_or(Calibration());
}

std::string FaultOf(const std::string& text) {
  const Result<Calibration> calibration = ParseCalibration(text, "cal.json");
  EXPECT_FALSE(calibration.has_value()) << text;
  if (calibration) return "";
  EXPECT_EQ(calibration.error().code, StatusCode::kDataLoss);
  return calibration.error().message();
}

TEST(ParseCalibration, ReadsEveryKey) {
  const std::string text =
      R"({"schema_version": 1, "input": "volts", "angle_unit": "rad", "coefficients": [1, -2, 0.5],
          "covariance": [[4, 1, 0], [1, 9, 0], [0, 0, 0]], "residual_std_dev": 0.25, "input_range": [0, 5]})";
  const Calibration calibration = CalibrationOf(text);
  EXPECT_EQ(calibration.input, "volts");
  EXPECT_EQ(calibration.angle_unit, "rad");
  EXPECT_THAT(calibration.coefficients, ElementsAre(1, -2, 0.5));
  EXPECT_EQ(calibration.covariance, (Eigen::MatrixXd(3, 3) << 4, 1, 0, 1, 9, 0, 0, 0, 0).finished());
  EXPECT_EQ(calibration.residual_std_dev, 0.25);
  ASSERT_TRUE(calibration.input_range);
  EXPECT_EQ(calibration.input_range->low, 0);
  EXPECT_EQ(calibration.input_range->high, 5);
  EXPECT_EQ(calibration.source, nlohmann::ordered_json::parse(text));
}

TEST(ParseCalibration, NeedsOnlyInputUnitAndCoefficients) {
  for (const std::string& text : {With("input_range", "null"), With("covariance", "null")}) {
    const Calibration calibration = CalibrationOf(text);
    EXPECT_EQ(calibration.covariance.size(), 0);
    EXPECT_FALSE(calibration.residual_std_dev);
    EXPECT_FALSE(calibration.input_range);
  }
}

/// The published table of the reference rig: straight line 0.1985 x - 49.6077 deg.
TEST(Calibration, ConvertsReadingsToRadians) {
  const Calibration line = CalibrationOf(With("coefficients", "[-49.6077, 0.1985]"));
  EXPECT_NEAR(line.Angle(261) / kDegree, 2.2008, 1e-12);  // 51.8085 - 49.6077, computed by hand
  EXPECT_DOUBLE_EQ(line.Slope(261), 0.1985 * kDegree);
}

TEST(Calibration, HasTheSlopeOfAHigherOrderCurve) {
  const Calibration cubic = CalibrationOf(R"({"input": "volts", "angle_unit": "rad", "coefficients": [1, 2, 3, 4]})");
  EXPECT_DOUBLE_EQ(cubic.Angle(2), 49);  // 1 + 4 + 12 + 32
  EXPECT_DOUBLE_EQ(cubic.Slope(2), 62);  // 2 + 12 + 48
}

TEST(Calibration, FindsTheReadingOfAnAngle) {
  const Calibration line = CalibrationOf(With("coefficients", "[-49.6077, 0.1985]"));
  EXPECT_NEAR(line.Reading(2.2008 * kDegree, 0), 261, 1e-9);
  // x³ + 2 x increases everywhere: 12 at 2, -33 at -3.
  const Calibration cubic = CalibrationOf(R"({"input": "volts", "angle_unit": "rad", "coefficients": [0, 2, 0, 1]})");
  EXPECT_NEAR(cubic.Reading(12, 0), 2, 1e-12);
  EXPECT_NEAR(cubic.Reading(-33, 5), -3, 1e-12);
  for (double reading = -4; reading <= 4; reading += 0.25) {
    EXPECT_NEAR(cubic.Reading(cubic.Angle(reading), reading + 0.3), reading, 1e-12);
  }
}

TEST(Calibration, FindsTheReadingNearestToTheGivenReading) {
  // x² - 1 is 3 at 2 and at -2.
  const Calibration parabola = CalibrationOf(With("coefficients", "[-1, 0, 1]"));
  EXPECT_NEAR(parabola.Reading(3 * kDegree, 1.5), 2, 1e-12);
  EXPECT_NEAR(parabola.Reading(3 * kDegree, -1.5), -2, 1e-12);
  EXPECT_EQ(parabola.Reading(3 * kDegree, 0), 0);  // the slope is 0 there: returns the given reading
}

TEST(Calibration, ConvertsItsUnit) {
  EXPECT_DOUBLE_EQ(CalibrationOf(With("angle_unit", "\"deg\"")).RadFromUnit(), kDegree);
  EXPECT_EQ(CalibrationOf(With("angle_unit", "\"rad\"")).RadFromUnit(), 1);
}

TEST(ParseCalibration, NamesAnUnknownOrMissingKey) {
  EXPECT_THAT(FaultOf(With("offset", "1")), StartsWith(R"(cal.json: "offset" is not a key of a calibration; )"));
  EXPECT_THAT(FaultOf(R"({"input": "counts", "angle_unit": "deg"})"),
              StartsWith(R"(cal.json: "coefficients" is missing; a calibration is {"input": "counts", )"));
}

TEST(ParseCalibration, RefusesValuesOfAnotherType) {
  EXPECT_EQ(FaultOf(With("input", "\"px\"")), R"(cal.json: "input" is "px"; it must be "counts" or "volts")");
  EXPECT_EQ(FaultOf(With("input", "1")), R"(cal.json: "input" is 1; it must be "counts" or "volts")");
  EXPECT_EQ(FaultOf(With("angle_unit", "null")), R"(cal.json: "angle_unit" is null; it must be "deg" or "rad")");
  EXPECT_EQ(FaultOf(With("schema_version", "2")), R"(cal.json: "schema_version" is 2; it must be 1)");
  EXPECT_EQ(FaultOf(With("coefficients", "{}")),
            R"(cal.json: "coefficients" is an object; it must be an array of numbers)");
  EXPECT_EQ(FaultOf(With("coefficients", "[1, \"2\"]")), R"(cal.json: "coefficients" holds "2"; it must hold numbers)");
  EXPECT_EQ(FaultOf(With("residual_std_dev", "-1")),
            R"(cal.json: "residual_std_dev" is -1; it must be a number, 0 or more)");
  EXPECT_THAT(FaultOf(With("coefficients", "[1, 2]").replace(0, 1, "[{")), StartsWith("cal.json:1:"));
}

TEST(ParseCalibration, RefusesACurveWithoutAngles) {
  EXPECT_EQ(FaultOf(With("coefficients", "[]")),
            R"(cal.json: "coefficients" is empty; it must hold at least an offset and a slope)");
  for (const char* const flat : {"[3]", "[3, 0]", "[3, 0, 0.0]"}) {
    EXPECT_EQ(FaultOf(With("coefficients", flat)),
              R"(cal.json: "coefficients" has no slope, so that every reading would be the same angle; )"
              "give [offset, slope]");
  }
  EXPECT_EQ(FaultOf(With("coefficients", "[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]")),
            R"(cal.json: "coefficients" has 17 numbers; there may be at most 16)");
}

TEST(ParseCalibration, RefusesNonFiniteNumbers) {
  EXPECT_THAT(FaultOf(R"({"input": "counts", "angle_unit": "deg", "coefficients": [1, NaN]})"),
              HasSubstr("this is not JSON"));
  EXPECT_EQ(FaultOf(R"({"input": "counts", "angle_unit": "deg", "coefficients": [1, 1e999]})"),
            R"(cal.json: "coefficients" is larger than a number can be (about 1e308); correct it)");
}

TEST(ParseCalibration, RefusesAnInvalidCovariance) {
  EXPECT_EQ(FaultOf(With("covariance", "[[1, 0]]")),
            R"(cal.json: "covariance" is an array; it must be one row of 2 numbers for each of the 2 coefficients)");
  EXPECT_EQ(FaultOf(With("covariance", "[[1, 0], [0]]")),
            R"(cal.json: "covariance" has a row of 1 numbers; it must be one row of 2 numbers for each of the 2 )"
            "coefficients");
  EXPECT_EQ(FaultOf(With("covariance", "[[1, 0.5], [0.25, 1]]")),
            R"(cal.json: "covariance" is not symmetric: the mirrored elements 0.25 and 0.5 must be equal)");
  EXPECT_EQ(FaultOf(With("covariance", "[[1, 0], [0, -1]]")),
            R"(cal.json: "covariance" has the variance -1; variances must be 0 or more)");
  EXPECT_EQ(FaultOf(With("covariance", "[[1, 3], [3, 4]]")),
            R"(cal.json: "covariance" has the covariance 3, larger than the product of its standard deviations, 2)");
}

TEST(ParseCalibration, RefusesARangeThatDoesNotIncrease) {
  for (const char* const range : {"[5, 5]", "[5, 0]", "[0]", "[0, 1, 2]"}) {
    EXPECT_EQ(FaultOf(With("input_range", range)),
              R"(cal.json: "input_range" is an array; it must be two increasing numbers or null)");
  }
}

TEST(ReadCalibration, ReadsAFileAndReportsAMissingFile) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "sensor_test.json";
  std::ofstream(path) << With("input_range", "[0, 1023]");
  const Result<Calibration> calibration = ReadCalibration(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(calibration.has_value());
  EXPECT_EQ(calibration->input_range->high, 1023);
  const Result<Calibration> missing = ReadCalibration("/nowhere/cal.json");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, StatusCode::kNotFound);
  EXPECT_EQ(missing.error().message(), "/nowhere/cal.json: there is no such file; check the path");
}

}  // namespace
}  // namespace pendulum::sensor_test
