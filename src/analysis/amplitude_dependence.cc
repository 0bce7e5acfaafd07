// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/amplitude_dependence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

#include "pendulum/analysis/part_fit.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// The trend of that parameter within a recording; nullptr: none.
const AmplitudeTrend* TrendWithin(const RunAlone& run, const std::string& name) {
  if (run.constancy == nullptr) return nullptr;
  const auto trend = std::ranges::find(run.constancy->trends, name, &AmplitudeTrend::name);
  const bool is_there = trend != run.constancy->trends.end() && trend->slope_std_error > 0;
  return is_there ? &*trend : nullptr;
}

/// Mean of amplitude² over the windows, weighted by what they tell of the parameter: there slope and value are apart.
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

/// Numbers that a line a + slope x, x = amplitude², is to explain, each divided by its error.
struct Line {
  std::vector<double> value, constant, slope;
  std::size_t estimates = 0;  // of whole recordings; they come first

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

/// About a reference amplitude² and value, so that no digits are lost.
Line LineOf(const std::vector<RunAlone>& runs, const SharedParameter& parameter, const std::vector<double>& squares,
            double reference) {
  Line line;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const RunEstimate& run = parameter.runs[k];
    if (run.value && std::isfinite(squares[k]))
      line.Add(*run.value - parameter.mean, 1, squares[k] - reference, *run.std_error);
  }
  line.estimates = line.value.size();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const AmplitudeTrend* const trend = TrendWithin(runs[k], parameter.name);
    if (trend != nullptr && parameter.runs[k].value) line.Add(trend->slope, 0, 1, trend->slope_std_error);
  }
  return line;
}

}  // namespace

double MeanAmplitude(const Recording& used, const FitReport& fit, const FitOptions& options) {
  constexpr int kPlaces = 60;
  if (fit.termination == Termination::kFailed) return std::numeric_limits<double>::quiet_NaN();
  const Parts parts(used, fit, options);
  const ParameterEstimate* const release = fit.Find(kReleaseTime.name);
  const double from = release == nullptr ? used.time[0] : release->estimate;
  const double to = used.time[used.size() - 1];
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) sum += std::pow(parts.Amplitude(from + (to - from) * (i + 0.5) / kPlaces), 2);
  return std::sqrt(sum / kPlaces);
}

/// By least squares of numbers with independent errors. What is left tells by how much the errors are too small, if
/// they are: the F test of the slope is against that, or against the errors themselves where less is left.
std::optional<AmplitudeDependence> TestAmplitudeDependence(const std::vector<RunAlone>& runs,
                                                           const SharedParameter& parameter,
                                                           const std::vector<double>& amplitudes) {
  std::vector<double> squares;
  double lowest = kUnbounded, highest = 0, sum = 0, count = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const bool windows = TrendWithin(runs[k], parameter.name) != nullptr;
    squares.push_back(windows ? MeanSquare(runs[k], parameter.name) : amplitudes[k] * amplitudes[k]);
    if (!parameter.runs[k].value || !std::isfinite(squares.back())) continue;
    lowest = std::min(lowest, squares.back());
    highest = std::max(highest, squares.back());
    sum += squares.back();
    ++count;
  }
  const Line line = LineOf(runs, parameter, squares, sum / count);
  const auto numbers = static_cast<Index>(line.value.size());
  if (numbers < 3 || !(highest > lowest)) return std::nullopt;
  const MatrixX2d columns = line.Columns();
  const VectorXd values = line.Values();
  const Eigen::Matrix2d inverse = (columns.transpose() * columns).inverse();
  const Vector2d fit = inverse * (columns.transpose() * values);
  const VectorXd left = values - columns * fit;
  const VectorXd constant = columns.col(0);
  const double without = (values - constant * (constant.dot(values) / constant.squaredNorm())).squaredNorm();
  const auto freedom = static_cast<double>(numbers - 2);
  const double excess = std::max(left.squaredNorm() / freedom, 1.0);
  if (!fit.allFinite()) return std::nullopt;
  AmplitudeDependence dependence{parameter.name, parameter.unit};
  dependence.slope = fit[1];
  dependence.slope_std_error = std::sqrt(inverse(1, 1) * excess);
  const double f = std::max(without - left.squaredNorm(), 0.0) / excess;
  dependence.p = boost::math::cdf(boost::math::complement(boost::math::fisher_f(1, freedom), f));
  dependence.span = fit[1] * (highest - lowest) / parameter.mean;
  const auto estimates = static_cast<Index>(line.estimates);
  const double between = left.head(estimates).squaredNorm();
  const double between_freedom = std::max(static_cast<double>(estimates) - (numbers > estimates ? 1.0 : 2.0), 1.0);
  dependence.rest_p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(between_freedom), between));
  return dependence;
}

}  // namespace pendulum
