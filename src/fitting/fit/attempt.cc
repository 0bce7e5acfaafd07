// SPDX-License-Identifier: Apache-2.0
#include "fitting/fit/attempt.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/fitting/solve/escape_discontinuities.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/solve/trace_error.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

/// Removes whole turns that a search near the top may have added to the zero angle: the modelled readings stay the
/// same. If the readings do not determine the number of turns, removes the turns from the first angle instead.
void UnwrapOffset(const FitProblem& problem, Solution& solution) {
  const std::size_t zero = problem.zero();
  const std::size_t angle = problem.angle();
  const double turn = 2 * problem.model.gravity.top();
  if (!std::isfinite(turn)) return;
  if (problem.data.quantity != Quantity::kAngle) {
    const double turns = std::round((solution.parameters[angle] - problem.start.parameters[angle]) / turn);
    if (!problem.solve.fixed[angle]) solution.parameters[angle] -= turn * turns;
    return;
  }
  if (problem.solve.fixed[zero] || problem.solve.fixed[angle]) return;
  const double turns = std::round((solution.parameters[zero] - problem.start.parameters[zero]) / turn);
  solution.parameters[zero] -= turn * turns;
  solution.parameters[angle] += turn * turns;
}

/// Solves a problem that is ready, at the tolerance expected to suffice, and measures the error of the trajectory at
/// the solution. While the error is too large, solves again at a finer tolerance.
Attempt SolveProblem(FitProblem ready, const FitOptions& options) {
  Attempt attempt;
  attempt.problem = std::make_unique<FitProblem>(std::move(ready));
  const FitProblem& problem = *attempt.problem;
  attempt.cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  TrajectoryCost& cost = *attempt.cost;
  Solution& solution = attempt.solution;
  const double max_error = MaxTraceError(problem, options);
  double tolerance = TraceTolerance(max_error, problem.start.amplitude);
  cost.set_threads(options.threads);
  cost.set_tolerance(tolerance);
  cost.set_priors(problem.priors);
  cost.set_noise(problem.noise);
  const auto guess = [&](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
  solution = Search(cost, problem.data, guess, problem.solve);
  UnwrapOffset(problem, solution);
  MaximizeLikelihood(cost, problem, options, solution);
  EscapeDiscontinuities(cost, problem, options, solution);
  for (int refinement = 0; solution.usable; ++refinement) {
    solution.usable = MeasureTraceError(cost, tolerance, solution);
    if (solution.trace_error <= max_error || refinement == kMaxTraceRefinements) break;
    tolerance = FinerTolerance(tolerance);
    cost.set_tolerance(tolerance);
    solution = Continue(cost, solution, problem.solve);
  }
  return attempt;
}

/// Whether a search ended at a local minimum, and not because of one of its limits.
bool IsAtLocalMinimum(const Attempt& attempt) {
  constexpr double kNear = 1, kNearDiscontinuity = 3;  // standard errors
  if (!attempt.solution.usable) return false;
  const std::optional<Optimum> optimum = Linearize(attempt.problem->solve, *attempt.cost, attempt.solution);
  return optimum && optimum->inverse.identifiable &&
         RemainingShift(*optimum) < (HasDiscontinuities(*attempt.problem) ? kNearDiscontinuity : kNear);
}

/// Stores the better of two attempts in `best`, and the local minimum of the worse one in best.alternatives.
void KeepBetter(Attempt other, Attempt& best) {
  if (IsBetter(other, best)) {
    other.alternatives = std::move(best.alternatives);
    std::swap(best, other);
  }
  if (IsAtLocalMinimum(other)) best.alternatives.push_back(MinimumOf(other));
}

}  // namespace

Result<Attempt> SolveFromOneStart(const Recording& recording, const FitOptions& options) {
  ASSIGN_OR_RETURN(FitProblem problem, MakeFitProblem(recording, options));
  return SolveProblem(std::move(problem), options);
}

AlternativeMinimum MinimumOf(const Attempt& attempt) {
  const Solution& solution = attempt.solution;
  return {solution.parameters, solution.log_likelihood, attempt.cost->PriorSum(solution.parameters)};
}

double LogPosterior(const Attempt& attempt) { return MinimumOf(attempt).log_posterior(); }

bool IsBetter(const Attempt& a, const Attempt& b) {
  return a.solution.usable && (!b.solution.usable || LogPosterior(a) > LogPosterior(b));
}

Result<Attempt> MakeAttempt(const Recording& recording, const FitOptions& options) {
  ASSIGN_OR_RETURN(FitProblem problem, MakeFitProblem(recording, options));
  Attempt best = SolveProblem(std::move(problem), options);
  FitOptions other = options;
  const std::size_t starts = best.problem->sensor_starts;
  for (other.search.sensor_start = 1; other.search.sensor_start < starts; ++other.search.sensor_start) {
    if (Result<Attempt> attempt = SolveFromOneStart(recording, other)) KeepBetter(*std::move(attempt), best);
  }
  if (!best.solution.usable) return best;
  if (std::optional<std::vector<double>> image = MirrorImage(*best.problem, best.solution.parameters)) {
    FitProblem mirrored = *best.problem;
    mirrored.first_guess = *std::move(image);
    KeepBetter(SolveProblem(std::move(mirrored), options), best);
  }
  return best;
}

}  // namespace pendulum
