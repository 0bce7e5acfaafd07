// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/intervals.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/uncertainty/bootstrap.h"
#include "pendulum/fitting/uncertainty/posterior.h"
#include "pendulum/fitting/uncertainty/profile.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// All parameters that are not fixed, free ones first.
std::vector<int> UnfixedParameters(const Optimum& optimum) {
  std::vector<int> parameters = optimum.free;
  parameters.insert(parameters.end(), optimum.at_bound.begin(), optimum.at_bound.end());
  return parameters;
}

/// Sets one parameter's interval from ends in the problem's units.
void SetInterval(const FitProblem& problem, int parameter, const std::optional<double>& lower,
                 const std::optional<double>& upper, FitReport& report) {
  const auto i = static_cast<std::size_t>(parameter);
  const auto reported = [&](const std::optional<double>& end) {
    return end ? std::optional(problem.Reported(i, *end)) : std::nullopt;
  };
  report.parameters[i].lower95 = reported(lower);
  report.parameters[i].upper95 = reported(upper);
}

/// Converts the points of a profile to reported units.
ProfileCurve ReportedCurve(const FitProblem& problem, int parameter, const ProfileInterval& interval) {
  const auto i = static_cast<std::size_t>(parameter);
  ProfileCurve curve;
  curve.name = problem.infos[i].name;
  curve.threshold = interval.threshold;
  for (const ProfilePoint& point : interval.points) {
    curve.value.push_back(problem.Reported(i, point.value));
    curve.statistic.push_back(point.statistic);
  }
  return curve;
}

void SetProfileIntervals(const FittedModel& fitted, FitReport& report) {
  std::vector<int> parameters = UnfixedParameters(fitted.optimum);
  std::ranges::sort(parameters);
  for (const int i : parameters) {
    SetProfileInterval(
        fitted.problem, i,
        ProfileParameter(fitted.cost, fitted.problem, fitted.solution, fitted.optimum, fitted.correlation, i), report);
  }
  report.interval_method = "profile likelihood";
}

void SetBootstrapIntervals(const FittedModel& fitted, FitReport& report) {
  const Bootstrap bootstrap =
      RunBootstrap(fitted.problem, fitted.options, fitted.solution, fitted.quantile_residuals, fitted.correlation);
  constexpr int kMinRefits = kBootstrapFits * 9 / 10;
  for (const int i : UnfixedParameters(fitted.optimum)) {
    if (bootstrap.estimates.rows() < kMinRefits) {
      report.parameters[static_cast<std::size_t>(i)].open_interval = OpenInterval::kFailedResamples;
      continue;
    }
    SetInterval(fitted.problem, i, bootstrap.Quantile(i, 0.025), bootstrap.Quantile(i, 0.975), report);
  }
  report.interval_method = "quantiles of " + std::to_string(bootstrap.estimates.rows()) + " bootstrap fits, seed " +
                           std::to_string(fitted.options.seed);
}

/// The linearized fit over the free parameters of `optimum`.
LinearizedFit LinearizeFit(const FittedModel& fitted, const Optimum& optimum) {
  const FitProblem& problem = fitted.problem;
  const std::vector<int>& free = optimum.free;
  const auto size = static_cast<Index>(free.size());
  LinearizedFit linear;
  linear.value = problem.data.values();
  linear.readings = fitted.solution.readings;
  linear.jacobian = FreeJacobian(fitted.cost, fitted.solution, optimum);
  linear.noise = fitted.solution.noise;
  linear.lower.resize(size);
  linear.upper.resize(size);
  linear.prior_mean = linear.prior_weight = Eigen::VectorXd::Zero(size);
  for (Index row = 0; row < size; ++row) {
    const auto i = static_cast<std::size_t>(free[static_cast<std::size_t>(row)]);
    const double at = fitted.solution.parameters[i];
    linear.lower[row] = problem.solve.lower[i] - at;
    linear.upper[row] = problem.solve.upper[i] - at;
    for (const PriorTerm& prior : fitted.cost.priors()) {
      if (static_cast<std::size_t>(prior.parameter) != i) continue;
      linear.prior_mean[row] = prior.mean - at;
      linear.prior_weight[row] = prior.weight;
    }
  }
  return linear;
}

/// The parameters that are most strongly correlated with the one in `row` of the inverse.
std::vector<std::string> MostCorrelatedParameters(const FitProblem& problem, const Optimum& optimum, Index row) {
  constexpr double kClosely = 0.9;
  const Eigen::MatrixXd& inverse = optimum.inverse.matrix;
  std::vector<std::string> names;
  for (Index j = 0; j < inverse.cols(); ++j) {
    if (std::abs(inverse(row, j)) < kClosely * std::sqrt(inverse(row, row) * inverse(j, j))) continue;
    names.emplace_back(problem.infos[static_cast<std::size_t>(optimum.free[static_cast<std::size_t>(j)])].name);
  }
  return names;
}

/// Whether the noise is so small that the likelihood is not parabolic: only the few samples near the edges of levels
/// carry information.
bool HasLittleNoise(const FittedModel& fitted) {
  constexpr double kFewAtEdges = 500;
  constexpr double kMostReadings = 4000;  // in means: more take too long, and their likelihood is nearly parabolic
  constexpr double kAtSmallest = 1.05;
  const NoiseModel& noise = fitted.solution.noise;
  const bool averaged = noise.family == NoiseFamily::kAveraged;
  if (noise.family != NoiseFamily::kQuantized && !averaged) return false;
  const double levels = noise.sigma / (averaged ? noise.averaging.count : noise.resolution);
  const auto samples = static_cast<double>(fitted.problem.data.time.size());
  const double readings = samples * (averaged ? noise.averaging.readings : 1);
  if (averaged && readings > kMostReadings) return false;
  return levels < kAtSmallest * kSmallestSigma || (levels < kSmallSigma && readings * levels < kFewAtEdges);
}

/// Whether a bound truncates the posterior.
bool ReachesBound(const LinearizedFit& linear, const Posterior& posterior) {
  constexpr double kNear = 3;  // standard deviations
  const Eigen::ArrayXd reach = kNear * posterior.covariance.diagonal().array().sqrt();
  return (posterior.mean.array() - reach < linear.lower.array()).any() ||
         (posterior.mean.array() + reach > linear.upper.array()).any();
}

/// The shortest interval that contains 95 % of the draws of parameter k. Unlike quantiles it includes the region where
/// a bound truncates the posterior. An end next to a bound is set to the bound.
IntervalEnds ShortestInterval(const LinearizedFit& linear, const Posterior& posterior, Index k) {
  std::vector<double> draws(posterior.draws.col(k).begin(), posterior.draws.col(k).end());
  std::ranges::sort(draws);
  const auto held = static_cast<std::size_t>(0.95 * static_cast<double>(draws.size()));
  std::size_t best = 0;
  for (std::size_t i = 0; i + held < draws.size(); ++i) {
    if (draws[i + held] - draws[i] < draws[best + held] - draws[best]) best = i;
  }
  const double slack = 0.1 * std::sqrt(posterior.covariance(k, k));
  const double low = draws[best] - slack;
  const double high = draws[best + held] + slack;
  return {std::max(low, linear.lower[k]), std::min(high, linear.upper[k])};
}

/// Sets the estimates of the free parameters to the means of the posterior.
void UsePosteriorMeans(const LinearizedFit& linear, const Posterior& posterior, const FittedModel& fitted,
                       const std::vector<int>& free, FitReport& report) {
  const bool cut_off = ReachesBound(linear, posterior);
  for (std::size_t row = 0; row < free.size(); ++row) {
    const auto i = static_cast<std::size_t>(free[row]);
    const double at = fitted.solution.parameters[i];
    const auto k = static_cast<Index>(row);
    const IntervalEnds ends =
        cut_off ? ShortestInterval(linear, posterior, k) : IntervalEnds{posterior.lower95[k], posterior.upper95[k]};
    SetInterval(fitted.problem, free[row], at + *ends.lower, at + *ends.upper, report);
    fitted.solution.parameters[i] = at + posterior.mean[k];
    report.parameters[i].estimate = fitted.problem.Reported(i, fitted.solution.parameters[i]);
    report.parameters[i].at_bound = false;
    report.parameters[i].reason.clear();
  }
  if (!fitted.cost.Readings(fitted.solution.parameters, &fitted.solution.readings, nullptr)) return;
  report.fitted = fitted.solution.readings;
  report.residual = fitted.problem.data.values() - report.fitted;
  report.statistics.rms_residual = fitted.problem.RmsResidual(report.fitted);
}

/// The optimum in which the parameters at bounds are free, as the posterior requires.
Optimum WithoutBounds(const Optimum& optimum) {
  Optimum free = optimum;
  free.free.insert(free.free.end(), free.at_bound.begin(), free.at_bound.end());
  std::ranges::sort(free.free);
  free.at_bound.clear();
  free.inverse = InvertInformation(free.information, free.free);
  return free;
}

}  // namespace

bool IsNearBound(const SolveOptions& solve, const Optimum& optimum, const std::vector<double>& parameters,
                 const Eigen::MatrixXd& covariance) {
  constexpr double kNear = 3;  // standard errors
  for (std::size_t row = 0; row < optimum.free.size(); ++row) {
    const auto i = static_cast<std::size_t>(optimum.free[row]);
    const double reach = kNear * std::sqrt(covariance(static_cast<Index>(row), static_cast<Index>(row)));
    if (parameters[i] - reach < solve.lower[i] || parameters[i] + reach > solve.upper[i]) return true;
  }
  return !optimum.at_bound.empty();
}

void SetCovarianceIntervals(const FitProblem& problem, const Solution& solution, const Optimum& optimum,
                            const Errors& errors, FitReport& report) {
  const SolveOptions& solve = problem.solve;
  for (std::size_t row = 0; row < optimum.free.size(); ++row) {
    const auto i = static_cast<std::size_t>(optimum.free[row]);
    const auto k = static_cast<Index>(row);
    const double length = errors.t95[k] * std::sqrt(errors.covariance(k, k));
    const double at = solution.parameters[i];
    const double lowest = i == 0 ? 0.0 : solve.lower[i];  // inertia is positive
    SetInterval(problem, optimum.free[row], std::max(at - length, lowest), std::min(at + length, solve.upper[i]),
                report);
  }
  for (const int i : optimum.at_bound) {
    report.parameters[static_cast<std::size_t>(i)].open_interval = OpenInterval::kAtBound;
    const double at = solution.parameters[static_cast<std::size_t>(i)];
    const bool low = BoundSide(solve, static_cast<std::size_t>(i), at) < 0;
    SetInterval(problem, i, low ? std::optional(at) : std::nullopt, low ? std::nullopt : std::optional(at), report);
  }
  if (errors.t95.size() == 0) return;
  const std::string least = NumberText(errors.t95.minCoeff(), 4);
  const std::string most = NumberText(errors.t95.maxCoeff(), 4);
  report.interval_method = "estimate ± " + (least == most ? least : least + " to " + most) + " standard errors";
}

void SetProfileInterval(const FitProblem& problem, int parameter, const ProfileInterval& interval, FitReport& report) {
  const auto k = static_cast<std::size_t>(parameter);
  report.parameters[k].open_interval = interval.open;
  if (interval.lower == problem.solve.lower[k] && interval.upper == problem.solve.upper[k]) {
    report.parameters[k].open_interval = OpenInterval::kNothingExcluded;
    SetInterval(problem, parameter, std::nullopt, std::nullopt, report);
  } else {
    SetInterval(problem, parameter, interval.lower, interval.upper, report);
  }
  if (!interval.points.empty()) report.profiles.push_back(ReportedCurve(problem, parameter, interval));
}

std::optional<Optimum> UsePosterior(const FittedModel& fitted, Errors& errors, FitReport& report) {
  constexpr std::size_t kMaxSamples = 200'000;  // beyond this, the matrices of the draws need too much memory
  const bool is_auto = fitted.options.interval == IntervalMethod::kAuto;
  const bool is_autocorrelated = fitted.correlation.kind != Autocorrelation::Kind::kWhite;
  if (!is_auto || is_autocorrelated || !HasLittleNoise(fitted) || fitted.problem.data.time.size() > kMaxSamples)
    return std::nullopt;
  Optimum optimum = WithoutBounds(fitted.optimum);
  if (optimum.free.empty() || !optimum.inverse.identifiable) return std::nullopt;
  const LinearizedFit linear = LinearizeFit(fitted, optimum);
  const Result<Posterior> posterior = SamplePosterior(linear, fitted.options.seed, fitted.options.stop);
  if (!posterior) return std::nullopt;
  UsePosteriorMeans(linear, *posterior, fitted, optimum.free, report);
  errors.covariance = posterior->covariance;
  errors.t95 = Eigen::VectorXd::Constant(posterior->covariance.rows(), kNormal95);
  errors.runs[0].sigma = posterior->sigma_std_dev;
  errors.runs[0].method =
      "posterior of the quantized likelihood, sampled around the solution: mean and standard deviation";
  fitted.solution.noise.sigma = posterior->sigma;
  report.interval_method = kPosteriorIntervals;
  return optimum;
}

void SetIntervals(const FittedModel& fitted, const Errors& errors, FitReport& report) {
  switch (fitted.options.interval) {
    case IntervalMethod::kBootstrap: return SetBootstrapIntervals(fitted, report);
    case IntervalMethod::kProfile: return SetProfileIntervals(fitted, report);
    case IntervalMethod::kNone:
    case IntervalMethod::kCovariance: break;
    case IntervalMethod::kAuto:
      if (IsNearBound(fitted.problem.solve, fitted.optimum, fitted.solution.parameters, errors.covariance)) {
        return SetProfileIntervals(fitted, report);
      }
  }
  SetCovarianceIntervals(fitted.problem, fitted.solution, fitted.optimum, errors, report);
}

namespace {

Identifiability AssessIdentifiability(const FitProblem& problem, const Optimum& optimum, int parameter,
                                      const ParameterEstimate& estimate) {
  // The parameter's error is ten times the error it would have if the other parameters were known. This corresponds to
  // a correlation of 0.995 with them.
  constexpr double kMinVarianceInflation = 100;
  constexpr double kImprecise = 0.1;  // of the estimate
  const auto i = static_cast<std::size_t>(parameter);
  Identifiability known;
  known.parameter = estimate.info.name;
  const std::vector<int>& undetermined = optimum.inverse.direction;
  const Index row = std::ranges::find(optimum.free, parameter) - optimum.free.begin();
  const bool is_correlated =
      optimum.inverse.identifiable && row < static_cast<Index>(optimum.free.size()) &&
      optimum.inverse.matrix(row, row) * optimum.information(parameter, parameter) > kMinVarianceInflation &&
      estimate.std_error.value_or(0) > kImprecise * std::abs(estimate.estimate);
  const bool reaches_bound = estimate.at_bound ||
                             (estimate.lower95 && *estimate.lower95 <= problem.Reported(i, problem.solve.lower[i])) ||
                             (estimate.upper95 && *estimate.upper95 >= problem.Reported(i, problem.solve.upper[i]));
  if (std::ranges::find(undetermined, parameter) != undetermined.end()) {
    known.verdict = Identifiability::Verdict::kNotIdentifiable;
    for (const int other : undetermined)
      known.direction.emplace_back(problem.infos[static_cast<std::size_t>(other)].name);
  } else if (is_correlated || reaches_bound) {
    known.verdict = Identifiability::Verdict::kWeakly;
    if (is_correlated) known.direction = MostCorrelatedParameters(problem, optimum, row);
  } else {
    return known;
  }
  known.advice = MeasurementFor(known.parameter);
  return known;
}

}  // namespace

void SetIdentifiability(const FitProblem& problem, const Optimum& optimum, FitReport& report) {
  for (const int i : UnfixedParameters(optimum)) {
    const ParameterEstimate& estimate = report.parameters[static_cast<std::size_t>(i)];
    report.identifiability.push_back(AssessIdentifiability(problem, optimum, i, estimate));
  }
}

}  // namespace pendulum
