// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <boost/math/distributions/students_t.hpp>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/covariance.h"
#include "pendulum/fitting/fit_warnings.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The least squares around a solution, in the problem's units (residuals in units of data.scale).
struct Optimum {
  Eigen::MatrixXd information;  // P x P, J'J
  Eigen::VectorXd gradient;     // P, J'r
  std::vector<int> free;        // neither fixed nor at a bound
  std::vector<int> at_bound;
  InformationInverse inverse;  // over free
  double freedom = 1;          // N - free parameters
  double variance = 0;         // of one residual
};

/// Nothing when the trajectory cannot be traced.
std::optional<Optimum> Linearize(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution) {
  Optimum optimum;
  Eigen::MatrixXd sums;
  if (!solution.usable || !cost.Sums(solution.parameters, &sums)) return std::nullopt;
  const Index size = sums.rows() - 1;
  optimum.information = sums.topLeftCorner(size, size);
  optimum.gradient = sums.col(size).head(size);
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (problem.solve.fixed[i]) continue;
    const int side = BoundSide(problem.solve, static_cast<std::size_t>(i), solution.parameters[i]);
    const bool pushes_out = side != 0 && side * optimum.gradient[i] <= 0;
    (pushes_out ? optimum.at_bound : optimum.free).push_back(i);
  }
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  const auto samples = static_cast<double>(problem.data.time.size());
  optimum.freedom = std::max(samples - static_cast<double>(optimum.free.size()), 1.0);
  optimum.variance = std::max(solution.sum - cost.PriorSum(solution.parameters), 0.0) / optimum.freedom;
  return optimum;
}

/// Length of the Gauss-Newton step that is left, in standard errors (its square is twice the expected drop of -log L).
double RemainingShift(const Optimum& optimum) {
  constexpr double kNegligibleVariance = 1e-12;  // residuals of a millionth of the data's scale are rounding
  const Eigen::VectorXd gradient = optimum.gradient(optimum.free);
  const double drop = gradient.dot(optimum.inverse.matrix * gradient);
  return std::sqrt(drop / std::max(optimum.variance, kNegligibleVariance));
}

std::string JoinNames(const FitProblem& problem, const std::vector<int>& indices) {
  std::string names;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (i > 0) names += i + 1 == indices.size() ? " and " : ", ";
    names += problem.infos[static_cast<std::size_t>(indices[i])].name;
  }
  return names;
}

/// Length of the 95 % interval of a parameter at its bound: up to where the quadratic through the bound's cost
/// and slope has risen by 3.84 variances (the profile of the linearized problem).
double IntervalAtBound(const Optimum& optimum, int parameter) {
  std::vector<int> freed = optimum.free;
  freed.push_back(parameter);
  const InformationInverse inverse = InvertInformation(optimum.information, freed);
  if (!inverse.identifiable) return kUnbounded;
  const Index last = inverse.matrix.rows() - 1;
  const Eigen::VectorXd gradient = optimum.gradient(freed);
  const double beyond = std::abs(inverse.matrix.row(last).dot(gradient));  // how far past the bound the minimum lies
  const double rise = 3.841 * optimum.variance * inverse.matrix(last, last);
  return rise / (std::sqrt(beyond * beyond + rise) + beyond);
}

/// Share of the readings' variance that the trajectory leaves.
double UnexplainedShare(const Recording& recording, const Eigen::VectorXd& residual) {
  return residual.squaredNorm() / (recording.value.array() - recording.value.mean()).matrix().squaredNorm();
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

void SetTermination(const Recording& recording, const FitProblem& problem, const Optimum& optimum, bool correlated,
                    bool on_kink, FitReport& report) {
  const double most_unexplained = correlated ? kMostUnexplained : kMostNoise;
  constexpr double kLargestShift = 0.1;
  if (!optimum.inverse.identifiable) {
    report.termination = Termination::kNotIdentifiable;
    report.reason = NotIdentifiableReason(problem, optimum.inverse.direction);
    return;
  }
  const double unexplained = UnexplainedShare(recording, report.residual);
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

/// The power of the clock's scale in a parameter's estimate. A rate sensor's clock is its own: what follows from its
/// readings alone does not scale, and angles, which it tells as rate times time, do.
int PowerOfTime(const ParameterInfo& info, Quantity quantity) {
  const auto is_one_of = [&](auto... infos) { return ((info.name == infos.name) || ...); };
  const bool rate = quantity == Quantity::kRate;
  if (is_one_of(kZeroDrift, kBiasDrift)) return -1;
  if (is_one_of(kInitialRate)) return rate ? 0 : -1;
  if (is_one_of(kReleaseAngle, kInitialAngle)) return rate ? 1 : 0;
  if (!info.scales_with_gravity()) return 0;
  if (is_one_of(kInertia)) return 2;
  if (rate) return 1;
  return info.relative_unit == "s^2" ? 2 : info.relative_unit == "s" ? 1 : 0;
}

/// What the rig's gravity torque and the clock's scale leave open: both multiply the parameter (MODEL.md eq. (24)).
std::optional<double> SystematicError(const Recording& recording, const FitOptions& options,
                                      const ParameterEstimate& parameter) {
  double relative =
      PowerOfTime(parameter.info, recording.quantity) * recording.clock_scale_std_dev / recording.clock_scale;
  if (options.rig && parameter.info.scales_with_gravity()) {
    const RigValue& torque = options.rig->gravity_torque;
    relative = std::hypot(relative, torque.std_dev / torque.value);
  }
  if (relative == 0) return std::nullopt;
  return std::abs(parameter.estimate * relative);
}

/// Value, unit and flags of parameter i, without its errors.
ParameterEstimate MakeEstimate(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                               const Solution& solution, std::size_t i) {
  ParameterEstimate parameter;
  parameter.info = problem.infos[i];
  parameter.unit = options.rig ? parameter.info.unit : parameter.info.relative_unit;
  const bool is_reading = parameter.unit.starts_with("rad");
  if (is_reading && !recording.is_calibrated()) parameter.unit.replace(0, 3, recording.unit);
  const auto reported = [&](double internal) { return problem.si_per_internal[i] * internal + problem.offset[i]; };
  parameter.estimate = reported(solution.parameters[i]);
  parameter.fixed = problem.solve.fixed[i];
  const auto is_one_of = [&](auto... infos) { return ((parameter.info.name == infos.name) || ...); };
  const bool has_closed_form = !is_one_of(kInitialAngle, kInitialRate, kZeroDrift, kBiasDrift);
  if (has_closed_form && !parameter.fixed) parameter.closed_form = reported(problem.start.parameters[i]);
  if (!parameter.fixed) parameter.systematic_std_error = SystematicError(recording, options, parameter);
  return parameter;
}

void SetErrors(const FitProblem& problem, const Optimum& optimum, const Solution& solution, int i, double t95,
               ParameterEstimate& parameter) {
  const double scale = problem.si_per_internal[i];
  if (parameter.at_bound) {
    parameter.reason = "at its bound";
    const bool at_lower = BoundSide(problem.solve, static_cast<std::size_t>(i), solution.parameters[i]) < 0;
    const double length = scale * IntervalAtBound(optimum, i);
    (at_lower ? parameter.lower95 : parameter.upper95) = parameter.estimate;
    if (!std::isfinite(length)) return;
    (at_lower ? parameter.upper95 : parameter.lower95) = parameter.estimate + (at_lower ? length : -length);
    return;
  }
  const Index row = std::find(optimum.free.begin(), optimum.free.end(), i) - optimum.free.begin();
  parameter.std_error = scale * std::sqrt(optimum.variance * optimum.inverse.matrix(row, row));
  const auto reported = [&](double internal) { return scale * internal + problem.offset[i]; };
  const double lowest = std::max(reported(problem.solve.lower[i]), parameter.info.lower);
  parameter.lower95 = std::max(parameter.estimate - t95 * *parameter.std_error, lowest);
  parameter.upper95 = std::min(parameter.estimate + t95 * *parameter.std_error, reported(problem.solve.upper[i]));
}

void SetParameters(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                   const Optimum& optimum, const Solution& solution, FitReport& report) {
  const double t95 = boost::math::quantile(boost::math::students_t(optimum.freedom), 0.975);
  for (int i = 0; i < static_cast<int>(problem.infos.size()); ++i) {
    ParameterEstimate parameter = MakeEstimate(recording, options, problem, solution, static_cast<std::size_t>(i));
    parameter.at_bound = std::find(optimum.at_bound.begin(), optimum.at_bound.end(), i) != optimum.at_bound.end();
    if (parameter.fixed) {
      parameter.reason = "fixed";
    } else if (report.termination != Termination::kConverged) {
      parameter.reason = "the fit is " + std::string(TerminationName(report.termination));
    } else {
      SetErrors(problem, optimum, solution, i, t95, parameter);
    }
    report.parameters.push_back(std::move(parameter));
  }
}

void SetCovariance(const FitProblem& problem, const Optimum& optimum, FitReport& report) {
  Eigen::VectorXd scale(static_cast<Index>(optimum.free.size()));
  for (std::size_t i = 0; i < optimum.free.size(); ++i) {
    const auto index = static_cast<std::size_t>(optimum.free[i]);
    report.covariance_names.emplace_back(problem.infos[index].name);
    scale[static_cast<Index>(i)] = problem.si_per_internal[index];
  }
  report.covariance = optimum.variance * (scale.asDiagonal() * optimum.inverse.matrix * scale.asDiagonal()).eval();
}

void SetDerived(const FitProblem& problem, const Optimum& optimum, const Solution& solution, FitReport& report) {
  if (report.termination != Termination::kConverged) {
    report.derived = DerivedQuantities(problem.infos, solution.parameters, nullptr, {});
    return;
  }
  const auto size = static_cast<Index>(problem.infos.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  covariance(optimum.free, optimum.free) = optimum.variance * optimum.inverse.matrix;
  report.derived = DerivedQuantities(problem.infos, solution.parameters, &covariance, optimum.at_bound);
}

}  // namespace

FitReport Judge(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                const TrajectoryCost& cost, Solution solution) {
  FitReport report;
  report.model = problem.model;
  report.start = problem.start.start;
  report.quantity = recording.quantity;
  report.reading_unit = recording.value_unit();
  const std::optional<Optimum> optimum = Linearize(problem, cost, solution);
  report.solver = {solution.iterations, cost.traces(), solution.message};
  if (!optimum) {
    report.termination = Termination::kFailed;
    report.reason =
        "no trajectory can be traced with these values: friction would hold the pendulum, its release would lie "
        "outside the hold, or its time scale is absurd; look at what is fixed and at the units";
    SetParameters(recording, options, problem, Optimum{}, solution, report);
    return report;
  }
  report.fitted = std::move(solution.readings);
  report.residual = recording.value - report.fitted;
  report.trace_error = solution.trace_error;
  report.noise = {problem.data.scale * std::sqrt(optimum->variance), Lag1Correlation(report.residual)};
  report.statistics = ComputeStatistics(report.residual, static_cast<int>(optimum->free.size()), recording.resolution);
  const TraceSummary trace = cost.Trace(solution.parameters);
  const bool correlated = !IsRounding(recording, report) &&
                          (FollowEachOther(report.residual, PeriodLags(problem)) ||
                           SwingAlong(recording.time, report.fitted, report.residual,
                                      2 * kPi / (problem.start.natural_frequency * recording.clock_scale)));
  SetTermination(recording, problem, *optimum, correlated, OnKink(problem, trace, solution), report);
  SetParameters(recording, options, problem, *optimum, solution, report);
  SetDerived(problem, *optimum, solution, report);
  if (report.termination == Termination::kConverged) SetCovariance(problem, *optimum, report);
  report.warnings = FitWarnings(recording, problem, solution, trace, correlated, report);
  report.solver.evaluations = cost.traces();
  return report;
}

}  // namespace pendulum
