// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/calibrate.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/sensor.h"
#include "tests/recording/calibration_examples.h"

namespace pendulum::calibrate_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;
using testing::StartsWith;

// Results in doubles for a well-conditioned problem of at most 40 points are accurate to some 13 digits.
constexpr double kDigits = 1e-12;

CalibrationFit FitOf(const CalibrationTable& table, int order) {
  const Result<CalibrationFit> fit = CalibrateSensor(table, order);
  EXPECT_TRUE(fit.has_value()) << (fit ? "" : fit.error().message());
  return fit.value_or(CalibrationFit());
}

std::string FaultOf(const CalibrationTable& table, int order, StatusCode code = StatusCode::kDataLoss,
                    const std::optional<SensorRange>& range = std::nullopt) {
  const Result<CalibrationFit> fit = CalibrateSensor(table, order, range);
  EXPECT_FALSE(fit.has_value());
  if (fit) return "";
  EXPECT_EQ(fit.error().code, code);
  return fit.error().message();
}

double StdError(const CalibrationFit& fit, int k) { return std::sqrt(fit.calibration.covariance(k, k)); }

void ExpectRelative(double value, double expected, double tolerance) {
  EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}

/// NIST StRD, linear least squares, Norris: readings of an ozone monitor against a standard. Some readings occur
/// twice. A table in a file must not contain them, but least squares permits them.
TEST(CalibrateSensor, MeetsTheCertifiedValuesOfNorris) {
  const std::vector<double> y = {0.1, 338.8, 118.1, 888.0, 9.2,   228.1, 668.5, 998.5, 449.1, 778.9, 559.2, 0.3,
                                 0.1, 778.1, 668.8, 339.3, 448.9, 10.8,  557.7, 228.3, 998.0, 888.8, 119.6, 0.3,
                                 0.6, 557.6, 339.3, 888.0, 998.5, 778.9, 10.2,  117.6, 228.9, 668.4, 449.2, 0.2};
  const std::vector<double> x = {0.2, 337.4, 118.2, 884.6, 10.1,  226.5, 666.3, 996.3, 448.6, 777.0, 558.2, 0.4,
                                 0.6, 775.5, 666.9, 338.0, 447.5, 11.6,  556.0, 228.1, 995.8, 887.6, 120.2, 0.3,
                                 0.3, 556.8, 339.1, 887.2, 999.0, 779.0, 11.1,  118.3, 229.2, 669.1, 448.9, 0.5};
  const CalibrationFit fit = FitOf(TableOf("volts", "deg", x, y), 1);
  ExpectRelative(fit.calibration.coefficients[0], -0.262323073774029, kDigits);
  ExpectRelative(fit.calibration.coefficients[1], 1.00211681802045, kDigits);
  ExpectRelative(StdError(fit, 0), 0.232818234301152, kDigits);
  ExpectRelative(StdError(fit, 1), 0.429796848199937e-03, kDigits);
  ExpectRelative(*fit.calibration.residual_std_dev, 0.884796396144373, kDigits);
}

/// NIST StRD, linear least squares, Pontius: a load cell. Squares of its readings reach 9e12, but the constant of the
/// curve is only 7e-4.
TEST(CalibrateSensor, MeetsTheCertifiedValuesOfPontius) {
  const std::vector<double> y = {.11019,  .21956,  .32949,  .43899,  .54803,  .65694,  .76562,  .87487,
                                 .98292,  1.09146, 1.20001, 1.30822, 1.41599, 1.52399, 1.63194, 1.73947,
                                 1.84646, 1.95392, 2.06128, 2.16844, .11052,  .22018,  .32939,  .43886,
                                 .54798,  .65739,  .76596,  .87474,  .98300,  1.09150, 1.20004, 1.30818,
                                 1.41613, 1.52408, 1.63159, 1.73965, 1.84696, 1.95445, 2.06177, 2.16829};
  std::vector<double> x;
  for (int i = 0; i < 40; ++i) x.push_back(150000.0 * (i % 20 + 1));
  const CalibrationFit fit = FitOf(TableOf("volts", "deg", x, y), 2);
  constexpr double kNineDigits = 1e-9;  // the constant is 3e-4 of the largest y
  ExpectRelative(fit.calibration.coefficients[0], 0.673565789473684e-03, kNineDigits);
  ExpectRelative(fit.calibration.coefficients[1], 0.732059160401003e-06, kNineDigits);
  ExpectRelative(fit.calibration.coefficients[2], -0.316081871345029e-14, kNineDigits);
  ExpectRelative(StdError(fit, 0), 0.107938612033077e-03, kNineDigits);
  ExpectRelative(StdError(fit, 1), 0.157817399981659e-09, kNineDigits);
  ExpectRelative(StdError(fit, 2), 0.486652849992036e-16, kNineDigits);
  ExpectRelative(*fit.calibration.residual_std_dev, 0.205177424076185e-03, kNineDigits);
  ASSERT_TRUE(fit.lower_order);
  EXPECT_LT(fit.lower_order->p, 1e-10);  // certified t of the quadratic term: -64.95
  ExpectRelative(fit.lower_order->f, 64.94989 * 64.94989, 1e-5);
}

/// Expected values: normal equations in rational numbers (Python's fractions); covariance from numpy.linalg.inv(XᵀX).
TEST(CalibrateSensor, ReproducesThePublishedLineOfTheReferenceRig) {
  const CalibrationFit fit = FitOf(TableOf(kReferenceTable), 1);
  EXPECT_EQ(fit.calibration.input, "counts");
  EXPECT_EQ(fit.calibration.angle_unit, "deg");
  ExpectRelative(fit.calibration.coefficients[0], -49.607730223417796, kDigits);
  ExpectRelative(fit.calibration.coefficients[1], 0.19854437482214096, kDigits);
  ExpectRelative(StdError(fit, 0), 0.8729374441879819, kDigits);
  ExpectRelative(StdError(fit, 1), 0.002990040367168206, kDigits);
  ExpectRelative(fit.calibration.covariance(0, 1), -0.002233808157695656, 1e-11);
  EXPECT_EQ(fit.calibration.covariance(0, 1), fit.calibration.covariance(1, 0));
  ExpectRelative(*fit.calibration.residual_std_dev, 1.1946581111131394, kDigits);
}

/// Expected values from numpy.linalg.lstsq: the residuals, and for left_out seven straight lines, each through the six
/// other points.
TEST(CalibrateSensor, GivesResidualsAndLeaveOneOutResiduals) {
  const CalibrationTable table = TableOf(kReferenceTable);
  const CalibrationFit fit = FitOf(table, 1);
  constexpr double kPrinted = 5e-9;  // accuracy of the expected numbers
  EXPECT_THAT(fit.residual, Pointwise(DoubleNear(kPrinted), {0.8353871, 0.34892587, -0.53462412, -2.21235161,
                                                             0.27935278, 0.98415779, 0.29915218}));
  EXPECT_THAT(fit.left_out, Pointwise(DoubleNear(kPrinted), {1.59640944, 0.49090731, -0.64890123, -2.58342111,
                                                             0.33955301, 1.36054914, 0.55438179}));
  ExpectRelative(fit.LeaveOneOutRms().value(), 1.3179193510396188, 1e-11);
  EXPECT_EQ(fit.largest, 3);
}

TEST(CalibrateSensor, LeaveOneOutMatchesARefitWithoutThePoint) {
  const CalibrationTable table = TableOf(kReferenceTable);
  for (const int order : {1, 2, 3}) {
    const CalibrationFit whole = FitOf(table, order);
    const CalibrationTable reduced = TableOf("counts,angle_deg\n19,-45\n97,-30\n177,-15\n261,0\n396,30\n475,45\n");
    const CalibrationFit without = FitOf(reduced, order);
    EXPECT_NEAR(whole.left_out[4], 15 - without.calibration.Angle(324) / without.calibration.RadFromUnit(), 1e-10);
  }
}

/// Expected values from scipy.stats: f.sf(2.4380, 1, 4) with numpy's sums of squares 7.13604 and 4.43348; chi2 of
/// 7.13604 / (0.198544² / 12).
TEST(CalibrateSensor, TestsTheLineAgainstAParabolaAndAgainstRounding) {
  const CalibrationFit fit = FitOf(TableOf(kReferenceTable), 1);
  ASSERT_TRUE(fit.higher_order);
  EXPECT_EQ(fit.higher_order->order, 2);
  EXPECT_EQ(fit.higher_order->freedom, 4);
  ExpectRelative(fit.higher_order->f, (7.136040012242062 - 4.4334830513249575) / (4.4334830513249575 / 4), 1e-11);
  ExpectRelative(fit.higher_order->p, 0.19342955613506732, 1e-10);
  EXPECT_FALSE(fit.lower_order);
  ExpectRelative(fit.resolution, 0.19854437482214096, kDigits);
  ASSERT_TRUE(fit.rounding);
  ExpectRelative(fit.rounding->std_dev, 0.057314824124824526, kDigits);
  EXPECT_LT(fit.rounding->p, 1e-300);  // χ² = 2172 with 5 degrees of freedom
  const CalibrationFit parabola = FitOf(TableOf(kReferenceTable), 2);
  ASSERT_TRUE(parabola.lower_order);
  EXPECT_EQ(parabola.lower_order->f, fit.higher_order->f);
}

/// A straight line with counts rounded as by a converter. The residuals have a standard deviation of q / √12.
TEST(CalibrateSensor, FindsNoLackOfFitInRoundedCounts) {
  constexpr double kSlope = 0.25;
  std::vector<double> counts, angles;
  for (int i = 0; i < 200; ++i) {
    angles.push_back(-50 + 0.4711 * i);
    counts.push_back(std::round((angles.back() + 60) / kSlope));
  }
  const CalibrationFit fit = FitOf(TableOf("counts", "deg", counts, angles), 1);
  ExpectRelative(*fit.calibration.residual_std_dev, kSlope / std::sqrt(12.0), 0.15);  // 3 σ for 200 uniform errors
  ASSERT_TRUE(fit.rounding && fit.higher_order);
  EXPECT_GT(fit.rounding->p, 0.01);
  EXPECT_GT(fit.higher_order->p, 0.01);
}

TEST(CalibrateSensor, DetectsTrueCurvature) {
  std::vector<double> volts, angles;
  for (int i = 0; i < 12; ++i) {
    volts.push_back(0.4 * i);
    angles.push_back(-1 + 0.3 * volts.back() + 0.02 * volts.back() * volts.back() + (i % 3 - 1) * 1e-3);
  }
  const CalibrationTable table = TableOf("volts", "rad", volts, angles);
  EXPECT_LT(FitOf(table, 1).higher_order->p, 1e-6);
  const CalibrationFit parabola = FitOf(table, 2);
  EXPECT_LT(parabola.lower_order->p, 1e-6);
  EXPECT_GT(parabola.higher_order->p, 0.05);
  EXPECT_EQ(parabola.resolution, 0);  // a voltage has no step
  EXPECT_FALSE(parabola.rounding);
}

TEST(CalibrateSensor, RecoversPolynomialsOfEveryOrder) {
  const std::vector<double> truth = {-40, 0.15, 2e-5, -4e-8, 5e-11, -1e-14};
  std::vector<double> counts;
  for (int i = 0; i < 21; ++i) counts.push_back(51.0 * i + i % 2);
  for (int order = 1; order <= kHighestCalibrationOrder; ++order) {
    Calibration calibration;
    calibration.angle_unit = "rad";
    calibration.coefficients.assign(truth.begin(), truth.begin() + order + 1);
    std::vector<double> angles;
    for (const double count : counts) angles.push_back(calibration.Angle(count));
    const CalibrationFit fit = FitOf(TableOf("counts", "rad", counts, angles), order);
    for (int k = 0; k <= order; ++k) ExpectRelative(fit.calibration.coefficients[k], truth[k], 1e-8);
    EXPECT_FALSE(fit.higher_order);  // nothing is left to explain
  }
}

TEST(CalibrateSensor, GivesNoErrorsIfTheCurvePassesThroughEveryPoint) {
  const CalibrationFit fit = FitOf(TableOf("counts,angle_deg\n10,0\n20,20\n40,50\n"), 2);
  EXPECT_NEAR(fit.calibration.Angle(20) / fit.calibration.RadFromUnit(), 20, 1e-12);
  EXPECT_EQ(fit.calibration.covariance.size(), 0);
  EXPECT_FALSE(fit.calibration.residual_std_dev);
  EXPECT_EQ(fit.left_out.size(), 0);
  EXPECT_FALSE(fit.LeaveOneOutRms());
  EXPECT_FALSE(fit.rounding);
  EXPECT_FALSE(fit.higher_order);
  EXPECT_TRUE(fit.calibration.source["covariance"].is_null());
}

TEST(CalibrateSensor, DoesNotDependOnTheOrderOfRows) {
  const CalibrationFit fit = FitOf(TableOf(kReferenceTable), 2);
  const CalibrationFit other =
      FitOf(TableOf("angle_deg,counts\n45,475\n-45,19\n0,261\n-30,97\n30,396\n15,324\n-15,177\n"), 2);
  for (int k = 0; k < 3; ++k) {
    ExpectRelative(other.calibration.coefficients[k], fit.calibration.coefficients[k], 1e-11);
  }
  EXPECT_EQ(other.largest, 2);
}

TEST(CalibrateSensor, WritesJsonThatParseCalibrationReads) {
  for (const int order : {1, 2, 5}) {
    const auto fit = CalibrateSensor(TableOf(kReferenceTable), order, SensorRange{0, 1023});
    ASSERT_TRUE(fit) << fit.error().message();
    const auto read = ParseCalibration(fit->calibration.source.dump(2), "cal.json");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->input, "counts");
    EXPECT_EQ(read->angle_unit, "deg");
    EXPECT_EQ(read->coefficients, fit->calibration.coefficients);
    EXPECT_EQ(read->covariance, fit->calibration.covariance);
    EXPECT_EQ(read->residual_std_dev, fit->calibration.residual_std_dev);
    ASSERT_TRUE(read->input_range);
    EXPECT_EQ(read->input_range->high, 1023);
  }
}

TEST(CalibrateSensor, RequiresAsManyPointsAsCoefficients) {
  EXPECT_EQ(
      FaultOf(TableOf("counts,angle_deg\n10,0\n20,30\n"), 2),
      "table.csv:3: points found: 2; a curve of order 2 has 3 coefficients and needs as many points: measure more "
      "angles, or lower the order");
}

TEST(CalibrateSensor, AcceptsOrders1To5) {
  for (const int order : {0, 6, -1}) {
    EXPECT_EQ(FaultOf(TableOf(kReferenceTable), order, StatusCode::kInvalidArgument),
              "the order of a calibration is " + std::to_string(order) + "; it must be 1 to 5");
  }
}

TEST(CalibrateSensor, RefusesAReadingOutsideTheSensorsRange) {
  EXPECT_EQ(
      FaultOf(TableOf(kReferenceTable), 1, StatusCode::kInvalidArgument, SensorRange{0, 400}),
      "table.csv:8: the reading 475 counts is outside the sensor's range, 0 to 400; correct the range or the row");
}

TEST(CalibrateSensor, RefusesACurveThatTurnsBetweenThePoints) {
  // Flat, then steep: the fitted parabola has its vertex at 17/14 = 1.21.
  const CalibrationTable table = TableOf("volts,angle_deg\n0,0\n1,0\n2,0\n3,10\n4,30\n");
  EXPECT_THAT(FaultOf(table, 2), StartsWith("table.csv:6: the curve of order 2 turns at about 0 volts, between"));
  EXPECT_TRUE(CalibrateSensor(table, 1));
}

TEST(CalibrateSensor, GivesAValidCalibrationOrAnErrorForExtremeNumbers) {
  for (const std::string row : {"1e308,50\n-1e308,-50\n", "1e200,50\n", "1e-300,50\n", "5,1e300\n"}) {
    const std::string text = "volts,angle_deg\n0,0\n" + row + (row.starts_with("1e-3") ? "2e-300,60\n" : "");
    const auto fit = CalibrateSensor(TableOf(text), 1);
    if (fit) {
      EXPECT_TRUE(ParseCalibration(fit->calibration.source.dump(), "cal.json")) << text;
    } else {
      EXPECT_EQ(fit.error().code, StatusCode::kDataLoss) << text;
    }
  }
  const std::string spread = "volts,angle_deg\n0,0\n1,1\n2,2\n1e20,3\n";
  EXPECT_THAT(FaultOf(TableOf(spread), 2), HasSubstr("too unevenly spread for a curve of order 2"));
  // Readings between 1e6 and 1e6 + 4: their fifth powers differ in the 5th digit and are accurate only to 1e30 · 2⁻⁵³.
  const std::string alike = "volts,angle_deg\n1000000,0\n1000001,1\n1000002,2.1\n1000003,3\n1000004,4.2\n1000005,5\n";
  EXPECT_THAT(FaultOf(TableOf(alike), 5), HasSubstr("too large, too small or too similar for a curve of order 5"));
}

TEST(FindTurningReading, FindsTheVertexOfAParabola) {
  Calibration parabola;
  parabola.angle_unit = "rad";
  parabola.coefficients = {0, -2, 1};  // falls to 1, then rises
  EXPECT_FALSE(FindTurningReading(parabola, 1.5, 4));
  EXPECT_FALSE(FindTurningReading(parabola, -4, 0.5));
  EXPECT_NEAR(FindTurningReading(parabola, -4, 2).value(), 1, 0.006);  // within a step of the grid
}

}  // namespace
}  // namespace pendulum::calibrate_test
