// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fitting/fit/attempt.h"
#include "pendulum/fitting/fit/alternative_minima.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/fitting/fit/make_fit_report.h"
#include "pendulum/fitting/fit/order_violation.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/solve/escape_discontinuities.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/start/start_values.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {
namespace {

// ---- Rescues -------------------------------------------------------------------------------------------------------

/// A rescue of a fit. If it applies, attempts are made with other options, and the best acceptable one replaces the
/// attempt so far.
struct Rescue {
  std::string_view name;  ///< As in SolverSummary::attempts.
  bool (*applies)(const Attempt& attempt, const FitOptions& options);
  std::vector<FitOptions> (*alternatives)(const Attempt& attempt, const FitOptions& options);
  Result<Attempt> (*solve)(const Recording& recording, const FitOptions& options);
  bool (*accepts)(const Attempt& other, const Attempt& attempt);
};

/// Whether a solution leaves at most a tenth of the readings' variance unexplained.
bool ExplainsReadings(const FitProblem& problem, const Solution& solution) {
  constexpr double kUnexplained = 0.1;
  return solution.usable && problem.UnexplainedShare(solution.readings) <= kUnexplained;
}

/// A short hold may be a turning point. A recording that a release does not explain may have begun in motion.
bool MayStartInMotion(const Attempt& attempt, const FitOptions& options) {
  const StartValues& start = attempt.problem->start;
  return !options.start && start.start == StartKind::kRelease &&
         (start.short_hold || !ExplainsReadings(*attempt.problem, attempt.solution));
}

/// An event-driven encoder records a hold as a single row, so a hold may be overlooked. If the edges scatter by more
/// than 0.15 count, the assumed kind of start is wrong.
bool MayStartHeld(const Attempt& attempt, const FitOptions& options) {
  constexpr double kScattered = 0.15;  // of a count
  const NoiseModel& noise = attempt.solution.noise;
  return !options.start && attempt.problem->start.start == StartKind::kMoving && noise.family == NoiseFamily::kEdges &&
         noise.sigma > kScattered * noise.resolution;
}

/// The Stribeck reference rate estimated from the data may lead to friction parameters that violate the required order.
bool ViolatesOrder(const Attempt& attempt, const FitOptions& /*options*/) {
  return !OrderViolation(*attempt.problem, attempt.solution.parameters).empty();
}

/// A search for the reference of a friction law may end at its least value, where the law is a simpler one.
bool HasLeastReference(const Attempt& attempt, const FitOptions& /*options*/) {
  const FitProblem& problem = *attempt.problem;
  const auto last = static_cast<std::size_t>(problem.solve.last_friction);
  return problem.start.energy_balance.reference > 0 && !problem.solve.fixed[last] && attempt.solution.usable &&
         attempt.solution.parameters[last] <= problem.solve.lower[last];
}

/// Whether the residuals of an attempt are larger than the noise between neighbouring samples.
bool ExceedsNeighbourNoise(const Attempt& attempt) {
  constexpr double kRatio = 1.1;
  const TrajectoryData& data = attempt.problem->data;
  return RatioToNeighbourNoise(data.times(), data.values() - attempt.solution.readings) > kRatio;
}

/// Where friction at rest ends the motion of a law with a reference, the likelihood has maxima for each number of half
/// swings and for several references; a search finds one of them.
bool SticksWithReference(const Attempt& attempt, const FitOptions& options) {
  const FitProblem& problem = *attempt.problem;
  const int holding = problem.solve.holding_parameter;
  return holding >= 0 && problem.start.energy_balance.reference > 0 &&
         !problem.solve.fixed[static_cast<std::size_t>(problem.solve.last_friction)] && attempt.solution.usable &&
         attempt.cost->Trace(attempt.solution.parameters).stop_time < problem.data.time.back() &&
         options.initial.empty() && ExceedsNeighbourNoise(attempt);
}

bool MayHaveOtherReference(const Attempt& attempt, const FitOptions& options) {
  return HasLeastReference(attempt, options) || SticksWithReference(attempt, options);
}

template <StartKind kStart>
std::vector<FitOptions> WithStart(const Attempt& /*attempt*/, const FitOptions& options) {
  std::vector<FitOptions> alternatives = {options};
  alternatives.front().start = kStart;
  return alternatives;
}

/// One attempt from each of the other references that the data suggest.
std::vector<FitOptions> FromOtherReferences(const Attempt& attempt, const FitOptions& options) {
  constexpr int kMaxTraces = 400;
  std::vector<FitOptions> alternatives;
  if (options.search.start_values) return alternatives;
  for (const EnergyBalance& balance : attempt.problem->start.other_balances) {
    FitOptions other = options;
    other.search.start_values = attempt.problem->start;
    other.search.start_values->energy_balance = balance;
    std::ranges::copy(FrictionFrom(balance), other.search.start_values->parameters.begin() + 1);
    other.search.max_traces = std::min(options.search.max_traces, kMaxTraces);
    alternatives.push_back(std::move(other));
  }
  return alternatives;
}

bool KeepsOrder(const Attempt& other, const Attempt& /*attempt*/) {
  return other.solution.usable && OrderViolation(*other.problem, other.solution.parameters).empty();
}

constexpr std::array<Rescue, 4> kRescues = {{
    {"moving_start", MayStartInMotion, WithStart<StartKind::kMoving>, MakeAttempt, IsBetter},
    {"release_start", MayStartHeld, WithStart<StartKind::kRelease>, MakeAttempt, IsBetter},
    {"other_reference_rates", ViolatesOrder, FromOtherReferences, SolveFromOneStart, KeepsOrder},
    {"other_references", MayHaveOtherReference, FromOtherReferences, SolveFromOneStart, IsBetter},
}};

/// Applies the rescues in turn. Returns a record of each rescue that was tried.
std::vector<AttemptRecord> ApplyRescues(const Recording& recording, const FitOptions& options, Attempt& attempt) {
  std::vector<AttemptRecord> records;
  for (const Rescue& rescue : kRescues) {
    if (!rescue.applies(attempt, options)) continue;
    std::optional<Attempt> best;
    const std::vector<FitOptions> alternatives = rescue.alternatives(attempt, options);
    for (const FitOptions& alternative : alternatives) {
      Result<Attempt> other = rescue.solve(recording, alternative);
      if (!other || !rescue.accepts(*other, attempt)) continue;
      if (!best || IsBetter(*other, *best)) best = *std::move(other);
    }
    if (!alternatives.empty()) records.push_back({std::string(rescue.name), best.has_value()});
    if (best) attempt = *std::move(best);
  }
  return records;
}

// ---- Corrections ---------------------------------------------------------------------------------------------------

Recording WithoutEffects(Recording recording, const Correction& correction) {
  recording.value -= correction.readings;
  return recording;
}

/// Whether a correction is worth another fit: it has a new cause, or differs from the former one by more than a tenth
/// of the noise.
bool HasChanged(const Correction& correction, const Correction& former, double sigma) {
  constexpr double kNegligible = 0.1;
  if (correction.readings.size() == 0) return false;
  if (former.readings.size() == 0 || correction.causes.size() != former.causes.size()) return true;
  return (correction.readings - former.readings).cwiseAbs().maxCoeff() > kNegligible * sigma;
}

/// The same suspicions of a fit to corrected readings, with the significance that they had before.
std::vector<Suspicion> WithFormerSignificance(std::vector<Suspicion> suspicions, std::span<const Suspicion> former) {
  for (Suspicion& suspicion : suspicions) {
    if (!suspicion.is_corrected) continue;
    const auto same = std::ranges::find(former, suspicion.cause, &Suspicion::cause);
    if (same != former.end()) suspicion.significance = same->significance;
  }
  return suspicions;
}

/// Fits readings corrected for the suspected causes that act in the sensor or at the release, until the correction
/// no longer changes. A correction is kept only if the corrected readings are fitted better.
void CorrectForSuspicions(const Recording& recording, const FitOptions& options, FitReport& report) {
  constexpr int kMostFits = 2;
  const EffectCheck as_recorded = report.effects;
  Correction applied;
  for (int fits = 0; fits < kMostFits; ++fits) {
    const Correction next = report.effects.correction;
    if (!HasChanged(next, applied, report.noise.sigma)) break;
    const Recording corrected = WithoutEffects(recording, next);
    const FitOptions like = OptionsLike(report, options);
    Result<Attempt> attempt = MakeAttempt(corrected, like);
    if (!attempt || !attempt->solution.usable) break;
    FitReport better = MakeFitReport({corrected, like, *attempt->problem, *attempt->cost, attempt->solution}, next);
    const bool is_better = better.termination == Termination::kConverged &&
                           better.effects.pull.cols() == report.effects.pull.cols() &&
                           better.statistics.rms_residual <= report.statistics.rms_residual;
    if (!is_better) break;
    better.suspicions = WithFormerSignificance(std::move(better.suspicions), report.suspicions);
    better.solver.attempts = report.solver.attempts;
    report = std::move(better);
    applied = next;
  }
  if (applied.readings.size() > 0) {
    report.fitted += applied.readings;
    report.correction = applied.readings;
  }
  report.effects = as_recorded;
}

// ---- The report ----------------------------------------------------------------------------------------------------

/// A likelihood with jumps has many local minima, and a search may end at a poor one. If a profile finds a better
/// minimum, the fit is not converged.
void CheckProfilesForBetterMinimum(const FitProblem& problem, FitReport& report) {
  const auto found_better = [](const ParameterEstimate& p) { return p.open_interval == OpenInterval::kBetterMinimum; };
  if (!HasDiscontinuities(problem) || report.termination != Termination::kConverged) return;
  if (!std::ranges::any_of(report.parameters, found_better)) return;
  report.termination = Termination::kNotConverged;
  report.reason =
      "the profile of the likelihood found a better minimum: with dry friction an acceleration jumps at each turning "
      "point, which causes many local minima; give known values with --prior, such as radius=r:std_dev";
}

/// The report of an attempt: with corrected readings if the residuals suggest that, and judged by its alternatives.
FitReport ReportAttempt(const Recording& recording, const FitOptions& options, Attempt& attempt) {
  const AlternativeMinimum minimum = MinimumOf(attempt);
  // A law at the edge of its range, as dahl where the pendulum stands still, is no base for a correction.
  const bool has_base = !HasLeastReference(attempt, options);
  FitReport report = MakeFitReport({recording, options, *attempt.problem, *attempt.cost, attempt.solution});
  const double effective_share =
      report.statistics.effective_samples / static_cast<double>(attempt.problem->data.time.size());
  const bool is_correctable = has_base && report.effects.correction.readings.size() > 0;
  if (is_correctable && options.search.may_correct) CorrectForSuspicions(recording, options, report);
  WarnOfSuspicions(is_correctable && !options.search.may_correct, report);
  CheckAlternativeMinima(*attempt.problem, attempt.alternatives, minimum, effective_share, report);
  CheckProfilesForBetterMinimum(*attempt.problem, report);
  return report;
}

/// A sentence if the reported estimates violate the order that the law requires (OrderViolation); otherwise empty.
/// Means of a posterior may violate the order although the most likely values do not.
std::string OrderViolationOf(const FitProblem& problem, const FitReport& report) {
  std::vector<double> estimates;
  for (std::size_t i = 0; i < report.parameters.size(); ++i) {
    estimates.push_back(problem.Internal(i, report.parameters[i].estimate));
  }
  return estimates.empty() ? "" : OrderViolation(problem, estimates);
}

}  // namespace

Result<FitReport> FitRecording(const Recording& recording, const FitOptions& options) {
  if (options.stop.stop_requested()) return FitStopped();
  Result<Attempt> solved = MakeAttempt(recording, options);
  if (options.stop.stop_requested()) return FitStopped();
  if (!solved) return tl::unexpected(solved.error());
  Attempt& attempt = *solved;
  std::vector<AttemptRecord> records = ApplyRescues(recording, options, attempt);
  std::string violation = OrderViolation(*attempt.problem, attempt.solution.parameters);
  Result<FitReport> report = FitReport();
  if (violation.empty()) {
    report = ReportAttempt(recording, options, attempt);
    violation = OrderViolationOf(*attempt.problem, *report);
  }
  if (!violation.empty()) {
    report = ReportSimplerLaw(recording, options, *attempt.problem, violation);
    records.push_back({"simpler_law", true});
  }
  if (report) report->solver.attempts.insert(report->solver.attempts.begin(), records.begin(), records.end());
  if (options.stop.stop_requested()) return FitStopped();
  return report;
}

}  // namespace pendulum
