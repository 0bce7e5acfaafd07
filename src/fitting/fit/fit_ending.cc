// SPDX-License-Identifier: Apache-2.0
#include "fitting/fit/fit_ending.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/order_violation.h"
#include "pendulum/fitting/fit/plausibility.h"
#include "pendulum/fitting/solve/escape_discontinuities.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// What the ending depends on.
struct FitParts {
  const SolvedFit& fit;
  const std::vector<Description>& described;   // K
  const std::vector<const FitReport*>& alone;  // K fits of each recording alone; none for one recording
};

/// Whether the pendulum comes to rest where gravity and the holding friction are nearly equal at some reversal. With
/// slightly less friction it would continue to swing.
bool IsAtKink(const FitProblem& problem, const TraceSummary& trace, const Solution& solution) {
  constexpr double kNear = 1e-4;
  const int holding = problem.solve.holding_parameter;
  return holding >= 0 && trace.stop_time < problem.data.time.back() &&
         trace.smallest_reversal_margin < kNear * solution.parameters[holding];
}

std::string NotIdentifiableReason(const SolvedFit& fit, const std::vector<int>& direction) {
  std::vector<std::string> all;
  all.reserve(direction.size());
  for (const int i : direction) all.push_back(fit.NameOf(i));
  const std::string names = ListWithAnd(all, all.size());
  if (fit.runs.size() > 1)
    return "the recordings together do not determine " + names + "; fix or share more parameters";
  return direction.size() == 1 ? "the recording does not depend on " + names + "; fix it"
                               : "the recording determines only a combination of " + names + "; fix one of them";
}

/// The reason with the number of its recording, if there are several.
std::string OfRecording(const SolvedFit& fit, std::size_t k, const std::string& reason) {
  return (fit.runs.size() > 1 ? "recording " + std::to_string(k + 1) + ": " : "") + reason;
}

std::string Percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

/// How much of which recordings the trajectories leave unexplained, if it is too much; otherwise empty.
std::string UnexplainedShares(const FitParts& parts) {
  std::string left;
  for (std::size_t k = 0; k < parts.fit.runs.size(); ++k) {
    const double share = parts.fit.runs[k].problem.UnexplainedShare(parts.fit.runs[k].solution.readings);
    if (share <= MaxUnexplainedShare(parts.described[k].correlated)) continue;
    left += (left.empty() ? "" : ", ") + (share < 1 ? Percent(share) : "all") + " of the variance of recording " +
            std::to_string(k + 1);
  }
  return left;
}

/// The names of the parameters that all recordings share.
std::string SharedNames(const SolvedFit& fit) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < fit.shared; ++i) names.push_back(fit.NameOf(static_cast<int>(i)));
  return ListWithAnd(names, names.size());
}

/// Why the trajectories are not those of the readings; empty if they explain enough.
std::string UnexplainedReason(const FitParts& parts) {
  const std::string left = UnexplainedShares(parts);
  if (left.empty()) return "";
  const FittedRun& first = parts.fit.runs.front();
  const bool restricted = first.problem.restricted;
  const std::string given = restricted ? "the given values, bounds and priors do not fit, or " : "";
  if (parts.fit.runs.size() > 1) {
    return given + "these are not swings of one pendulum with one " + SharedNames(parts.fit) +
           ": the best joint trajectories leave " + left + " unexplained";
  }
  const double share = first.problem.UnexplainedShare(first.solution.readings);
  return given + "this is not a free pendulum's swing, or not one of this model: " +
         (share < 1 ? "the best trajectory leaves " + Percent(share) + " of the reading's variance unexplained"
                    : "the best trajectory explains the readings no better than a constant") +
         (restricted ? "; check --fix, --bounds and --prior, or" : ";") +
         " choose a window of free swing with --from and --to";
}

/// Why a joint fit is invalid: the friction parameters have the wrong order, or a separate fit has a second solution,
/// which the other recordings do not exclude.
std::string InvalidJointReason(const FitParts& parts) {
  for (std::size_t k = 0; k < parts.alone.size(); ++k) {
    const FittedRun& run = parts.fit.runs[k];
    if (std::string why = OrderViolation(run.problem, run.solution.parameters); !why.empty()) return why;
    const FitReport& alone = *parts.alone[k];
    if (alone.HasWarning("ambiguous_sensor")) return OfRecording(parts.fit, k, alone.reason);
  }
  return "";
}

/// RemainingShift, corrected for a kink of the sum of squares: it occurs if the release coincides with a sample of a
/// rate. If the sum rises on both sides, the release is at its optimum despite the slope on one side. Then only the
/// step of the other parameters counts.
double RemainingShiftBesideKink(const SolvedFit& fit, const Optimum& optimum) {
  constexpr double kBeside = 1e-5;  // standard errors
  const double shift = RemainingShift(optimum);
  if (shift <= kLargestShift) return shift;
  Optimum others = optimum;
  for (const FittedRun& run : fit.runs) {
    const std::optional<std::size_t> place = run.problem.Find(kReleaseTime.name);
    if (run.problem.data.quantity != Quantity::kRate || !place) continue;
    const auto release = std::ranges::find(others.free, run.at[*place]);
    if (release == others.free.end()) continue;
    const Index row = std::ranges::find(optimum.free, *release) - optimum.free.begin();
    double least = 0;
    if (!fit.cost.SumOfSquares(fit.solution.parameters, &least)) return shift;
    const auto rises = [&](double side) {
      std::vector<double> beside = fit.solution.parameters;
      beside[static_cast<std::size_t>(*release)] += side * kBeside * std::sqrt(optimum.inverse.matrix(row, row));
      double sum = 0;
      return fit.cost.SumOfSquares(beside, &sum) && sum >= least;
    };
    if (rises(-1) && rises(1)) others.free.erase(release);
  }
  if (others.free.size() == optimum.free.size()) return shift;
  others.inverse = InvertInformation(others.information, others.free);
  return others.inverse.identifiable ? RemainingShift(others) : shift;
}

/// Whether a step remains only because the sum of squares jumps: the sum is nowhere smaller along the step, down to 0.1
/// standard errors.
bool IsStoppedByDiscontinuity(const SolvedFit& fit, const Optimum& optimum) {
  const auto may_jump = [](const FittedRun& run) { return JumpsAt(run.problem, run.cost, run.solution.parameters); };
  return RemainingShift(optimum) > kLargestShift && std::ranges::any_of(fit.runs, may_jump) &&
         !FindLowerAlongNewtonStep(optimum, fit.solve, fit.cost, fit.solution);
}

/// Duration of the motion in a recording, in small-angle periods.
double PeriodsOf(const FittedRun& run) {
  const std::vector<double>& parameters = run.solution.parameters;
  const double period = 2 * kPi * std::sqrt(parameters[0]);
  const std::optional<std::size_t> release = run.problem.Find(kReleaseTime.name);
  return (run.problem.data.time.back() - (release ? parameters[*release] : 0.0)) / period;
}

/// Why the motion determines no pendulum; empty if it lasts long enough in some recording.
std::string TooShortReason(const SolvedFit& fit) {
  constexpr double kMinPeriods = 0.5;
  double periods = 0;
  for (const FittedRun& run : fit.runs) periods = std::max(periods, PeriodsOf(run));
  if (periods >= kMinPeriods) return "";
  return std::string(fit.runs.size() > 1 ? "in every recording " : "") + "the motion lasts only " +
         NumberText(periods, 2) +
         " of a period of the best trajectory, too little to determine the pendulum; record several periods, or choose "
         "a window of free swing with --from and --to";
}

/// Why the solution does not describe the readings (ImplausibleReason).
std::string ImplausibleReasonOf(const FitParts& parts) {
  for (std::size_t k = 0; k < parts.fit.runs.size(); ++k) {
    const FittedRun& run = parts.fit.runs[k];
    std::string why = ImplausibleReason(run.problem, run.solution, parts.described[k].correlated);
    if (!why.empty()) return OfRecording(parts.fit, k, why);
  }
  return "";
}

std::string NotAtMinimumReason(const FitParts& parts, double shift) {
  for (std::size_t k = 0; k < parts.fit.runs.size(); ++k) {
    const FittedRun& run = parts.fit.runs[k];
    if (!IsAtKink(run.problem, parts.described[k].trace, run.solution)) continue;
    return OfRecording(parts.fit, k,
                       "the best trajectory stops just before another half swing would begin, where the sum of squares "
                       "has a kink; end the window before the stop (--to) or choose another model");
  }
  return "the estimates are still " +
         (shift < 10 ? NumberText(shift, 2) : std::to_string(std::lround(std::min(shift, 1e6)))) +
         " standard errors from the minimum; try a shorter window or another model";
}

}  // namespace

Ending EndingOf(const SolvedFit& fit, const Optimum& optimum, const std::vector<Description>& described,
                const std::vector<const FitReport*>& alone) {
  const FitParts parts{fit, described, alone};
  if (std::string why = UnexplainedReason(parts); !why.empty()) return {Termination::kNotConverged, std::move(why)};
  if (!optimum.inverse.identifiable) {
    return {Termination::kNotIdentifiable, NotIdentifiableReason(fit, optimum.inverse.direction)};
  }
  for (std::string why : {TooShortReason(fit), ImplausibleReasonOf(parts)}) {
    if (!why.empty()) return {Termination::kNotConverged, std::move(why)};
  }
  if (std::string why = InvalidJointReason(parts); !why.empty()) return {Termination::kNotIdentifiable, std::move(why)};
  const double shift = RemainingShiftBesideKink(fit, optimum);
  if (IsStoppedByDiscontinuity(fit, optimum)) {
    return {Termination::kConverged, "the search stopped at a jump in the sum of squares: a further step of " +
                                         NumberText(shift, 2) +
                                         " standard errors does not reduce it anywhere; the errors assume a smooth "
                                         "minimum"};
  }
  if (!(shift <= kLargestShift)) return {Termination::kNotConverged, NotAtMinimumReason(parts, shift)};
  if (optimum.free.empty() && optimum.at_bound.empty()) {
    return {Termination::kConverged, "every parameter is fixed, so nothing was fitted"};
  }
  return {Termination::kConverged,
          "the estimates are within " + NumberText(kLargestShift, 1) + " standard errors of the minimum"};
}

}  // namespace pendulum
