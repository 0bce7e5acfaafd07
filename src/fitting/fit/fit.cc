// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/broken_order.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/judge.h"
#include "pendulum/fitting/fit/rival_solutions.h"
#include "pendulum/fitting/solve/cross_jumps.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/solve/trace_error.h"
#include "pendulum/fitting/uncertainty/profile.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

/// Takes whole turns out of the zero, which a search near the top may have put in: the same readings with the zero next
/// to that of the turning points. Where no reading tells turns they are taken out of the angle.
void TakeTurnsOut(const FitProblem& problem, Solution& solution) {
  const std::size_t zero = problem.zero();
  const std::size_t angle = problem.solve.last_friction + 1;
  if (problem.model.gravity != Gravity::kSine) return;
  if (problem.data.quantity != Quantity::kAngle) {
    const double turns = std::round((solution.parameters[angle] - problem.start.parameters[angle]) / (2 * kPi));
    if (!problem.solve.fixed[angle]) solution.parameters[angle] -= 2 * kPi * turns;
    return;
  }
  if (problem.solve.fixed[zero] || problem.solve.fixed[angle]) return;
  const double turns = std::round((solution.parameters[zero] - problem.start.parameters[zero]) / (2 * kPi));
  solution.parameters[zero] -= 2 * kPi * turns;
  solution.parameters[angle] += 2 * kPi * turns;
}

/// Solves at the tolerance expected to suffice, measures the trajectory's error at the solution, and solves again with
/// a finer one while the error is too large.
Solution SolveToAccuracy(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options) {
  const double max_error = MaxTraceError(problem, options);
  double tolerance = TraceTolerance(max_error, problem.start.amplitude);
  cost.set_tolerance(tolerance);
  const auto guess = [&](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
  cost.set_priors(problem.priors);
  cost.set_noise(problem.noise);
  Solution solution = Search(cost, problem.data, guess, problem.solve);
  TakeTurnsOut(problem, solution);
  MaximizeLikelihood(cost, problem, options, solution);
  CrossJumps(cost, problem, options, solution);
  for (int refinement = 0; solution.usable; ++refinement) {
    solution.usable = MeasureTraceError(cost, tolerance, solution);
    if (solution.trace_error <= max_error || refinement == kMostTraceRefinements) break;
    tolerance = FinerTolerance(tolerance);
    cost.set_tolerance(tolerance);
    solution = Continue(cost, solution, problem.solve);
  }
  return solution;
}

/// A fit before it is judged. The cost looks into the problem.
struct Attempt {
  std::unique_ptr<FitProblem> problem;
  std::unique_ptr<TrajectoryCost> cost;
  Solution solution;
  std::vector<RivalSolution> rivals;  ///< Where searches from other starts ended.
};

/// Solves a problem that is ready.
Attempt SolveProblem(std::unique_ptr<FitProblem> problem, const FitOptions& options) {
  Attempt attempt;
  attempt.problem = std::move(problem);
  attempt.cost = MakeTrajectoryCost(attempt.problem->model, attempt.problem->start.start, attempt.problem->data);
  attempt.cost->set_threads(options.threads);
  attempt.solution = SolveToAccuracy(*attempt.cost, *attempt.problem, options);
  return attempt;
}

Result<Attempt> TryFit(const Recording& recording, const FitOptions& options) {
  Result<FitProblem> problem = MakeFitProblem(recording, options);
  if (!problem) return tl::unexpected(problem.error());
  return SolveProblem(std::make_unique<FitProblem>(*std::move(problem)), options);
}

/// Whether a solution leaves at most a tenth of the readings' variance.
bool Explains(const FitProblem& problem, const Solution& solution) {
  constexpr double kExplained = 0.1;
  return solution.usable && problem.UnexplainedShare(solution.readings) <= kExplained;
}

/// If the start is not chosen: a short hold may be a turning point, and what a release does not explain may have begun
/// in motion.
bool MayBeginInMotion(const Attempt& attempt, const FitOptions& options) {
  const StartValues& start = attempt.problem->start;
  return !options.start && start.start == StartKind::kRelease &&
         (start.short_hold || !Explains(*attempt.problem, attempt.solution));
}

/// If the start is not chosen: events show a hold by one row alone, and edges that scatter have not begun as they were
/// taken to.
bool MayBeginHeld(const Attempt& attempt, const FitOptions& options) {
  constexpr double kScattered = 0.15;  // of a count
  const NoiseModel& noise = attempt.solution.noise;
  return !options.start && attempt.problem->start.start == StartKind::kMoving && noise.family == NoiseFamily::kEdges &&
         noise.sigma > kScattered * noise.resolution;
}

/// Log-likelihood of samples and priors.
double LogPosterior(const Attempt& attempt) {
  return attempt.solution.log_likelihood - 0.5 * attempt.cost->PriorSum(attempt.solution.parameters);
}

bool IsBetter(const Attempt& a, const Attempt& b) {
  return a.solution.usable && (!b.solution.usable || LogPosterior(a) > LogPosterior(b));
}

/// Whether a search ended at a minimum, and not where it had to stop.
bool IsAtMinimum(const Attempt& attempt) {
  constexpr double kNear = 1, kNearJump = 3;  // standard errors
  if (!attempt.solution.usable) return false;
  const std::optional<Optimum> optimum = Linearize(attempt.problem->solve, *attempt.cost, attempt.solution);
  return optimum && optimum->inverse.identifiable &&
         RemainingShift(*optimum) < (HasJumps(*attempt.problem) ? kNearJump : kNear);
}

/// Keeps the better of two, and where the other ended.
void Contend(Attempt other, Attempt& best) {
  if (IsBetter(other, best)) {
    other.rivals = std::move(best.rivals);
    std::swap(best, other);
  }
  if (IsAtMinimum(other)) best.rivals.push_back({other.solution.parameters, LogPosterior(other)});
}

/// From the best of the ways to see the readings.
Result<Attempt> TrySensorStarts(const Recording& recording, const FitOptions& options) {
  Result<Attempt> best = TryFit(recording, options);
  if (!best) return best;
  FitOptions other = options;
  const std::size_t starts = best->problem->sensor_starts;
  for (other.search.sensor_start = 1; other.search.sensor_start < starts; ++other.search.sensor_start) {
    if (Result<Attempt> attempt = TryFit(recording, other)) Contend(*std::move(attempt), *best);
  }
  if (!best->solution.usable) return best;
  if (std::optional<std::vector<double>> image = MirrorImage(*best->problem, best->solution.parameters)) {
    auto problem = std::make_unique<FitProblem>(*best->problem);
    problem->first_guess = *std::move(image);
    Contend(SolveProblem(std::move(problem), options), *best);
  }
  return best;
}

/// From the data's other reference rates: the likeliest of those that lead to parameters that are the law's own.
void FallBack(const Recording& recording, const FitOptions& options, Result<Attempt>& attempt) {
  constexpr int kMostTraces = 400;
  if (options.search.start_values) return;
  const StartValues start = attempt->problem->start;
  std::optional<Attempt> best;
  for (const EnergyBalance& balance : start.other_balances) {
    FitOptions other = options;
    other.search.start_values = start;
    other.search.start_values->energy_balance = balance;
    std::ranges::copy(FrictionFrom(balance), other.search.start_values->parameters.begin() + 1);
    other.search.max_traces = std::min(options.search.max_traces, kMostTraces);
    Result<Attempt> trial = TryFit(recording, other);
    if (!trial || !trial->solution.usable || !BrokenOrder(*trial->problem, trial->solution.parameters).empty())
      continue;
    if (!best || IsBetter(*trial, *best)) best = *std::move(trial);
  }
  if (best) attempt = *std::move(best);
}

/// Amid jumps a search may end at none of the lowest minima: a profile that comes by a lower one says so.
void ConcludeFromProfiles(const FitProblem& problem, FitReport& report) {
  const auto found_better = [](const ParameterEstimate& p) { return p.open_interval == kBetterMinimum; };
  if (!HasJumps(problem) || report.termination != Termination::kConverged) return;
  if (!std::ranges::any_of(report.parameters, found_better)) return;
  report.termination = Termination::kNotConverged;
  report.reason =
      "a profile of the likelihood came by a better minimum: an acceleration jumps when dry friction changes its side, "
      "and has many; say what is known with --prior, as radius=r:std_dev";
}

/// Takes the recording to begin so, where that is better; where release_time is fixed it may not be possible.
void TryStart(StartKind start, const Recording& recording, FitOptions options, Attempt& attempt) {
  options.start = start;
  if (Result<Attempt> other = TrySensorStarts(recording, options); other && IsBetter(*other, attempt)) {
    attempt = *std::move(other);
  }
}

/// The report, unless the fit is stopped: then it may be half made.
Result<FitReport> FitUnlessStopped(const Recording& recording, const FitOptions& options) {
  Result<Attempt> attempt = TrySensorStarts(recording, options);
  if (!attempt) return tl::unexpected(attempt.error());
  if (MayBeginInMotion(*attempt, options)) TryStart(StartKind::kMoving, recording, options, *attempt);
  if (MayBeginHeld(*attempt, options)) TryStart(StartKind::kRelease, recording, options, *attempt);
  if (!BrokenOrder(*attempt->problem, attempt->solution.parameters).empty()) FallBack(recording, options, attempt);
  if (const std::string broken = BrokenOrder(*attempt->problem, attempt->solution.parameters); !broken.empty()) {
    return ReportSimplerLaw(recording, options, *attempt->problem, broken);
  }
  const double log_posterior = LogPosterior(*attempt);
  FitReport report = Judge(recording, options, *attempt->problem, *attempt->cost, std::move(attempt->solution));
  ConcludeFromRivals(*attempt->problem, attempt->rivals, log_posterior, report);
  ConcludeFromProfiles(*attempt->problem, report);
  // Where estimates are means of a posterior, they may lie where the likeliest do not.
  std::vector<double> estimates;
  for (std::size_t i = 0; i < report.parameters.size(); ++i) {
    estimates.push_back(attempt->problem->Internal(i, report.parameters[i].estimate));
  }
  const std::string broken = estimates.empty() ? "" : BrokenOrder(*attempt->problem, estimates);
  return broken.empty() ? report : ReportSimplerLaw(recording, options, *attempt->problem, broken);
}

}  // namespace

Result<FitReport> FitRecording(const Recording& recording, const FitOptions& options) {
  if (options.stop.stop_requested()) return FitStopped();
  Result<FitReport> report = FitUnlessStopped(recording, options);
  if (options.stop.stop_requested()) return FitStopped();
  return report;
}

}  // namespace pendulum
