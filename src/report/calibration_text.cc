// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/calibration_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Row = std::vector<std::string>;

constexpr int kFewDigits = 3;           // significant digits of a number that is only compared
constexpr double kSignificance = 0.05;  // significance level of the tests

std::string Short(double value) { return NumberText(value, kFewDigits); }

std::string Span(double one, double other, const std::string& unit) {
  return NumberText(std::min(one, other), kTextDigits) + " to " + NumberText(std::max(one, other), kTextDigits) + " " +
         unit;
}

std::string Power(int exponent, const std::string& base) {
  return exponent == 0 ? "" : exponent == 1 ? base : base + "^" + std::to_string(exponent);
}

/// The polynomial with its numbers: -49.6077 + 0.198544 x
std::string Polynomial(const std::vector<double>& coefficients) {
  std::string text;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const double value = coefficients[k];
    text += k == 0 ? (value < 0 ? "-" : "") : value < 0 ? " - " : " + ";
    text += NumberText(std::abs(value), kTextDigits) + (k == 0 ? "" : " " + Power(static_cast<int>(k), "x"));
  }
  return text;
}

std::string DataText(const CalibrationTable& table, const CalibrationFit& fit) {
  const Calibration& calibration = fit.calibration;
  std::vector<Row> rows = {
      {"table", table.path},
      {"points", std::to_string(table.size()) + ", " +
                     Span(table.reading.minCoeff(), table.reading.maxCoeff(), table.input) + ", " +
                     Span(table.angle.minCoeff(), table.angle.maxCoeff(), table.angle_unit)},
      {"curve", "angle = " + Polynomial(calibration.coefficients) + " " + table.angle_unit + ", x in " + table.input}};
  if (calibration.input_range) {
    rows.push_back({"sensor's range", Span(calibration.input_range->low, calibration.input_range->high, table.input)});
  }
  return Heading("Calibration") + AlignedTable({{""}, {""}}, rows, kTextIndent);
}

std::string CoefficientsText(const CalibrationTable& table, const CalibrationFit& fit) {
  std::vector<Row> rows;
  for (const auto& [name, text, unit] : CoefficientTexts(table, fit)) {
    rows.push_back({name, text.value, text.error.empty() ? "" : "± " + text.error, unit});
  }
  return "[[Coefficients]]\n" +
         AlignedTable({{"name"}, {"value", true}, {"± std error", false, 1}, {"unit"}}, rows, kTextIndent);
}

std::string CorrelationText(const CalibrationFit& fit) {
  const Eigen::MatrixXd& covariance = fit.calibration.covariance;
  std::string text;
  for (Index i = 0; i < covariance.rows(); ++i) {
    for (Index j = i + 1; j < covariance.rows(); ++j) {
      const double scale = std::sqrt(covariance(i, i)) * std::sqrt(covariance(j, j));
      if (!(scale > 0)) continue;
      text += (text.empty() ? "" : ", ") + ("c" + std::to_string(i)) + " c" + std::to_string(j) + " " +
              FixedText(covariance(i, j) / scale, 3);
    }
  }
  return text.empty() ? "" : Prose("Correlations: " + text + ".");
}

// --- points ---------------------------------------------------------------------------------------------------------

/// All points in the order of the table; of more than kShownPoints, those with the largest residuals, the largest
/// first.
std::vector<Index> ShownPoints(const CalibrationFit& fit) {
  std::vector<Index> points(fit.residual.size());
  std::iota(points.begin(), points.end(), Index{0});
  if (points.size() <= kShownPoints) return points;
  std::ranges::stable_sort(points, std::greater(), [&](Index i) { return std::abs(fit.residual[i]); });
  points.resize(kShownPoints);
  return points;
}

/// Decimals that show three digits of the largest residual. A residual below a millionth of the largest angle is only a
/// numerical error, so the decimals do not follow it.
int Decimals(const CalibrationTable& table, const CalibrationFit& fit) {
  constexpr double kNothing = 1e-6;
  const double scale = std::max(std::abs(fit.residual[fit.largest]), kNothing * table.angle.cwiseAbs().maxCoeff());
  return std::max(0, kFewDigits - 1 - static_cast<int>(std::floor(std::log10(scale))));
}

std::string PointsText(const CalibrationTable& table, const CalibrationFit& fit) {
  const Rounding rounding{Decimals(table, fit), 0};
  const bool has_left_out = fit.left_out.size() > 0;
  std::vector<Row> rows;
  for (const Index i : ShownPoints(fit)) {
    rows.push_back({NumberText(table.reading[i]), NumberText(table.angle[i]),
                    RoundedText(table.angle[i] - fit.residual[i], rounding), RoundedText(fit.residual[i], rounding),
                    has_left_out ? RoundedText(fit.left_out[i], rounding) : "",
                    has_left_out && i == fit.largest ? "largest" : ""});
  }
  const std::string unit = " [" + table.angle_unit + "]";
  const bool all = static_cast<Index>(rows.size()) == table.size();
  return "[[Points]]" + (all ? "" : " (the " + std::to_string(kShownPoints) + " with the largest residuals)") + "\n" +
         AlignedTable({{table.input, true},
                       {"angle" + unit, true},
                       {"curve" + unit, true},
                       {"residual" + unit, true},
                       {has_left_out ? "left out" + unit : "", true},
                       {""}},
                      rows, kTextIndent);
}

// --- in words -------------------------------------------------------------------------------------------------------

std::string CurveName(int order) {
  return order == 1 ? "a straight line" : "a curve of order " + std::to_string(order);
}

std::string ErrorsText(const CalibrationTable& table, const CalibrationFit& fit) {
  const std::optional<double> left_out = fit.LeaveOneOutRms();
  if (!left_out) {
    return Prose(
        "The curve has as many coefficients as the table has points and passes through each, so there are no residuals "
        "and no standard errors. Measure more angles.");
  }
  const std::string& unit = table.angle_unit;
  return Prose("Residual standard deviation " + Short(*fit.calibration.residual_std_dev) + " " + unit + " (" +
               std::to_string(table.size()) + " points less " + std::to_string(fit.order + 1) +
               " coefficients); leave-one-out error " + Short(*left_out) + " " + unit +
               " rms: the distance from the curve to a point that was not fitted (\"left out\" above).");
}

/// From 5 on "an order of magnitude above", from 50 on two orders, and so on.
std::string MagnitudeText(double ratio) {
  const int orders = static_cast<int>(std::floor(std::log10(2 * ratio)));
  if (orders <= 0) return "above";
  return (orders == 1 ? "an order" : std::to_string(orders) + " orders") + " of magnitude above";
}

/// Says whether rounding to counts explains the residuals.
std::string LackOfFitText(const CalibrationTable& table, const CalibrationFit& fit) {
  if (fit.resolution == 0) return "";
  const std::string& unit = table.angle_unit;
  const double largest = std::abs(fit.residual[fit.largest]);
  const double ratio = largest / fit.resolution;
  const std::string count = "The resolution is " + NumberText(fit.resolution, 4) + " " + unit + ", one count";
  if (!fit.rounding) return Prose(count + ".");
  const std::string rounding =
      "Rounding to counts would leave a standard deviation of " + Short(fit.rounding->std_dev) + " " + unit;
  const std::string test = " (χ², p " + ProbabilityText(fit.rounding->p) + ")";
  if (fit.rounding->p >= kSignificance) {
    return Prose(count + ". " + rounding + "; the residuals are no larger than that" + test +
                 ": the table shows no lack of fit.");
  }
  return Prose(count + "; the residuals, up to " + Short(largest) + " " + unit + " at " +
               NumberText(table.reading[fit.largest]) + " " + table.input + " (line " +
               std::to_string(table.line[fit.largest]) + "), are " +
               (ratio >= 2 ? MagnitudeText(ratio) + " it (" + NumberText(ratio, 2) + " counts)"
                           : "of its size (" + NumberText(ratio, 2) + " counts)") +
               ". " + rounding + ", but the residuals' standard deviation is " +
               Short(*fit.calibration.residual_std_dev) + " " + unit + test +
               ": lack of fit. The sensor deviates from the curve, or the angles were set less accurately than the "
               "sensor resolves them.");
}

std::string FText(const OrderTest& test) {
  const std::string f = std::isfinite(test.f) ? NumberText(test.f, kFewDigits) : "infinite";
  return " (F(1, " + std::to_string(test.freedom) + ") " + f + ", p " + ProbabilityText(test.p) + ")";
}

std::string OrdersText(const CalibrationFit& fit) {
  std::string text;
  if (fit.lower_order && fit.lower_order->p >= kSignificance) {
    text += "This curve is not significantly better than " + CurveName(fit.order - 1) + FText(*fit.lower_order) +
            ", which --order " + std::to_string(fit.order - 1) + " gives. ";
  } else if (fit.lower_order) {
    text += "This curve is significantly better than " + CurveName(fit.order - 1) + FText(*fit.lower_order) + ". ";
  }
  if (fit.higher_order) {
    const bool better = fit.higher_order->p < kSignificance;
    const std::string curve = "A" + CurveName(fit.order + 1).substr(1);
    text += curve + (better ? " is significantly better" : " is not significantly better") + FText(*fit.higher_order) +
            (better ? ": see --order " + std::to_string(fit.order + 1) : "") + ".";
  }
  return text.empty() ? "" : Prose(text);
}

/// Warns about readings outside the table, where a curve may even change its direction.
std::string OutsideText(const CalibrationTable& table, const CalibrationFit& fit) {
  const double low = table.reading.minCoeff(), high = table.reading.maxCoeff();
  std::string text = "Outside " + Span(low, high, table.input) + " the curve is extrapolated.";
  const std::optional<SensorRange>& range = fit.calibration.input_range;
  const auto turn = range ? FindTurningReading(fit.calibration, range->low, range->high) : std::nullopt;
  if (turn) {
    text += " In the sensor's range the curve turns at about " + NumberText(*turn, 4) + " " + table.input +
            ": readings beyond it would give wrong angles.";
  }
  return Prose(text);
}

}  // namespace

std::vector<CoefficientText> CoefficientTexts(const CalibrationTable& table, const CalibrationFit& fit) {
  const Calibration& calibration = fit.calibration;
  const std::string reading_unit = table.input == "counts" ? "count" : "V";
  const bool has_errors = calibration.covariance.size() > 0;
  std::vector<CoefficientText> texts;
  for (int k = 0; k <= fit.order; ++k) {
    const double value = calibration.coefficients[k];
    ValueAndError text{NumberText(value, kTextDigits), ""};
    if (has_errors && calibration.covariance(k, k) > 0) text = PdgText(value, std::sqrt(calibration.covariance(k, k)));
    const std::string unit = table.angle_unit + (k == 0 ? "" : "/" + Power(k, reading_unit));
    texts.push_back({"c" + std::to_string(k), std::move(text), unit});
  }
  return texts;
}

std::string CalibrationText(const CalibrationTable& table, const CalibrationFit& fit, TextExtent extent) {
  if (extent == TextExtent::kSummary) {
    const bool has_errors = fit.LeaveOneOutRms().has_value();
    return DataText(table, fit) + CoefficientsText(table, fit) + "[[Fit]]\n" +
           (has_errors ? LackOfFitText(table, fit) : ErrorsText(table, fit)) + OrdersText(fit) +
           Prose("More: --details (points and residuals), --plot curve.svg, --json calibration.json.");
  }
  return DataText(table, fit) + CoefficientsText(table, fit) + CorrelationText(fit) + PointsText(table, fit) +
         "[[Fit]]\n" + ErrorsText(table, fit) + LackOfFitText(table, fit) + OrdersText(fit) + OutsideText(table, fit);
}

}  // namespace pendulum
