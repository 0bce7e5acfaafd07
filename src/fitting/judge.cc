// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/estimate_autocorrelation.h"
#include "pendulum/fitting/fit_warnings.h"
#include "pendulum/fitting/intervals.h"
#include "pendulum/fitting/systematic.h"

namespace pendulum {
namespace {

using Eigen::Index;

std::string JoinNames(const FitProblem& problem, const std::vector<int>& indices) {
  std::string names;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (i > 0) names += i + 1 == indices.size() ? " and " : ", ";
    names += problem.infos[static_cast<std::size_t>(indices[i])].name;
  }
  return names;
}

/// True when the pendulum comes to rest and gravity hardly exceeds, or hardly fails to exceed, what holds it at some
/// reversal: a little less friction and it would swing on.
bool OnKink(const FitProblem& problem, const TraceSummary& trace, const Solution& solution) {
  constexpr double kNear = 1e-4;
  const int holding = problem.solve.holding_parameter;
  return holding >= 0 && trace.stop_time < problem.data.time.back() &&
         trace.smallest_reversal_margin < kNear * solution.parameters[holding];
}

/// Residuals of a billionth of the swing are those of numbers, not of a model.
bool IsRounding(const Recording& recording, const FitReport& report) {
  constexpr double kRounding = 1e-9;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  return report.statistics.rms_residual < kRounding * range;
}

/// Samples in a period, as a number of lags.
int PeriodLags(const FitProblem& problem) {
  const std::vector<double>& time = problem.data.time;
  constexpr std::size_t kEnough = 100'000;
  const std::size_t stride = time.size() / kEnough + 1;
  std::vector<double> intervals;
  for (std::size_t i = 0; i + 1 < time.size(); i += stride) intervals.push_back(time[i + 1] - time[i]);
  const double lags = 2 * kPi / problem.start.natural_frequency / Median(std::move(intervals));
  return static_cast<int>(std::min(lags, static_cast<double>(time.size())));
}

/// A swing that the model describes leaves less of the variance than this, unless it drowns in noise, which does not
/// follow itself: chosen between the real recordings' worst fits (0.1) and what is no free swing (0.2 and more).
constexpr double kMostUnexplained = 0.12;
constexpr double kMostNoise = 0.8;

std::string NotIdentifiableReason(const FitProblem& problem, const std::vector<int>& direction) {
  const std::string names = JoinNames(problem, direction);
  return direction.size() == 1 ? "the recording does not depend on " + names + "; fix it"
                               : "the recording tells only a combination of " + names + "; fix one of them";
}

std::string UnexplainedReason(const FitProblem& problem, double unexplained) {
  const std::string what = problem.restricted ? "not with the values, bounds and priors that were given, not a free "
                                                "pendulum's swing, or not one of this model: "
                                              : "this is not a free pendulum's swing, or not one of this model: ";
  const std::string leaves = unexplained < 1
                                 ? "the best trajectory leaves " + std::to_string(std::lround(100 * unexplained)) +
                                       " % of the reading's variance unexplained"
                                 : std::string("the best trajectory explains the readings no better than a constant");
  return what + leaves + (problem.restricted ? "; look at --fix, --bounds and --prior, or" : ";") +
         " choose a window of free swing with --from and --to";
}

void SetTermination(const FitProblem& problem, const Optimum& optimum, bool correlated, bool on_kink,
                    FitReport& report) {
  const double most_unexplained = correlated ? kMostUnexplained : kMostNoise;
  constexpr double kLargestShift = 0.1;
  if (!optimum.inverse.identifiable) {
    report.termination = Termination::kNotIdentifiable;
    report.reason = NotIdentifiableReason(problem, optimum.inverse.direction);
    return;
  }
  const double unexplained = problem.UnexplainedShare(report.fitted);
  const double shift = RemainingShift(optimum);
  report.termination = Termination::kNotConverged;
  if (unexplained > most_unexplained) {
    report.reason = UnexplainedReason(problem, unexplained);
  } else if (!(shift <= kLargestShift)) {
    report.reason = on_kink
                        ? "the best trajectory stops just where one half swing more would begin, and there the sum "
                          "of squares has a kink; end the window before the stop (--to) or choose another model"
                        : "a step of " +
                              (shift < 10 ? NumberText(shift, 2) : std::to_string(std::lround(std::min(shift, 1e6)))) +
                              " standard errors is left to make; a shorter window or another model may converge";
  } else if (optimum.free.empty() && optimum.at_bound.empty()) {
    report.termination = Termination::kConverged;
    report.reason = "every parameter is fixed: nothing was fitted";
  } else {
    report.termination = Termination::kConverged;
    report.reason = "the step left to make is below " + NumberText(kLargestShift, 1) + " standard errors";
  }
}

/// Value, unit and flags of parameter i, without its errors.
ParameterEstimate MakeEstimate(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                               const Solution& solution, std::size_t i) {
  ParameterEstimate parameter;
  parameter.info = problem.infos[i];
  parameter.unit = options.rig ? parameter.info.unit : parameter.info.relative_unit;
  const bool is_reading = parameter.unit.starts_with("rad");
  if (is_reading && !recording.is_calibrated()) parameter.unit.replace(0, 3, recording.unit);
  parameter.estimate = problem.Reported(i, solution.parameters[i]);
  parameter.fixed = problem.solve.fixed[i];
  const auto is_one_of = [&](auto... infos) { return ((parameter.info.name == infos.name) || ...); };
  const bool has_closed_form = !is_one_of(kInitialAngle, kInitialRate, kZeroDrift, kBiasDrift);
  if (has_closed_form && !parameter.fixed) parameter.closed_form = problem.Reported(i, problem.start.parameters[i]);
  return parameter;
}

void SetParameters(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                   const Optimum& optimum, const Solution& solution, FitReport& report) {
  report.parameters.clear();
  for (int i = 0; i < static_cast<int>(problem.infos.size()); ++i) {
    ParameterEstimate parameter = MakeEstimate(recording, options, problem, solution, static_cast<std::size_t>(i));
    parameter.at_bound = std::ranges::find(optimum.at_bound, i) != optimum.at_bound.end();
    if (parameter.fixed) {
      parameter.reason = "fixed";
    } else if (report.termination != Termination::kConverged) {
      parameter.reason = "the fit is " + std::string(TerminationName(report.termination));
    } else if (parameter.at_bound) {
      parameter.reason = "at its bound";
    }
    report.parameters.push_back(std::move(parameter));
  }
}

void SetCovariance(const FitProblem& problem, const Optimum& optimum, const Errors& errors, FitReport& report) {
  Eigen::VectorXd scale(static_cast<Index>(optimum.free.size()));
  for (std::size_t i = 0; i < optimum.free.size(); ++i) {
    const auto index = static_cast<std::size_t>(optimum.free[i]);
    const auto row = static_cast<Index>(i);
    report.covariance_names.emplace_back(problem.infos[index].name);
    scale[row] = problem.si_per_internal[index];
    report.parameters[index].std_error = scale[row] * std::sqrt(errors.covariance(row, row));
  }
  report.covariance = scale.asDiagonal() * errors.covariance * scale.asDiagonal();
  report.std_error_method = errors.method;
}

void SetSystematicErrors(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                         const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum,
                         FitReport& report) {
  const Eigen::MatrixXd covariance = SystematicCovariance(recording, options, problem, cost, solution, optimum);
  std::vector<Index> concerned;
  for (Index i = 0; i < covariance.rows(); ++i) {
    if (!(covariance(i, i) > 0)) continue;
    ParameterEstimate& parameter = report.parameters[static_cast<std::size_t>(i)];
    parameter.systematic_std_error = std::sqrt(covariance(i, i));
    report.systematic_names.emplace_back(parameter.info.name);
    concerned.push_back(i);
  }
  report.systematic_covariance = covariance(concerned, concerned);
}

void SetDerived(const FitProblem& problem, const Optimum& optimum, const Errors& errors, const Solution& solution,
                FitReport& report) {
  if (report.termination != Termination::kConverged) {
    report.derived = DerivedQuantities(problem.infos, solution.parameters, nullptr, {});
    return;
  }
  const auto size = static_cast<Index>(problem.infos.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  covariance(optimum.free, optimum.free) = errors.covariance;
  report.derived = DerivedQuantities(problem.infos, solution.parameters, &covariance, optimum.at_bound);
  std::vector<IntervalEnds> intervals;
  for (std::size_t i = 0; i < problem.infos.size(); ++i) {
    const ParameterEstimate& parameter = report.parameters[i];
    const auto internal = [&](const std::optional<double>& end) {
      if (parameter.fixed) return std::optional(solution.parameters[i]);
      return end ? std::optional(problem.Internal(i, *end)) : std::nullopt;
    };
    intervals.push_back({internal(parameter.lower95), internal(parameter.upper95)});
  }
  SetDerivedIntervals(problem.infos, solution.parameters, intervals, report.derived);
}

/// The memory of the residuals, looked for where independence is in doubt.
Autocorrelation MemoryOf(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                         const Optimum& optimum, const Eigen::VectorXd& z, bool correlated) {
  constexpr double kDoubtful = 0.05;
  if (optimum.free.empty() || (!correlated && LjungBoxP(z) > kDoubtful)) return {};
  const Eigen::MatrixXd jacobian = FreeJacobian(cost, solution, optimum);
  if (jacobian.rows() == 0) return {};
  return EstimateAutocorrelation(problem.data.times(), z, jacobian / solution.noise.sigma);
}

NoiseEstimate DescribeNoise(const FitProblem& problem, const Solution& solution, const Eigen::VectorXd& z) {
  NoiseEstimate noise;
  noise.family = solution.noise.family;
  noise.sigma = solution.noise.sigma;
  noise.resolution = problem.resolution;
  noise.censored = problem.censored;
  noise.why = solution.noise_reason;
  noise.lag1_correlation = Lag1Correlation(z);
  return noise;
}

FitReport FailedReport(FitReport report, const Recording& recording, const FitOptions& options,
                       const FitProblem& problem, const Solution& solution) {
  report.termination = Termination::kFailed;
  report.reason =
      "no trajectory can be traced with these values: friction would hold the pendulum, its release would lie "
      "outside the hold, or its time scale is absurd; look at what is fixed and at the units";
  SetParameters(recording, options, problem, Optimum{}, solution, report);
  return report;
}

/// Estimates, errors and intervals of a fit that converged, and what they rest on.
void SetErrors(const Recording& recording, const FitOptions& options, const FitProblem& problem, TrajectoryCost& cost,
               Solution& solution, const Optimum& optimum, const Eigen::VectorXd& z, bool correlated,
               FitReport& report) {
  // Before the posterior moves σ, on which the optimum's information rests.
  SetSystematicErrors(recording, options, problem, cost, solution, optimum, report);
  const Autocorrelation memory = MemoryOf(problem, cost, solution, optimum, z, correlated);
  Errors errors = ComputeErrors(problem, cost, solution, optimum, memory);
  report.noise.memory = memory;
  report.statistics.effective_samples = errors.effective_samples;
  const FittedModel fitted{options, problem, cost, solution, optimum, memory, z};
  const std::optional<Optimum> sampled = UsePosterior(fitted, errors, report);
  report.noise.sigma = solution.noise.sigma;
  report.noise.sigma_std_error = errors.sigma;
  SetCovariance(problem, sampled.value_or(optimum), errors, report);
  if (!sampled) SetIntervals(fitted, errors, report);
  SetDerived(problem, sampled.value_or(optimum), errors, solution, report);
}

}  // namespace

FitReport Judge(const Recording& recording, const FitOptions& options, const FitProblem& problem, TrajectoryCost& cost,
                Solution solution) {
  FitReport report;
  report.model = problem.model;
  report.start = problem.start.start;
  report.quantity = recording.quantity;
  report.reading_unit = recording.value_unit();
  const std::optional<Optimum> optimum = Linearize(problem, cost, solution);
  report.solver = {solution.iterations, cost.traces(), solution.message};
  if (!optimum) return FailedReport(std::move(report), recording, options, problem, solution);
  const Eigen::VectorXd z = QuantileResiduals(solution.noise, recording.value, solution.readings);
  report.fitted = solution.readings;
  report.residual = recording.value - report.fitted;
  report.trace_error = solution.trace_error;
  report.statistics =
      ComputeStatistics(report.residual, z, solution.log_likelihood, static_cast<int>(optimum->free.size()));
  report.statistics.rms_residual = problem.RmsResidual(report.fitted);
  report.noise = DescribeNoise(problem, solution, z);
  const TraceSummary trace = cost.Trace(solution.parameters);
  const bool correlated = !IsRounding(recording, report) &&
                          (FollowEachOther(z, PeriodLags(problem)) ||
                           SwingAlong(recording.time, report.fitted, z,
                                      2 * kPi / (problem.start.natural_frequency * recording.clock_scale)));
  SetTermination(problem, *optimum, correlated, OnKink(problem, trace, solution), report);
  SetParameters(recording, options, problem, *optimum, solution, report);
  if (report.termination == Termination::kConverged) {
    SetErrors(recording, options, problem, cost, solution, *optimum, z, correlated, report);
  } else {
    SetDerived(problem, *optimum, Errors{}, solution, report);
  }
  const bool is_told = report.termination == Termination::kConverged || !optimum->inverse.identifiable;
  if (is_told) SetIdentifiability(problem, *optimum, report);
  report.warnings = FitWarnings(recording, problem, solution, trace, z, correlated, report);
  report.solver.evaluations = cost.traces();
  return report;
}

}  // namespace pendulum
