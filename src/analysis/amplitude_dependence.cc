// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/amplitude_dependence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "pendulum/analysis/part_fit.h"
#include "pendulum/base/distributions.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// The trend of parameter `name` within a recording; nullptr: none.
const AmplitudeTrend* TrendWithin(const RunAlone& run, const std::string& name) {
  if (run.constancy == nullptr) return nullptr;
  const auto trend = std::ranges::find(run.constancy->trends, name, &AmplitudeTrend::name);
  const bool is_there = trend != run.constancy->trends.end() && trend->slope_std_error > 0;
  return is_there ? &*trend : nullptr;
}

/// Mean of amplitude² over the windows. The weight of a window is its information about the parameter; with these
/// weights the errors of slope and value are uncorrelated.
double MeanSquare(const RunAlone& run, const std::string& name) {
  double sum = 0, weights = 0;
  for (const AmplitudeRow& row : run.constancy->windows) {
    const double error = name == kInertia.name ? row.inertia_std_error : row.friction_std_error;
    const double weight = 1 / (error * error);
    sum += weight * row.amplitude * row.amplitude;
    weights += weight;
  }
  return sum / weights;
}

/// The data of a line a + slope · x, x = amplitude²; each number is divided by its standard error.
struct Line {
  std::vector<double> value, constant, slope;
  std::size_t estimates = 0;  // number of estimates of whole recordings, which come first

  void Add(double y, double by_constant, double by_slope, double error) {
    value.push_back(y / error);
    constant.push_back(by_constant / error);
    slope.push_back(by_slope / error);
  }

  VectorXd Values() const { return Eigen::Map<const VectorXd>(value.data(), static_cast<Index>(value.size())); }

  MatrixX2d Columns() const {
    MatrixX2d columns(static_cast<Index>(value.size()), 2);
    columns.col(0) = Eigen::Map<const VectorXd>(constant.data(), columns.rows());
    columns.col(1) = Eigen::Map<const VectorXd>(slope.data(), columns.rows());
    return columns;
  }
};

/// amplitude² of each recording. Range and mean are over the recordings that determine the parameter.
struct Squares {
  std::vector<double> of_run;
  double lowest = kUnbounded, highest = 0, mean = 0;
};

Squares SquaresOf(const std::vector<RunAlone>& runs, const SharedParameter& parameter,
                  const std::vector<double>& amplitudes) {
  Squares squares;
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const bool windows = TrendWithin(runs[k], parameter.name) != nullptr;
    const double square = windows ? MeanSquare(runs[k], parameter.name) : amplitudes[k] * amplitudes[k];
    squares.of_run.push_back(square);
    if (!parameter.runs[k].value || !std::isfinite(square)) continue;
    squares.lowest = std::min(squares.lowest, square);
    squares.highest = std::max(squares.highest, square);
    sum += square;
    ++count;
  }
  squares.mean = sum / count;
  return squares;
}

/// Centers amplitude² and value at their means to avoid loss of digits.
Line LineOf(const std::vector<RunAlone>& runs, const SharedParameter& parameter, const Squares& squares) {
  Line line;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunEstimate& run = parameter.runs[k];
    if (run.value && std::isfinite(squares.of_run[k])) {
      line.Add(*run.value - parameter.mean, 1, squares.of_run[k] - squares.mean, *run.std_error);
    }
  }
  line.estimates = line.value.size();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const AmplitudeTrend* const trend = TrendWithin(runs[k], parameter.name);
    if (trend != nullptr && parameter.runs[k].value) line.Add(trend->slope, 0, 1, trend->slope_std_error);
  }
  return line;
}

/// Least-squares fits of a line and of a constant alone.
struct LineFit {
  double slope = 0, slope_variance = 0;
  VectorXd left;                    // residuals of the line
  double residual_of_constant = 0;  // sum of squared residuals of the constant
};

LineFit Solve(const Line& line) {
  const MatrixX2d columns = line.Columns();
  const VectorXd values = line.Values();
  const Eigen::Matrix2d inverse = (columns.transpose() * columns).inverse();
  const Vector2d fit = inverse * (columns.transpose() * values);
  const VectorXd constant = columns.col(0);
  const VectorXd residual_of_constant = values - constant * (constant.dot(values) / constant.squaredNorm());
  return {fit[1], inverse(1, 1), values - columns * fit, residual_of_constant.squaredNorm()};
}

}  // namespace

double MeanAmplitude(const Recording& used, const FitReport& fit, const FitOptions& options) {
  constexpr int kPlaces = 60;
  const auto is_angle = [](const ParameterEstimate& parameter) {
    return parameter.info.name == kReleaseAngle.name || parameter.info.name == kInitialAngle.name;
  };
  const auto start = std::ranges::find_if(fit.parameters, is_angle);
  const bool is_fitted = fit.termination != Termination::kFailed && start != fit.parameters.end();
  if (!is_fitted || start->unit != "rad") return std::numeric_limits<double>::quiet_NaN();
  const Parts parts(used, fit, options);
  const ParameterEstimate* const release = fit.Find(kReleaseTime.name);
  const double from = release == nullptr ? used.time[0] : release->estimate;
  const double to = used.time[used.size() - 1];
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) sum += std::pow(parts.Amplitude(from + (to - from) * (i + 0.5) / kPlaces), 2);
  return sum > 0 ? std::sqrt(sum / kPlaces) : std::numeric_limits<double>::quiet_NaN();
}

/// Least squares of estimates and slopes with independent errors. The residuals may show that the errors are too small.
/// The F test of the slope then uses the residual variance; if the residuals are smaller than the errors, it uses the
/// errors.
std::optional<AmplitudeDependence> TestAmplitudeDependence(const std::vector<RunAlone>& runs,
                                                           const SharedParameter& parameter,
                                                           const std::vector<double>& amplitudes) {
  const Squares squares = SquaresOf(runs, parameter, amplitudes);
  const Line line = LineOf(runs, parameter, squares);
  const std::size_t numbers = line.value.size();
  if (numbers < 3 || !(squares.highest > squares.lowest)) return std::nullopt;
  const LineFit fit = Solve(line);
  if (!fit.left.allFinite()) return std::nullopt;
  const auto freedom = static_cast<double>(numbers - 2);
  const double rest = fit.left.squaredNorm();
  const double excess = std::max(rest / freedom, 1.0);
  AmplitudeDependence dependence{parameter.name, parameter.unit};
  dependence.slope = fit.slope;
  dependence.slope_std_error = std::sqrt(fit.slope_variance * excess);
  const double f = std::max(fit.residual_of_constant - rest, 0.0) / excess;
  dependence.p = FisherTail(f, 1, freedom);
  dependence.span = fit.slope * (squares.highest - squares.lowest) / parameter.mean;
  const double between = fit.left.head(static_cast<Index>(line.estimates)).squaredNorm();
  const double between_freedom =
      std::max(static_cast<double>(line.estimates) - (numbers > line.estimates ? 1 : 2), 1.0);
  dependence.rest_p = ChiSquareTail(between, between_freedom);
  return dependence;
}

}  // namespace pendulum
