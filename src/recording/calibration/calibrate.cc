// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/QR>

#include "pendulum/base/distributions.h"
#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

using Check = Result<void>;
using Eigen::Index;

/// Scales the readings to -1 to 1: z = (reading - center) / half_span.
struct Scale {
  double center;
  double half_span;
};

Scale ScaleOf(const Eigen::VectorXd& reading) {
  const double low = reading.minCoeff(), high = reading.maxCoeff();
  return {low / 2 + high / 2, high / 2 - low / 2};
}

/// N x K, the powers 0 to K - 1 of z.
Eigen::MatrixXd Powers(const Eigen::VectorXd& reading, const Scale& scale, Index count) {
  const Eigen::VectorXd z = (reading.array() - scale.center) / scale.half_span;
  Eigen::MatrixXd powers(z.size(), count);
  powers.col(0).setOnes();
  for (Index k = 1; k < count; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(z);
  return powers;
}

/// K x K matrix that converts coefficients of powers of z to coefficients of powers of the reading, by expanding
/// (x - center)ʲ / half_spanʲ.
Eigen::MatrixXd RawFromScaled(const Scale& scale, Index count) {
  Eigen::MatrixXd raw = Eigen::MatrixXd::Zero(count, count);
  raw(0, 0) = 1;
  for (Index j = 1; j < count; ++j) {
    raw.col(j).tail(count - 1) = raw.col(j - 1).head(count - 1) / scale.half_span;
    raw.col(j) -= raw.col(j - 1) * (scale.center / scale.half_span);
  }
  return raw;
}

/// Least squares on z.
struct LeastSquares {
  bool is_determined = false;   // False: the points do not determine all coefficients, and nothing below is set.
  Eigen::VectorXd coefficient;  // K x 1.
  Eigen::MatrixXd factor;       // K x K, (ZᵀZ)⁻¹ = factor factorᵀ.
  Eigen::VectorXd residual;     // N x 1.
  Eigen::VectorXd leverage;     // N x 1, the diagonal of Z (ZᵀZ)⁻¹ Zᵀ.

  double Rss() const { return residual.squaredNorm(); }
};

LeastSquares Solve(const CalibrationTable& table, const Scale& scale, int order) {
  const Index count = order + 1;
  LeastSquares fit;
  if (table.size() < count) return fit;
  const Eigen::MatrixXd powers = Powers(table.reading, scale, count);
  if (!powers.allFinite()) return fit;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(powers);
  if (qr.rank() < count) return fit;
  fit.is_determined = true;
  fit.coefficient = qr.solve(table.angle);
  const Eigen::MatrixXd upper = qr.matrixR().topLeftCorner(count, count).triangularView<Eigen::Upper>();
  fit.factor =
      qr.colsPermutation() * upper.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(count, count)).eval();
  fit.residual = table.angle - powers * fit.coefficient;
  const Eigen::MatrixXd orthonormal = qr.householderQ() * Eigen::MatrixXd::Identity(table.size(), count);
  fit.leverage = orthonormal.rowwise().squaredNorm();
  return fit;
}

/// A smaller sum of squared residuals comes from rounding in the computation: the curve passes through every point.
double SmallestRss(const CalibrationTable& table) {
  constexpr double kRounding = 1e-13;
  const double rounding = kRounding * table.angle.cwiseAbs().maxCoeff();
  return static_cast<double>(table.size()) * rounding * rounding;
}

/// `order` is the order of the longer curve. std::nullopt: there are too few points, or the shorter curve already
/// passes through every point.
std::optional<OrderTest> TestOrder(const CalibrationTable& table, const LeastSquares& shorter,
                                   const LeastSquares& longer, int order) {
  const int freedom = static_cast<int>(table.size()) - order - 1;
  const double smallest = SmallestRss(table);
  if (freedom < 1 || !shorter.is_determined || !longer.is_determined || shorter.Rss() <= smallest) return std::nullopt;
  if (longer.Rss() <= smallest) return OrderTest{order, std::numeric_limits<double>::infinity(), freedom, 0};
  const double f = std::max(0.0, shorter.Rss() - longer.Rss()) / (longer.Rss() / freedom);
  return OrderTest{order, f, freedom, FisherTail(f, 1, freedom)};
}

std::optional<RoundingTest> TestRounding(double resolution, double rss, Index freedom) {
  if (resolution == 0 || freedom < 1) return std::nullopt;
  const double std_dev = resolution / std::sqrt(12.0);
  const double chi_squared = std::min(rss / (std_dev * std_dev), std::numeric_limits<double>::max());
  return RoundingTest{std_dev, ChiSquareTail(chi_squared, static_cast<double>(freedom))};
}

double RmsSlope(const CalibrationTable& table, const Calibration& calibration) {
  const auto slope = [&](double reading) { return calibration.Slope(reading) / calibration.RadFromUnit(); };
  return std::sqrt(table.reading.unaryExpr(slope).squaredNorm() / static_cast<double>(table.size()));
}

/// The angle of one count, rms over the points; 0 for volts.
double Resolution(const CalibrationTable& table, const Calibration& calibration) {
  return table.input == "counts" ? RmsSlope(table, calibration) : 0;
}

/// Sets the curve. The covariance assumes at least the error of rounding to counts, even if the points lie on the curve
/// by chance.
void SetCurve(const CalibrationTable& table, const LeastSquares& least_squares, const Scale& scale,
              Calibration& calibration) {
  calibration.input = table.input;
  calibration.angle_unit = table.angle_unit;
  const Index count = least_squares.coefficient.size();
  const Eigen::MatrixXd raw_from_scaled = RawFromScaled(scale, count);
  const Eigen::VectorXd raw = raw_from_scaled * least_squares.coefficient;
  calibration.coefficients.assign(raw.begin(), raw.end());
  if (table.size() == count) return;
  const double variance = least_squares.Rss() / static_cast<double>(table.size() - count);
  const double rounding = Resolution(table, calibration) / std::sqrt(12.0);
  const double std_dev = std::max(std::sqrt(variance), rounding);
  const Eigen::MatrixXd factor = std_dev * (raw_from_scaled * least_squares.factor);
  calibration.covariance.noalias() = factor * factor.transpose();
  calibration.covariance = calibration.covariance.selfadjointView<Eigen::Lower>().toDenseMatrix();
  calibration.residual_std_dev = std::sqrt(variance);
}

/// The curve and its residuals, without tests.
CalibrationFit FitOf(const CalibrationTable& table, const LeastSquares& least_squares, const Scale& scale) {
  CalibrationFit fit;
  const Index count = least_squares.coefficient.size();
  fit.order = static_cast<int>(count) - 1;
  SetCurve(table, least_squares, scale, fit.calibration);
  fit.residual = least_squares.residual;
  fit.residual.cwiseAbs().maxCoeff(&fit.largest);
  if (table.size() > count) fit.left_out = fit.residual.array() / (1 - least_squares.leverage.array());
  fit.resolution = Resolution(table, fit.calibration);
  return fit;
}

// ---- Tables that cannot be calibrated ----------------------------------------------------------------------------

tl::unexpected<Status> FaultAtEnd(const CalibrationTable& table, const std::string& sentence) {
  return Fault(table.Place(table.size() - 1), sentence);
}

Check CheckCounts(const CalibrationTable& table, int order) {
  if (order < 1 || order > kHighestCalibrationOrder) {
    return Error(StatusCode::kInvalidArgument, "the order of a calibration is " + std::to_string(order) +
                                                   "; it must be 1 to " + std::to_string(kHighestCalibrationOrder));
  }
  if (table.size() > order) return {};
  return FaultAtEnd(table, "points found: " + std::to_string(table.size()) + "; a curve of order " +
                               std::to_string(order) + " has " + std::to_string(order + 1) +
                               " coefficients and needs as many points: measure more angles, or lower the order");
}

Check CheckInputRange(const CalibrationTable& table, const std::optional<SensorRange>& range) {
  for (Index i = 0; range && i < table.size(); ++i) {
    if (table.reading[i] >= range->low && table.reading[i] <= range->high) continue;
    return ErrorAt(StatusCode::kInvalidArgument, table.Place(i),
                   "the reading " + NumberText(table.reading[i]) + " " + table.input +
                       " is outside the sensor's range, " + NumberText(range->low) + " to " + NumberText(range->high) +
                       "; correct the range or the row");
  }
  return {};
}

/// Checks that the stored polynomial in powers of the reading reproduces the residuals. With large readings its terms
/// cancel so strongly that no accuracy remains.
Check CheckNumbers(const CalibrationTable& table, const CalibrationFit& fit) {
  constexpr double kAlike = 1e-9;
  const Calibration& calibration = fit.calibration;
  const double span = table.angle.maxCoeff() - table.angle.minCoeff();
  const auto curve = [&](double reading) { return calibration.Angle(reading) / calibration.RadFromUnit(); };
  const Eigen::VectorXd again = table.angle - table.reading.unaryExpr(curve);
  const bool is_finite = std::isfinite(span) && fit.left_out.allFinite() && calibration.covariance.allFinite() &&
                         (again - fit.residual).allFinite() && std::isfinite(fit.resolution);
  if (is_finite && (again - fit.residual).cwiseAbs().maxCoeff() <= kAlike * span) return {};
  return FaultAtEnd(table, "the numbers of this table are too large, too small or too similar for a curve of order " +
                               std::to_string(fit.order) + " in powers of the reading; check them, or lower the order");
}

Check CheckCurveIsMonotonic(const CalibrationTable& table, const CalibrationFit& fit) {
  const double low = table.reading.minCoeff(), high = table.reading.maxCoeff();
  const std::optional<double> turn = FindTurningReading(fit.calibration, low, high);
  if (!turn) return {};
  return FaultAtEnd(table, "the curve of order " + std::to_string(fit.order) + " turns at about " +
                               NumberText(*turn, 4) + " " + table.input +
                               ", between the points, so two readings would give the same angle; lower the order");
}

}  // namespace

std::optional<double> CalibrationFit::LeaveOneOutRms() const {
  if (left_out.size() == 0) return std::nullopt;
  return std::sqrt(left_out.squaredNorm() / static_cast<double>(left_out.size()));
}

std::optional<double> FindTurningReading(const Calibration& calibration, double low, double high) {
  constexpr int kSteps = 1000;
  const bool rises = calibration.Angle(high) > calibration.Angle(low);
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const double reading = (1 - share) * low + share * high;
    const double slope = calibration.Slope(reading);
    if (!(rises ? slope > 0 : slope < 0)) return reading;
  }
  return std::nullopt;
}

nlohmann::ordered_json CalibrationJson(const Calibration& calibration) {
  nlohmann::ordered_json json = {{"schema_version", 1},
                                 {"input", calibration.input},
                                 {"angle_unit", calibration.angle_unit},
                                 {"coefficients", calibration.coefficients},
                                 {"covariance", nullptr},
                                 {"residual_std_dev", nullptr},
                                 {"input_range", nullptr}};
  for (const auto& row : calibration.covariance.rowwise()) {
    json["covariance"].push_back(std::vector<double>(row.begin(), row.end()));
  }
  if (calibration.residual_std_dev) json["residual_std_dev"] = *calibration.residual_std_dev;
  if (calibration.input_range) json["input_range"] = {calibration.input_range->low, calibration.input_range->high};
  return json;
}

Result<CalibrationFit> CalibrateSensor(const CalibrationTable& table, int order,
                                       const std::optional<SensorRange>& input_range) {
  RETURN_IF_ERROR(CheckCounts(table, order));
  RETURN_IF_ERROR(CheckInputRange(table, input_range));
  const Scale scale = ScaleOf(table.reading);
  const LeastSquares best = Solve(table, scale, order);
  if (!best.is_determined) {
    return FaultAtEnd(table, "the readings of this table are too unevenly spread for a curve of order " +
                                 std::to_string(order) + "; check them, or lower the order");
  }
  CalibrationFit fit = FitOf(table, best, scale);
  for (const auto check : {CheckNumbers, CheckCurveIsMonotonic}) {
    RETURN_IF_ERROR(check(table, fit));
  }
  fit.rounding = TestRounding(fit.resolution, best.Rss(), table.size() - order - 1);
  if (order > 1) fit.lower_order = TestOrder(table, Solve(table, scale, order - 1), best, order);
  if (order < kHighestCalibrationOrder) {
    fit.higher_order = TestOrder(table, best, Solve(table, scale, order + 1), order + 1);
  }
  fit.calibration.input_range = input_range;
  fit.calibration.source = CalibrationJson(fit.calibration);
  return fit;
}

}  // namespace pendulum
