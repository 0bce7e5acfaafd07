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

/// Sets one parameter's interval and curve.
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

/// The linearized fit over the free parameters of `optimum`.
LinearizedFit LinearizeFit(const FittedRun& run, const Optimum& optimum) {
  const FitProblem& problem = run.problem;
  const std::vector<int>& free = optimum.free;
  const auto size = static_cast<Index>(free.size());
  LinearizedFit linear;
  linear.value = problem.data.values();
  linear.readings = run.solution.readings;
  linear.jacobian = FreeJacobian(run.cost, run.solution, optimum);
  linear.noise = run.solution.noise;
  linear.lower.resize(size);
  linear.upper.resize(size);
  linear.prior_mean = linear.prior_weight = Eigen::VectorXd::Zero(size);
  for (Index row = 0; row < size; ++row) {
    const auto i = static_cast<std::size_t>(free[static_cast<std::size_t>(row)]);
    const double at = run.solution.parameters[i];
    linear.lower[row] = problem.solve.lower[i] - at;
    linear.upper[row] = problem.solve.upper[i] - at;
    for (const PriorTerm& prior : run.cost.priors()) {
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
bool HasLittleNoise(const FittedRun& run) {
  constexpr double kFewAtEdges = 500;
  constexpr double kMostReadings = 4000;  // in means: more take too long, and their likelihood is nearly parabolic
  constexpr double kAtSmallest = 1.05;
  const NoiseModel& noise = run.solution.noise;
  const bool averaged = noise.family == NoiseFamily::kAveraged;
  if (noise.family != NoiseFamily::kQuantized && !averaged) return false;
  const double levels = noise.sigma / (averaged ? noise.averaging.count : noise.resolution);
  const double readings = run.samples() * (averaged ? noise.averaging.readings : 1);
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
void UsePosteriorMeans(const LinearizedFit& linear, const Posterior& posterior, const FittedRun& run,
                       const std::vector<int>& free, FitReport& report) {
  const bool cut_off = ReachesBound(linear, posterior);
  for (std::size_t row = 0; row < free.size(); ++row) {
    const auto i = static_cast<std::size_t>(free[row]);
    const double at = run.solution.parameters[i];
    const auto k = static_cast<Index>(row);
    const IntervalEnds ends =
        cut_off ? ShortestInterval(linear, posterior, k) : IntervalEnds{posterior.lower95[k], posterior.upper95[k]};
    SetInterval(run.problem, free[row], at + *ends.lower, at + *ends.upper, report);
    run.solution.parameters[i] = at + posterior.mean[k];
    report.parameters[i].estimate = run.problem.Reported(i, run.solution.parameters[i]);
    report.parameters[i].at_bound = false;
    report.parameters[i].reason.clear();
  }
  if (!run.cost.Readings(run.solution.parameters, &run.solution.readings, nullptr)) return;
  report.fitted = run.solution.readings;
  report.residual = run.problem.data.values() - report.fitted;
  report.statistics.rms_residual = run.problem.RmsResidual(report.fitted);
}

}  // namespace

bool NeedsProfiles(const SolvedFit& fit, const Optimum& optimum, const Errors& errors) {
  constexpr double kNear = 3;  // standard errors
  const IntervalMethod method = fit.runs.front().options.interval;
  if (method != IntervalMethod::kAuto) return method == IntervalMethod::kProfile;
  for (std::size_t row = 0; row < optimum.free.size(); ++row) {
    const auto i = static_cast<std::size_t>(optimum.free[row]);
    const auto k = static_cast<Index>(row);
    const double reach = kNear * std::sqrt(errors.covariance(k, k));
    const double at = fit.solution.parameters[i];
    if (at - reach < fit.solve.lower[i] || at + reach > fit.solve.upper[i]) return true;
  }
  return !optimum.at_bound.empty();
}

void SetCovarianceIntervals(const FittedRun& run, const Optimum& optimum, const Errors& errors, FitReport& report) {
  const FitProblem& problem = run.problem;
  const SolveOptions& solve = problem.solve;
  for (std::size_t row = 0; row < optimum.free.size(); ++row) {
    const auto i = static_cast<std::size_t>(optimum.free[row]);
    const auto k = static_cast<Index>(row);
    const double length = errors.t95[k] * std::sqrt(errors.covariance(k, k));
    const double at = run.solution.parameters[i];
    const double lowest = i == 0 ? 0.0 : solve.lower[i];  // inertia is positive
    SetInterval(problem, optimum.free[row], std::max(at - length, lowest), std::min(at + length, solve.upper[i]),
                report);
  }
  for (const int i : optimum.at_bound) {
    report.parameters[static_cast<std::size_t>(i)].open_interval = OpenInterval::kAtBound;
    const double at = run.solution.parameters[static_cast<std::size_t>(i)];
    const bool low = BoundSide(solve, static_cast<std::size_t>(i), at) < 0;
    SetInterval(problem, i, low ? std::optional(at) : std::nullopt, low ? std::nullopt : std::optional(at), report);
  }
  if (errors.t95.size() == 0) return;
  const std::string least = NumberText(errors.t95.minCoeff(), 4);
  const std::string most = NumberText(errors.t95.maxCoeff(), 4);
  report.interval_method = "estimate ± " + (least == most ? least : least + " to " + most) + " standard errors";
}

std::optional<Optimum> UsePosterior(const FittedRun& run, const Optimum& smooth, Errors& errors, FitReport& report) {
  constexpr std::size_t kMaxSamples = 200'000;  // beyond this, the matrices of the draws need too much memory
  const bool is_auto = run.options.interval == IntervalMethod::kAuto;
  const bool is_autocorrelated = run.correlation.kind != Autocorrelation::Kind::kWhite;
  if (!is_auto || is_autocorrelated || !HasLittleNoise(run) || run.problem.data.time.size() > kMaxSamples)
    return std::nullopt;
  Optimum optimum = WithoutBounds(smooth, smooth.information);
  if (optimum.free.empty() || !optimum.inverse.identifiable) return std::nullopt;
  const LinearizedFit linear = LinearizeFit(run, optimum);
  const Result<Posterior> posterior = SamplePosterior(linear, run.options.seed, run.options.stop);
  if (!posterior) return std::nullopt;
  UsePosteriorMeans(linear, *posterior, run, optimum.free, report);
  errors.covariance = posterior->covariance;
  errors.t95 = Eigen::VectorXd::Constant(posterior->covariance.rows(), kNormal95);
  errors.runs[0].sigma = posterior->sigma_std_dev;
  errors.runs[0].method =
      "posterior of the quantized likelihood, sampled around the solution: mean and standard deviation";
  run.solution.noise.sigma = posterior->sigma;
  report.interval_method = kPosteriorIntervals;
  return optimum;
}

void SetProfileIntervals(const SolvedFit& fit, const Optimum& optimum, const std::vector<FitReport*>& reports) {
  for (int i = 0; i < static_cast<int>(fit.shared); ++i) {
    if (fit.solve.fixed[static_cast<std::size_t>(i)]) continue;
    const ProfileInterval interval = ProfileParameter(fit, optimum, i);
    for (std::size_t k = 0; k < reports.size(); ++k) {
      const std::vector<int>& at = fit.runs[k].at;
      const auto own = std::ranges::find(at, i) - at.begin();
      SetProfileInterval(fit.runs[k].problem, static_cast<int>(own), interval, *reports[k]);
    }
  }
  for (FitReport* const report : reports) {
    const bool is_of_all = report->parameters.size() == fit.shared;
    report->interval_method =
        is_of_all ? "profile likelihood"
                  : "profile likelihood of the shared parameters; for the other parameters: " + report->interval_method;
  }
}

void SetBootstrapIntervals(const FittedRun& run, const Optimum& optimum, const Eigen::VectorXd& quantile_residuals,
                           FitReport& report) {
  const Bootstrap bootstrap = RunBootstrap(run.problem, run.options, run.solution, quantile_residuals, run.correlation);
  constexpr int kMinRefits = kBootstrapFits * 9 / 10;
  for (const int i : UnfixedParameters(optimum)) {
    if (bootstrap.estimates.rows() < kMinRefits) {
      report.parameters[static_cast<std::size_t>(i)].open_interval = OpenInterval::kFailedResamples;
      continue;
    }
    SetInterval(run.problem, i, bootstrap.Quantile(i, 0.025), bootstrap.Quantile(i, 0.975), report);
  }
  report.interval_method = "quantiles of " + std::to_string(bootstrap.estimates.rows()) + " bootstrap fits, seed " +
                           std::to_string(run.options.seed);
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
