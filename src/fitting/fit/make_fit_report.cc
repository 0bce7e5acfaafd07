// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/make_fit_report.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/fitting/fit/intervals.h"
#include "pendulum/fitting/fit/plausibility.h"
#include "pendulum/fitting/solve/escape_discontinuities.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"
#include "pendulum/fitting/uncertainty/systematic.h"

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

/// Whether the pendulum comes to rest where gravity and the holding friction are nearly equal at some reversal. With
/// slightly less friction it would continue to swing.
bool IsAtKink(const FitProblem& problem, const TraceSummary& trace, const Solution& solution) {
  constexpr double kNear = 1e-4;
  const int holding = problem.solve.holding_parameter;
  return holding >= 0 && trace.stop_time < problem.data.time.back() &&
         trace.smallest_reversal_margin < kNear * solution.parameters[holding];
}

std::string NotIdentifiableReason(const FitProblem& problem, const std::vector<int>& direction) {
  const std::string names = JoinNames(problem, direction);
  return direction.size() == 1 ? "the recording does not depend on " + names + "; fix it"
                               : "the recording determines only a combination of " + names + "; fix one of them";
}

std::string UnexplainedReason(const FitProblem& problem, double unexplained) {
  const std::string what = problem.restricted ? "the given values, bounds and priors do not fit, or this is not a free "
                                                "pendulum's swing, or not one of this model: "
                                              : "this is not a free pendulum's swing, or not one of this model: ";
  const std::string leaves = unexplained < 1
                                 ? "the best trajectory leaves " + std::to_string(std::lround(100 * unexplained)) +
                                       " % of the reading's variance unexplained"
                                 : std::string("the best trajectory explains the readings no better than a constant");
  return what + leaves + (problem.restricted ? "; check --fix, --bounds and --prior, or" : ";") +
         " choose a window of free swing with --from and --to";
}

/// RemainingShift, corrected for a kink of the sum of squares: it occurs if the release coincides with a sample of a
/// rate. If the sum rises on both sides, the release is at its optimum despite the slope on one side. Then only the
/// step of the other parameters counts.
double RemainingShiftBesideKink(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                                const Optimum& optimum) {
  constexpr double kBeside = 1e-5;  // standard errors
  const double shift = RemainingShift(optimum);
  const bool may_have_a_kink = problem.data.quantity == Quantity::kRate && problem.start.start == StartKind::kRelease;
  if (shift <= kLargestShift || !may_have_a_kink) return shift;
  const auto release = std::ranges::find(optimum.free, static_cast<int>(*problem.Find(kReleaseTime.name)));
  if (release == optimum.free.end()) return shift;
  const auto k = release - optimum.free.begin();
  double least = 0;
  if (!cost.SumOfSquares(solution.parameters, &least)) return shift;
  for (const double side : {-1.0, 1.0}) {
    std::vector<double> beside = solution.parameters;
    beside[static_cast<std::size_t>(*release)] += side * kBeside * std::sqrt(optimum.inverse.matrix(k, k));
    double sum = 0;
    if (!cost.SumOfSquares(beside, &sum) || sum < least) return shift;
  }
  Optimum others = optimum;
  others.free.erase(others.free.begin() + k);
  others.inverse = InvertInformation(others.information, others.free);
  return others.inverse.identifiable ? RemainingShift(others) : shift;
}

/// Whether a step remains only because the sum of squares jumps: the sum is nowhere smaller along the step, down to 0.1
/// standard errors.
bool IsStoppedByDiscontinuity(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                              const Optimum& optimum) {
  return HasDiscontinuities(problem) && optimum.inverse.identifiable && RemainingShift(optimum) > kLargestShift &&
         !FindLowerAlongNewtonStep(optimum, problem.solve, cost, solution);
}

/// Duration of the solution's motion in the recording, in small-angle periods.
double PeriodsOf(const FitProblem& problem, const Solution& solution) {
  const double period = 2 * kPi * std::sqrt(solution.parameters[0]);
  const std::optional<std::size_t> release = problem.Find(kReleaseTime.name);
  return (problem.data.time.back() - (release ? solution.parameters[*release] : 0.0)) / period;
}

/// The quantities that decide the termination.
struct SolutionChecks {
  double shift = 0;               ///< RemainingShiftBesideKink
  bool at_discontinuity = false;  ///< IsStoppedByDiscontinuity
  double periods = 0;             ///< PeriodsOf
  bool correlated = false;
  bool at_kink = false;
  std::string implausible;  ///< ImplausibleReason
};

void SetTermination(const FitProblem& problem, const Optimum& optimum, const SolutionChecks& checks,
                    FitReport& report) {
  if (!optimum.inverse.identifiable) {
    report.termination = Termination::kNotIdentifiable;
    report.reason = NotIdentifiableReason(problem, optimum.inverse.direction);
    return;
  }
  constexpr double kMinPeriods = 0.5;
  const double unexplained = problem.UnexplainedShare(report.fitted);
  report.termination = Termination::kNotConverged;
  if (unexplained > MaxUnexplainedShare(checks.correlated)) {
    report.reason = UnexplainedReason(problem, unexplained);
  } else if (checks.periods < kMinPeriods) {
    report.reason = "the motion lasts only " + NumberText(checks.periods, 2) +
                    " of a period of the best trajectory, too little to determine the pendulum; record several "
                    "periods, or choose a window of free swing with --from and --to";
  } else if (!checks.implausible.empty()) {
    report.reason = checks.implausible;
  } else if (checks.at_discontinuity) {
    report.termination = Termination::kConverged;
    report.reason = "the search stopped at a jump in the sum of squares: a further step of " +
                    NumberText(checks.shift, 2) +
                    " standard errors does not reduce it anywhere; the errors assume a smooth minimum";
  } else if (!(checks.shift <= kLargestShift)) {
    report.reason = checks.at_kink
                        ? "the best trajectory stops just before another half swing would begin, where the sum of "
                          "squares has a kink; end the window before the stop (--to) or choose another model"
                        : "the estimates are still " +
                              (checks.shift < 10 ? NumberText(checks.shift, 2)
                                                 : std::to_string(std::lround(std::min(checks.shift, 1e6)))) +
                              " standard errors from the minimum; try a shorter window or another model";
  } else if (optimum.free.empty() && optimum.at_bound.empty()) {
    report.termination = Termination::kConverged;
    report.reason = "every parameter is fixed, so nothing was fitted";
  } else {
    report.termination = Termination::kConverged;
    report.reason = "the estimates are within " + NumberText(kLargestShift, 1) + " standard errors of the minimum";
  }
}

FitReport FailedReport(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                       const TrajectoryCost& cost, const Solution& solution) {
  FitReport report = InitializeReport(recording, problem, cost, solution);
  report.termination = Termination::kFailed;
  report.reason =
      "with the values from which the fit begins the pendulum does not swing: friction holds it, the release is "
      "outside "
      "the hold, or the period is impossible; check fixed values (--fix, --init) and units";
  SetParameters(recording, options, problem, Optimum{}, solution, report);
  return report;
}

/// Sets how far estimates are off by friction that the law does not have: what was named, what the readings
/// suggest, and what they do not exclude.
void SetOtherFriction(const FitProblem& problem, FitReport& report) {
  for (Eigen::Index i = 0; i < report.effects.unseen_friction.size(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    const double unseen = problem.si_per_internal[index] * report.effects.unseen_friction[i];
    if (unseen > 0) report.parameters[index].unseen_friction = unseen;
    report.parameters[index].hidden_friction = problem.si_per_internal[index] * report.effects.hidden_friction[i];
    report.parameters[index].named_friction = problem.si_per_internal[index] * report.effects.named_friction[i];
  }
}

/// Sets estimates, errors and intervals of a converged fit, and the quantities they are based on.
void SetErrors(const Recording& recording, const FitOptions& options, const FitProblem& problem, TrajectoryCost& cost,
               Solution& solution, const Optimum& optimum, const Eigen::VectorXd& z, bool correlated,
               const Correction& corrected, FitReport& report) {
  // Computed first, because the posterior changes σ, on which the optimum's information depends.
  report.effects = CheckEffects(recording, problem, cost, solution, optimum, corrected);
  report.suspicions = report.effects.suspicions;
  SetOtherFriction(problem, report);
  const std::vector<SystematicCovariance> systematic =
      SystematicCovariances(recording, options, problem, cost, solution, optimum, report.effects);
  SetSystematicErrors(problem, systematic, report);
  const Autocorrelation autocorrelation = AutocorrelationOf(problem, cost, solution, optimum, z, correlated);
  Errors errors = ComputeErrors(problem, cost, solution, optimum, autocorrelation);
  report.noise.autocorrelation = autocorrelation;
  report.statistics.effective_samples = errors.runs[0].effective_samples;
  const FittedModel fitted{options, problem, cost, solution, optimum, autocorrelation, z};
  const std::optional<Optimum> sampled = UsePosterior(fitted, errors, report);
  report.noise.sigma = solution.noise.sigma;
  report.noise.sigma_std_error = errors.runs[0].sigma;
  SetCovariance(problem, sampled.value_or(optimum), errors, report);
  if (!sampled) SetIntervals(fitted, errors, report);
  SetDerived(problem, sampled.value_or(optimum), errors, systematic, solution, report);
}

/// Removes the errors of static friction and of its reference rate where the readings do not show how friction falls
/// from one to the other: the two then stand for any curve of the same slope, and an error would promise too much.
void WithdrawUnseenStiction(const FitProblem& problem, FitReport& report) {
  constexpr double kResolved = 0.25;
  if (problem.solve.small_swing_parameters.empty()) return;
  const ParameterEstimate& rate = report.parameters[static_cast<std::size_t>(problem.solve.last_friction)];
  const bool is_narrow = rate.std_error && *rate.std_error <= kResolved * std::abs(rate.estimate);
  const bool is_closed = rate.lower95 && *rate.lower95 > rate.info.lower && rate.upper95;
  if (rate.fixed || (is_narrow && is_closed)) return;
  for (const int i : problem.solve.small_swing_parameters) {
    ParameterEstimate& parameter = report.parameters[static_cast<std::size_t>(i)];
    if (parameter.fixed) continue;
    parameter.std_error = parameter.lower95 = parameter.upper95 = std::nullopt;
    parameter.systematic = {};
    parameter.reason = "the readings do not show at which rate friction falls to its sliding value";
    std::erase_if(report.profiles, [&](const ProfileCurve& curve) { return curve.name == parameter.info.name; });
  }
}

/// Withdraws the errors of a converged fit whose residuals cannot test the model.
void RejectIfTooFewEffectiveSamples(const FitProblem& problem, const Optimum& optimum, FitReport& report) {
  const std::string why =
      TooFewEffectiveSamples(report.statistics.effective_samples, static_cast<int>(optimum.free.size()),
                             problem.UnexplainedShare(report.fitted));
  if (why.empty()) return;
  report.termination = Termination::kNotConverged;
  report.reason = why;
  WithdrawErrors("the fit does not describe the readings", report);
}

}  // namespace

FitReport MakeFitReport(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                        TrajectoryCost& cost, Solution solution, const Correction& corrected) {
  const std::optional<Optimum> optimum = Linearize(problem.solve, cost, solution);
  if (!optimum) return FailedReport(recording, options, problem, cost, solution);
  Description described = Describe(recording, problem, cost, solution, static_cast<int>(optimum->free.size()));
  FitReport& report = described.report;
  const double shift =
      optimum->inverse.identifiable ? RemainingShiftBesideKink(problem, cost, solution, *optimum) : 0.0;
  const bool at_discontinuity = IsStoppedByDiscontinuity(problem, cost, solution, *optimum);
  const bool at_kink = IsAtKink(problem, described.trace, solution);
  SetTermination(problem, *optimum,
                 {shift, at_discontinuity, PeriodsOf(problem, solution), described.correlated, at_kink,
                  ImplausibleReason(problem, solution, described.correlated)},
                 report);
  SetParameters(recording, options, problem, *optimum, solution, report);
  if (report.termination == Termination::kConverged && options.interval != IntervalMethod::kNone) {
    SetErrors(recording, options, problem, cost, solution, *optimum, described.quantile_residuals, described.correlated,
              corrected, report);
    WithdrawUnseenStiction(problem, report);
    if (described.correlated) RejectIfTooFewEffectiveSamples(problem, *optimum, report);
  } else {
    report.derived = DerivedQuantities(problem.infos, solution.parameters, nullptr, {});
  }
  const bool has_identifiability = report.termination == Termination::kConverged || !optimum->inverse.identifiable;
  if (has_identifiability) SetIdentifiability(problem, *optimum, report);
  report.warnings = FitWarnings(recording, problem, solution, described.trace, described.quantile_residuals,
                                described.correlated, report);
  report.solver.evaluations = cost.traces();
  return std::move(report);
}

}  // namespace pendulum
