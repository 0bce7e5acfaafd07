// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/calibration_text.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/calibration_examples.h"

namespace pendulum::calibration_text_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// The text with line breaks and indents replaced by single blanks.
std::string Unwrapped(const std::string& text) {
  std::string words;
  for (const char c : text) {
    const char plain = c == '\n' ? ' ' : c;
    if (plain != ' ' || !words.ends_with(' ')) words += plain;
  }
  return words;
}

std::string TextOf(const CalibrationTable& table, int order, const std::optional<SensorRange>& range = std::nullopt) {
  const auto fit = CalibrateSensor(table, order, range);
  EXPECT_TRUE(fit) << fit.error().message();
  return fit ? CalibrationText(table, *fit) : "";
}

TEST(CalibrationText, ShowsTheReferenceTableAsPublished) {
  EXPECT_EQ(TextOf(TableOf(kReferenceTable), 1),
            R"([[Calibration]]
    table   table.csv
    points  7, 19 to 475 counts, -45 to 45 deg
    curve   angle = -49.6077 + 0.198544 x deg, x in counts
[[Coefficients]]
    name   value ± std error  unit
    c0     -49.6 ± 0.9        deg
    c1    0.1985 ± 0.0030     deg/count
    Correlations: c0 c1 -0.856.
[[Points]]
    counts  angle [deg]  curve [deg]  residual [deg]  left out [deg]
        19          -45       -45.84            0.84            1.60
        97          -30       -30.35            0.35            0.49
       177          -15       -14.47           -0.53           -0.65
       261            0         2.21           -2.21           -2.58  largest
       324           15        14.72            0.28            0.34
       396           30        29.02            0.98            1.36
       475           45        44.70            0.30            0.55
[[Fit]]
    Residual standard deviation 1.19 deg (7 points less 2 coefficients);
    leave-one-out error 1.32 deg rms: the distance from the curve to a point
    that was not fitted ("left out" above).
    The resolution is 0.1985 deg, one count; the residuals, up to 2.21 deg at
    261 counts (line 5), are an order of magnitude above it (11 counts).
    Rounding to counts would leave a standard deviation of 0.0573 deg, but the
    residuals' standard deviation is 1.19 deg (χ², p < 1e-99): lack of fit. The
    sensor deviates from the curve, or the angles were set less accurately than
    the sensor resolves them.
    A curve of order 2 is not significantly better (F(1, 4) 2.44, p 0.19).
    Outside 19 to 475 counts the curve is extrapolated.
)");
}

TEST(CalibrationText, NamesTheUnitsOfHigherOrdersAndComparesTheOrders) {
  EXPECT_THAT(Unwrapped(TextOf(TableOf(kReferenceTable), 2)),
              AllOf(HasSubstr("angle = -48.4448 + 0.183327 x + 3.09639e-05 x^2 deg"), HasSubstr("deg/count^2"),
                    HasSubstr("c2 (3.1 ± 2.0)e-05"), HasSubstr("c0 c1 -0.832, c0 c2 0.696, c1 c2 -0.965."),
                    HasSubstr("This curve is not significantly better than a straight line (F(1, 4) 2.44, p 0.19), "
                              "which --order 1 gives. A curve of order 3 is not")));
}

TEST(CalibrationText, RecommendsTheOrderThatFitsBetter) {
  std::vector<double> volts, angles;
  for (int i = 0; i < 12; ++i) {
    volts.push_back(0.4 * i);
    angles.push_back(-1 + 0.3 * volts.back() + 0.02 * volts.back() * volts.back() + (i % 3 - 1) * 1e-3);
  }
  const CalibrationTable table = TableOf("volts", "rad", volts, angles);
  const std::string line = Unwrapped(TextOf(table, 1));
  EXPECT_THAT(line, AllOf(HasSubstr("A curve of order 2 is significantly better (F(1, 9) "),
                          HasSubstr("e-16): see --order 2."), HasSubstr("rad/V"),
                          Not(HasSubstr("resolution"))));  // volts have no resolution
  EXPECT_THAT(
      Unwrapped(TextOf(table, 2)),
      AllOf(HasSubstr("This curve is significantly better than a straight line (F(1, 9) "), HasSubstr("rad/V^2")));
}

TEST(CalibrationText, FindsNoLackOfFitInRoundedCounts) {
  std::vector<double> counts, angles;
  for (int i = 0; i < 60; ++i) {
    angles.push_back(-50 + 1.7 * i);
    counts.push_back(std::round((angles.back() + 60) / 0.25));
  }
  const std::string text = Unwrapped(TextOf(TableOf("counts", "deg", counts, angles), 1));
  EXPECT_THAT(text, AllOf(HasSubstr("the residuals are no larger than that (χ², p "),
                          HasSubstr("the table shows no lack of fit."), Not(HasSubstr("magnitude"))));
  EXPECT_THAT(text, HasSubstr("[[Points]] (the 50 with the largest residuals)"));
}

TEST(CalibrationText, ListsAtMostFiftyPoints) {
  std::vector<double> counts, angles;
  for (int i = 0; i < 60; ++i) {
    counts.push_back(4 * i);
    angles.push_back(i + (i == 31 ? 0.5 : 0));
  }
  const std::string text = TextOf(TableOf("counts", "deg", counts, angles), 1);
  const std::string points = text.substr(text.find("[[Points]]"), text.find("[[Fit]]") - text.find("[[Points]]"));
  EXPECT_THAT(points, HasSubstr("residual [deg]  left out [deg]\n       124         31.5"));  // largest first
  EXPECT_EQ(std::ranges::count(points, '\n'), 2 + kShownPoints);
}

TEST(CalibrationText, ExplainsMissingErrors) {
  const std::string text = TextOf(TableOf("counts,angle_deg\n10,0\n20,20\n40,50\n"), 2);
  EXPECT_THAT(Unwrapped(text), HasSubstr("as many coefficients as the table has points and passes through each, so "
                                         "there are no residuals and no standard errors."));
  EXPECT_THAT(text, AllOf(Not(HasSubstr("±")), Not(HasSubstr("left out")), Not(HasSubstr("largest")),
                          Not(HasSubstr(" -0.000"))));
}

TEST(CalibrationText, ReportsWhereTheCurveTurnsInTheSensorsRange) {
  // 60 - (x - 60)² / 60 rises up to 60 counts, which is outside the table.
  const CalibrationTable table = TableOf("counts,angle_deg\n0,0\n10,18\n20,33\n30,45\n40,53\n");
  EXPECT_THAT(
      Unwrapped(TextOf(table, 2, SensorRange{0, 1023})),
      AllOf(HasSubstr("sensor's range 0 to 1023 counts"), HasSubstr("In the sensor's range the curve turns at about "),
            EndsWith(" counts: readings beyond it would give wrong angles. ")));
  EXPECT_THAT(TextOf(table, 2, SensorRange{0, 45}), Not(HasSubstr("turns")));
}

}  // namespace
}  // namespace pendulum::calibration_text_test
