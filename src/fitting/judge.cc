// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/judge.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "pendulum/base/format.h"
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
  Inverse inverse;      // over free
  double variance = 0;  // of one residual
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
    const bool pushes_out = solution.parameters[i] <= problem.solve.lower[i] && optimum.gradient[i] >= 0;
    (pushes_out ? optimum.at_bound : optimum.free).push_back(i);
  }
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  const double samples = static_cast<double>(problem.data.time.size());
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

/// Upper end of the 95 % interval of a parameter at its lower bound: where the quadratic through the bound's cost and
/// slope has risen by 3.84 variances (the profile of the linearized problem).
double UpperEndAtBound(const Optimum& optimum, int parameter) {
  std::vector<int> freed = optimum.free;
  freed.push_back(parameter);
  const Inverse inverse = InvertInformation(optimum.information, freed);
  if (!inverse.identifiable) return kUnbounded;
  const Index last = inverse.matrix.rows() - 1;
  const Eigen::VectorXd gradient = optimum.gradient(freed);
  const double unbounded_minimum = -inverse.matrix.row(last).dot(gradient);
  const double variance = optimum.variance * inverse.matrix(last, last);
  return unbounded_minimum + std::sqrt(unbounded_minimum * unbounded_minimum + 3.841 * variance);
}

/// Share of the readings' variance that the trajectory leaves.
double UnexplainedShare(const Recording& recording, const Eigen::VectorXd& residual) {
  return residual.squaredNorm() / (recording.value.array() - recording.value.mean()).matrix().squaredNorm();
}

std::string NotIdentifiableReason(const FitProblem& problem, const std::vector<int>& direction) {
  const std::string names = JoinNames(problem, direction);
  return direction.size() == 1 ? "the recording does not depend on " + names + "; fix it"
                               : "the recording tells only a combination of " + names + "; fix one of them";
}

void SetTermination(const Recording& recording, const FitProblem& problem, const Optimum& optimum,
                    const Solution& solution, FitReport& report) {
  // Noise may be as large as a small swing, but it does not follow itself.
  const double most_unexplained = report.noise.lag1_correlation > 0.5 ? 0.2 : 0.8;
  constexpr double kLargestShift = 0.03;
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
                    NumberText(100 * unexplained, 2) +
                    " % of the reading's variance unexplained; choose a window of free swing with --from and --to";
  } else if (!(shift <= kLargestShift)) {
    report.reason =
        "a step of " + NumberText(shift, 2) + " standard errors is left to make; the solver said: " + solution.message;
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
    parameter.lower95 = parameter.estimate;
    const double upper = scale * UpperEndAtBound(optimum, i);
    if (std::isfinite(upper)) parameter.upper95 = upper;
    return;
  }
  const Index row = std::find(optimum.free.begin(), optimum.free.end(), i) - optimum.free.begin();
  parameter.std_error = scale * std::sqrt(optimum.variance * optimum.inverse.matrix(row, row));
  parameter.lower95 = parameter.estimate - t95 * *parameter.std_error;
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

/// Residuals that are larger than the noise between neighbours and go the same way for long are not noise.
void WarnOfLackOfFit(const Recording& recording, FitReport& report) {
  constexpr double kRatio = 1.3;
  constexpr double kCorrelation = 0.3;
  constexpr double kLargestSaid = 100;
  Recording residuals = recording;
  residuals.value = report.residual;
  const double ratio = report.statistics.rms_residual / SuccessiveDifferenceNoise(residuals);
  if (!(ratio > kRatio) || report.noise.lag1_correlation < kCorrelation) return;
  const std::string times = ratio > kLargestSaid ? "more than 100" : NumberText(ratio, 2);
  report.warnings.push_back(
      {"lack_of_fit", "the residuals are " + times +
                          " times the noise between neighbouring samples and follow each other (correlation " +
                          NumberText(report.noise.lag1_correlation, 2) +
                          "): the model does not describe everything in this recording, and the error bars, which take "
                          "the residuals as independent, are too small"});
}

/// Another number of half swings before the stop that explains the data nearly as well (9 in -2 log L).
void WarnOfRivals(const FitProblem& problem, const Solution& solution, FitReport& report) {
  const int holding = problem.solve.holding_parameter;
  if (holding < 0 || !report.parameters[holding].std_error) return;
  const double error = *report.parameters[holding].std_error / problem.si_per_internal[holding];
  const double samples = static_cast<double>(problem.data.time.size());
  for (const Rival& rival : solution.rivals) {
    const double distance = rival.parameters[holding] - solution.parameters[holding];
    if (samples * std::log(rival.sum / solution.sum) > 9 || std::abs(distance) < error) continue;
    report.warnings.push_back(
        {"another_minimum", "a second minimum at " + std::string(problem.infos[holding].name) + " " +
                                NumberText(problem.si_per_internal[holding] * rival.parameters[holding], 6) +
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
  if (!(trace.stop_time < problem.data.time.back() && trace.last_reversal_margin < 3 * error)) return;
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
  report.has_rig = options.rig.has_value();
  report.solver = {solution.iterations, solution.evaluations, solution.message};
  if (!solution.usable) {
    report.termination = Termination::kFailed;
    report.reason = "no trajectory can be traced from the start values: " + solution.message;
    SetParameters(options, problem, Optimum{}, solution, report);
    return report;
  }
  report.fitted = solution.readings;
  report.residual = recording.value - report.fitted;
  report.trace_error = solution.trace_error;
  const Optimum optimum = Linearize(problem, cost, solution);
  report.noise = {problem.data.scale * std::sqrt(optimum.variance), Lag1Correlation(report.residual)};
  report.statistics = ComputeStatistics(report.residual, static_cast<int>(optimum.free.size()), recording.resolution);
  SetTermination(recording, problem, optimum, solution, report);
  SetParameters(options, problem, optimum, solution, report);
  SetDerived(problem, optimum, solution, report);
  if (report.termination == Termination::kConverged) SetCovariance(problem, optimum, report);
  WarnOfLackOfFit(recording, report);
  WarnOfRivals(problem, solution, report);
  WarnOfKink(problem, cost, solution, report);
  return report;
}

}  // namespace pendulum
