// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/amplitude_trend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/analysis/linear_fit.h"
#include "pendulum/analysis/random_effects.h"
#include "pendulum/base/distributions.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kMaxWindows = 8;

/// The friction parameter with the smallest relative standard error; nullptr: no friction has a standard error.
const ParameterEstimate* BestFriction(const FitReport& fit) {
  const ParameterEstimate* best = nullptr;
  const auto relative = [](const ParameterEstimate& p) { return *p.std_error / std::abs(p.estimate); };
  for (std::size_t i = 1; i < PhysicalParameters(fit.model).size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    if (!parameter.std_error || parameter.estimate == 0 || !parameter.info.scales_with_gravity()) continue;
    if (best == nullptr || relative(parameter) < relative(*best)) best = &parameter;
  }
  return best;
}

/// Fits of W windows, and the noise estimated from all their residuals together.
struct Windows {
  std::vector<PartFit> parts;
  std::vector<LinearFit> linear;
  std::vector<Index> tested;  // T parameters that each window estimates separately
  NoiseModel noise;
  Autocorrelation autocorrelation;
  ReadingTerms terms;  // score and information of all used readings

  ReadingTerms TermsIn(const PartFit& part) const {
    return {terms.score.segment(part.first, part.part.size()), terms.information.segment(part.first, part.part.size())};
  }
};

/// The row of parameter k in a window's linear fit.
Index RowOf(const LinearFit& linear, Index k) { return std::ranges::find(linear.free, k) - linear.free.begin(); }

/// Derivative of a window's estimate of parameter k with respect to the parameters held at the whole fit's estimates.
VectorXd Response(const Windows& windows, std::size_t w, Index k, const std::vector<Index>& held, double elapsed) {
  const LinearFit& linear = windows.linear[w];
  MatrixXd columns = linear.jacobian(Eigen::all, held);
  for (std::size_t h = 0; h < held.size(); ++h) {
    // The drift before the window has already moved the zero.
    if (IsDrift(windows.parts[w].fit.parameters[static_cast<std::size_t>(held[h])].info.name))
      columns.col(static_cast<Index>(h)) += elapsed * linear.jacobian.col(held[h] - 1);
  }
  const VectorXd information = windows.TermsIn(windows.parts[w]).information;
  return -columns.transpose() * information.asDiagonal() * linear.influence.col(RowOf(linear, k));
}

/// The parameters that all windows hold at the whole fit's estimates, and the columns of these parameters in
/// `whole.influence`.
std::pair<std::vector<Index>, std::vector<Index>> HeldEstimates(const FitReport& fit, const LinearFit& whole,
                                                                const std::vector<Index>& tested) {
  std::pair<std::vector<Index>, std::vector<Index>> held;
  const auto start = static_cast<Index>(PhysicalParameters(fit.model).size());
  for (std::size_t i = 0; i < whole.free.size(); ++i) {
    const Index k = whole.free[i];
    if (k == start || k == start + 1 || std::ranges::find(tested, k) != tested.end()) continue;
    held.first.push_back(k);
    held.second.push_back(static_cast<Index>(i));
  }
  return held;
}

/// Influence of all readings on the windows' estimates of parameter k: N x W. A reading acts through its own window and
/// through the parameters held at the whole fit's estimates.
MatrixXd InfluenceOn(Index k, const Recording& used, const FitReport& fit, const LinearFit& whole,
                     const Windows& windows) {
  const auto [held, columns] = HeldEstimates(fit, whole, windows.tested);
  MatrixXd influence(used.size(), static_cast<Index>(windows.parts.size()));
  for (std::size_t w = 0; w < windows.parts.size(); ++w) {
    const PartFit& part = windows.parts[w];
    const double elapsed = used.clock_scale * (part.part.time[0] - used.time[0]);
    auto column = influence.col(static_cast<Index>(w));
    column = whole.influence(Eigen::all, columns) * Response(windows, w, k, held, elapsed);
    column.segment(part.first, part.part.size()) += windows.linear[w].influence.col(RowOf(windows.linear[w], k));
  }
  return influence;
}

/// Correction for the variance that the parameters of the windows took from the residuals.
double WindowInflation(const Recording& used, const Windows& windows) {
  double lost = 0;
  Index free = 0, samples = 0;
  for (std::size_t w = 0; w < windows.parts.size(); ++w) {
    const LinearFit& linear = windows.linear[w];
    const MatrixXd covariance =
        ScoreCovariance(windows.noise, windows.autocorrelation, windows.TermsIn(windows.parts[w]),
                        used.clock_scale * windows.parts[w].part.time, linear.influence);
    lost += linear.inverse.ldlt().solve(covariance).trace();
    free += linear.influence.cols();
    samples += windows.parts[w].part.size();
  }
  return Inflation(windows.noise, samples, free, lost);
}

/// The trend of the values with amplitude², by least squares with weights 1 / variance. Its standard error uses the
/// full covariance of the values.
AmplitudeTrend TrendOf(const ParameterEstimate& parameter, const VectorXd& value, const MatrixXd& covariance,
                       const VectorXd& square) {
  const VectorXd weight = covariance.diagonal().cwiseInverse();
  const double mean = weight.dot(square) / weight.sum();
  const VectorXd distance = square.array() - mean;
  const VectorXd by_value = weight.cwiseProduct(distance) / weight.dot(distance.cwiseAbs2());
  AmplitudeTrend trend;
  trend.name = parameter.info.name;
  trend.unit = parameter.unit;
  trend.slope = by_value.dot(value);
  trend.slope_std_error = std::sqrt(by_value.dot(covariance * by_value));
  trend.span = trend.slope * (square.maxCoeff() - square.minCoeff()) / parameter.estimate;
  trend.p = TwoSidedP(trend.slope / trend.slope_std_error);
  return trend;
}

/// Fits the windows. Returns the reason for a failure, otherwise an empty string.
std::string FitWindows(const Parts& parts, const std::vector<double>& ends, const FitReport& fit, Windows& windows) {
  std::vector<std::string_view> held;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (std::ranges::find(windows.tested, static_cast<Index>(i)) == windows.tested.end())
      held.push_back(fit.parameters[i].info.name);
  }
  const std::size_t count = std::min((ends.size() - 1) / kMinHalfSwings, kMaxWindows);
  const std::vector<std::size_t> cuts = CutEvenly(ends, count, parts);
  for (std::size_t w = 0; w < count; ++w) {
    const double from = w == 0 ? ends.front() : NextDoubleAfter(ends[cuts[w]]);
    PartFit part = parts.Fit(from, ends[cuts[w + 1]], held);
    if (!part.converged())
      return "the fit to window " + std::to_string(w + 1) + " of " + std::to_string(count) +
             " did not converge: " + part.reason;
    windows.parts.push_back(std::move(part));
  }
  return "";
}

/// Linearizes all windows with one common noise.
bool LinearizeWindows(const Recording& used, const FitReport& fit, const FitOptions& options, const Parts& parts,
                      Windows& windows) {
  windows.noise = parts.PooledNoise(windows.parts);
  VectorXd readings = fit.fitted;
  for (const PartFit& part : windows.parts) readings.segment(part.first, part.part.size()) = part.fit.fitted;
  windows.terms = TermsOf(windows.noise, used.value, readings);
  for (const PartFit& part : windows.parts) {
    std::optional<LinearFit> linear =
        LinearizeFit(part.part, part.fit, options.rig, windows.TermsIn(part), {}, false, options.stop);
    if (!linear) return false;
    windows.linear.push_back(*std::move(linear));
  }
  windows.autocorrelation = parts.PooledAutocorrelation(windows.noise, windows.parts, windows.linear);
  return true;
}

/// A window's row without estimates; the amplitude is the mean over the window.
AmplitudeRow RowOf(const PartFit& window, const Parts& parts) {
  constexpr int kPlaces = 13;
  AmplitudeRow row;
  row.from = window.part.time[0];
  row.to = window.part.time[window.part.size() - 1];
  for (int i = 0; i < kPlaces; ++i)
    row.amplitude += parts.Amplitude(row.from + (row.to - row.from) * i / (kPlaces - 1)) / kPlaces;
  row.inertia = window.fit.parameters[0].estimate;
  row.friction = std::numeric_limits<double>::quiet_NaN();
  row.friction_std_error = std::numeric_limits<double>::quiet_NaN();
  return row;
}

/// The windows' estimates of parameter k without bounds.
VectorXd EstimatesOf(Index k, const Windows& windows) {
  VectorXd value(static_cast<Index>(windows.parts.size()));
  for (std::size_t w = 0; w < windows.parts.size(); ++w) {
    const LinearFit& linear = windows.linear[w];
    const double step = linear.influence.col(RowOf(linear, k)).dot(windows.TermsIn(windows.parts[w]).score);
    value[static_cast<Index>(w)] = windows.parts[w].fit.parameters[static_cast<std::size_t>(k)].estimate + step;
  }
  return value;
}

/// Adds the windows' estimates and their trends to the result. `whole` is linearized with the windows' noise.
void AddTrends(const Recording& used, const FitReport& fit, const LinearFit& whole, const Windows& windows,
               const Parts& parts, Constancy& result) {
  VectorXd square(static_cast<Index>(windows.parts.size()));
  for (const PartFit& window : windows.parts) {
    result.windows.push_back(RowOf(window, parts));
    const double amplitude = result.windows.back().amplitude;
    square[static_cast<Index>(result.windows.size()) - 1] = amplitude * amplitude;
  }
  const double inflation = WindowInflation(used, windows);
  for (const Index k : windows.tested) {
    const MatrixXd covariance =
        inflation * ScoreCovariance(windows.noise, windows.autocorrelation, windows.terms, used.clock_scale * used.time,
                                    InfluenceOn(k, used, fit, whole, windows));
    const VectorXd value = EstimatesOf(k, windows);
    for (Index w = 0; w < value.size(); ++w) {
      AmplitudeRow& row = result.windows[static_cast<std::size_t>(w)];
      (k == 0 ? row.inertia : row.friction) = value[w];
      (k == 0 ? row.inertia_std_error : row.friction_std_error) = std::sqrt(covariance(w, w));
    }
    result.trends.push_back(TrendOf(fit.parameters[static_cast<std::size_t>(k)], value, covariance, square));
    result.trends.back().scatter_p = ScatterP(value, covariance.diagonal().cwiseSqrt());
  }
}

}  // namespace

std::string CompareWindows(const Recording& used, const Parts& parts, const std::vector<double>& ends,
                           const FitReport& fit, const FitOptions& options, Constancy& result) {
  if (ends.size() - 1 < kMinWindows * kMinHalfSwings)
    return TooFewHalfSwings(ends, "windows of three periods", kMinWindows * kMinHalfSwings);
  Windows windows;
  if (!fit.parameters[0].fixed) windows.tested.push_back(0);
  const ParameterEstimate* const friction = BestFriction(fit);
  if (friction != nullptr) windows.tested.push_back(friction - fit.parameters.data());
  if (windows.tested.empty()) return "inertia and friction are fixed, so there is no trend to test";
  if (std::string reason = FitWindows(parts, ends, fit, windows); !reason.empty()) return reason;
  if (!LinearizeWindows(used, fit, options, parts, windows)) return "a window does not determine inertia and friction";
  const std::optional<LinearFit> whole =
      LinearizeFit(used, fit, options.rig, windows.terms, options.priors, true, options.stop);
  if (!whole) return "the errors of the whole fit cannot be computed";
  AddTrends(used, fit, *whole, windows, parts, result);
  return "";
}

}  // namespace pendulum
