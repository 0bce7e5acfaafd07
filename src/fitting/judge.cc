// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/judge.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/extrema.h"
#include "pendulum/fitting/covariance.h"

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
  double variance = 0;         // of one residual
};

Optimum Linearize(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution) {
  Optimum optimum;
  Eigen::MatrixXd sums;
  cost.Sums(solution.parameters, &sums);
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
  optimum.variance = solution.sum / std::max(samples - static_cast<double>(optimum.free.size()), 1.0);
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

double MedianInterval(const std::vector<double>& time) {
  std::vector<double> intervals(time.size() - 1);
  for (std::size_t i = 0; i < intervals.size(); ++i) intervals[i] = time[i + 1] - time[i];
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// Share of the readings' variance that the trajectory leaves.
double UnexplainedShare(const Recording& recording, const Eigen::VectorXd& residual) {
  return residual.squaredNorm() / (recording.value.array() - recording.value.mean()).matrix().squaredNorm();
}

/// True when the pendulum comes to rest and gravity hardly exceeds, or hardly fails to exceed, what holds it at some
/// reversal: a little less friction and it would swing on.
bool OnKink(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution) {
  constexpr double kNear = 1e-4;
  const int holding = problem.solve.holding_parameter;
  if (holding < 0) return false;
  const TraceSummary trace = cost.Trace(solution.parameters);
  return trace.stop_time < problem.data.time.back() &&
         trace.smallest_reversal_margin < kNear * solution.parameters[holding];
}

std::string NotIdentifiableReason(const FitProblem& problem, const std::vector<int>& direction) {
  const std::string names = JoinNames(problem, direction);
  return direction.size() == 1 ? "the recording does not depend on " + names + "; fix it"
                               : "the recording tells only a combination of " + names + "; fix one of them";
}

void SetTermination(const Recording& recording, const FitProblem& problem, const Optimum& optimum, bool correlated,
                    bool on_kink, FitReport& report) {
  // Noise may be as large as a small swing, but it does not follow itself.
  const double most_unexplained = correlated ? 0.12 : 0.8;
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
    report.reason = "this is not a free pendulum's swing, or not one of this model: the best trajectory leaves " +
                    std::to_string(std::lround(std::min(100 * unexplained, 1e6))) +
                    " % of the reading's variance unexplained; choose a window of free swing with --from and --to";
  } else if (!(shift <= kLargestShift)) {
    report.reason = on_kink ? "the best trajectory stops just where one half swing more would begin, and there the sum "
                              "of squares has a kink; end the window before the stop (--to) or choose another model"
                            : "a step of " + NumberText(shift, 2) +
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
ParameterEstimate MakeEstimate(const FitOptions& options, const FitProblem& problem, const Solution& solution,
                               std::size_t i) {
  ParameterEstimate parameter;
  parameter.info = problem.infos[i];
  parameter.unit = options.rig ? parameter.info.unit : parameter.info.relative_unit;
  const auto reported = [&](double internal) { return problem.si_per_internal[i] * internal + problem.offset[i]; };
  parameter.estimate = reported(solution.parameters[i]);
  parameter.fixed = problem.solve.fixed[i];
  const bool is_state = parameter.info.name == kInitialAngle.name || parameter.info.name == kInitialRate.name;
  if (!is_state && !parameter.fixed) parameter.closed_form = reported(problem.start.parameters[i]);
  if (options.rig && parameter.info.scales_with_gravity() && !parameter.fixed) {
    const RigValue& torque = options.rig->gravity_torque;
    if (torque.std_dev > 0) {
      parameter.systematic_std_error = std::abs(parameter.estimate) * torque.std_dev / torque.value;
    }
  }
  return parameter;
}

void SetErrors(const FitProblem& problem, const Optimum& optimum, int i, double t95, ParameterEstimate& parameter) {
  const double scale = problem.si_per_internal[i];
  if (parameter.at_bound) {
    parameter.reason = "at its bound";
    const bool at_lower = optimum.gradient[i] >= 0;
    const double length = scale * IntervalAtBound(optimum, i);
    (at_lower ? parameter.lower95 : parameter.upper95) = parameter.estimate;
    if (!std::isfinite(length)) return;
    (at_lower ? parameter.upper95 : parameter.lower95) = parameter.estimate + (at_lower ? length : -length);
    return;
  }
  const Index row = std::find(optimum.free.begin(), optimum.free.end(), i) - optimum.free.begin();
  parameter.std_error = scale * std::sqrt(optimum.variance * optimum.inverse.matrix(row, row));
  parameter.lower95 = std::max(parameter.estimate - t95 * *parameter.std_error, parameter.info.lower);
  parameter.upper95 = parameter.estimate + t95 * *parameter.std_error;
}

void SetParameters(const FitOptions& options, const FitProblem& problem, const Optimum& optimum,
                   const Solution& solution, FitReport& report) {
  const auto samples = static_cast<double>(problem.data.time.size());
  const double freedom = std::max(samples - static_cast<double>(optimum.free.size()), 1.0);
  const double t95 = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  for (int i = 0; i < static_cast<int>(problem.infos.size()); ++i) {
    ParameterEstimate parameter = MakeEstimate(options, problem, solution, static_cast<std::size_t>(i));
    parameter.at_bound = std::find(optimum.at_bound.begin(), optimum.at_bound.end(), i) != optimum.at_bound.end();
    if (parameter.fixed) {
      parameter.reason = "fixed";
    } else if (report.termination != Termination::kConverged) {
      parameter.reason = "the fit is " + std::string(TerminationName(report.termination));
    } else {
      SetErrors(problem, optimum, i, t95, parameter);
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

/// Residuals that follow each other are not independent, and where they are also larger than the noise between
/// neighbours the model does not describe the recording.
void WarnOfLackOfFit(const Recording& recording, bool correlated, FitReport& report) {
  constexpr double kRatio = 1.3;
  constexpr double kLargestSaid = 100;
  if (!correlated) return;
  Recording residuals = recording;
  residuals.value = report.residual;
  const double ratio = report.statistics.rms_residual / SuccessiveDifferenceNoise(residuals);
  const std::string consequence = "the error bars, which take the residuals as independent, are too small";
  if (!(ratio > kRatio)) {
    report.warnings.push_back({"correlated_residuals", "the residuals follow each other: " + consequence});
    return;
  }
  const std::string times = ratio > kLargestSaid ? "more than 100" : NumberText(ratio, 2);
  report.warnings.push_back({"lack_of_fit", "the residuals are " + times +
                                                " times the noise between neighbouring samples and follow each other: "
                                                "the model does not describe everything in this recording, and " +
                                                consequence});
}

/// Below half a resolution of noise the readings are rounded values of a smooth curve, not a curve with white noise.
void WarnOfQuietSensor(const Recording& recording, FitReport& report) {
  constexpr double kQuiet = 0.5;
  if (!(report.statistics.rms_residual < kQuiet * recording.resolution)) return;
  report.warnings.push_back(
      {"quiet_sensor", "the residuals are " + NumberText(report.statistics.rms_residual / recording.resolution, 2) +
                           " resolutions: the noise is too small for rounding to average out, and the error bars may "
                           "be several times too small"});
}

/// With one parameter at its bound the errors of the others hold only if the truth lies on that bound.
void WarnOfBound(const FitProblem& problem, const Optimum& optimum, FitReport& report) {
  if (optimum.at_bound.empty() || report.termination != Termination::kConverged) return;
  const std::string names = JoinNames(problem, optimum.at_bound);
  report.warnings.push_back(
      {"at_bound",
       names + (optimum.at_bound.size() == 1 ? " is at its bound" : " are at their bounds") +
           ": the error bars of the other parameters take it as exactly known and are too small if it is not; "
           "compare with the fit of a simpler model, or record for longer"});
}

/// Another number of half swings before the stop that explains the data nearly as well (9 in -2 log L).
void WarnOfOtherMinima(const FitProblem& problem, const Solution& solution, FitReport& report) {
  const int holding = problem.solve.holding_parameter;
  if (holding < 0 || !report.parameters[holding].std_error) return;
  const double error = *report.parameters[holding].std_error / problem.si_per_internal[holding];
  const auto samples = static_cast<double>(problem.data.time.size());
  for (const Minimum& other : solution.other_minima) {
    const double distance = other.parameters[holding] - solution.parameters[holding];
    if (samples * std::log(other.sum / solution.sum) > 9 || std::abs(distance) < error) continue;
    report.warnings.push_back(
        {"another_minimum", "a second minimum at " + std::string(problem.infos[holding].name) + " " +
                                NumberText(problem.si_per_internal[holding] * other.parameters[holding], 6) +
                                " explains the recording nearly as well"});
    return;
  }
}

/// A stop that the data can hardly date: at the last reversals gravity is within three standard errors of dry friction.
void WarnOfKink(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution, FitReport& report) {
  const int holding = problem.solve.holding_parameter;
  if (holding < 0 || !report.parameters[holding].std_error) return;
  const double error = *report.parameters[holding].std_error / problem.si_per_internal[holding];
  const TraceSummary trace = cost.Trace(solution.parameters);
  if (!(trace.stop_time < problem.data.time.back() && trace.smallest_reversal_margin < 3 * error)) return;
  report.warnings.push_back(
      {"stop_is_a_kink", "at a late reversal gravity is within three standard errors of " +
                             std::string(problem.infos[holding].name) +
                             ", where the number of half swings changes: the error bars there are rough"});
}

}  // namespace

FitReport Judge(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                const TrajectoryCost& cost, const Solution& solution) {
  FitReport report;
  report.model = problem.model;
  report.start = problem.start.start;
  report.quantity = recording.quantity;
  report.solver = {solution.iterations, solution.evaluations, solution.message};
  if (!solution.usable) {
    report.termination = Termination::kFailed;
    report.reason =
        "no trajectory can be traced from the start values: friction would hold the pendulum, its release would lie "
        "outside the hold, or its time scale is absurd; look at what is fixed and at the units";
    SetParameters(options, problem, Optimum{}, solution, report);
    return report;
  }
  report.fitted = solution.readings;
  report.residual = recording.value - report.fitted;
  report.trace_error = solution.trace_error;
  const Optimum optimum = Linearize(problem, cost, solution);
  report.noise = {problem.data.scale * std::sqrt(optimum.variance), Lag1Correlation(report.residual)};
  report.statistics = ComputeStatistics(report.residual, static_cast<int>(optimum.free.size()), recording.resolution);
  const auto lags = static_cast<int>(2 * kPi / problem.start.natural_frequency / MedianInterval(problem.data.time));
  const bool correlated = FollowEachOther(report.residual, lags);
  SetTermination(recording, problem, optimum, correlated, OnKink(problem, cost, solution), report);
  SetParameters(options, problem, optimum, solution, report);
  SetDerived(problem, optimum, solution, report);
  if (report.termination == Termination::kConverged) SetCovariance(problem, optimum, report);
  WarnOfLackOfFit(recording, correlated, report);
  WarnOfQuietSensor(recording, report);
  WarnOfBound(problem, optimum, report);
  WarnOfOtherMinima(problem, solution, report);
  WarnOfKink(problem, cost, solution, report);
  return report;
}

}  // namespace pendulum
