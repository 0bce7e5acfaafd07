// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/escape_discontinuities.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Estimates σ and the likelihood again, beginning with the noise at the start of a search.
void ReestimateSigma(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options, Solution& solution) {
  cost.set_noise(problem.noise);
  solution.usable = cost.SumOfSquares(solution.parameters, &solution.sum);
  for (Minimum& minimum : solution.other_minima) {
    if (!cost.SumOfSquares(minimum.parameters, &minimum.sum)) minimum.sum = std::numeric_limits<double>::infinity();
  }
  MaximizeLikelihood(cost, problem, options, solution);
}

/// The result of a solve that starts beyond the jump. Returns std::nullopt if there is no jump or no better solution.
std::optional<Solution> SolveBeyondDiscontinuity(TrajectoryCost& cost, const FitProblem& problem,
                                                 const Solution& solution) {
  const std::optional<Optimum> optimum = Linearize(problem.solve, cost, solution);
  if (!optimum || !optimum->inverse.identifiable || RemainingShift(*optimum) <= kLargestShift) return std::nullopt;
  auto lower = FindLowerAlongNewtonStep(*optimum, problem.solve, cost, solution);
  if (!lower) return std::nullopt;
  Solution across = solution;
  across.parameters = *std::move(lower);
  across = Continue(cost, across, problem.solve);
  if (!across.usable || !(across.sum < solution.sum)) return std::nullopt;
  if (!cost.Readings(across.parameters, &across.readings, nullptr)) return std::nullopt;
  across.log_likelihood = LogLikelihoodOf(problem, across);
  return across;
}

}  // namespace

bool HasDiscontinuities(const FitProblem& problem) {
  return problem.data.quantity == Quantity::kAcceleration && problem.solve.holding_parameter >= 0;
}

bool JumpsAt(const FitProblem& problem, const TrajectoryCost& cost, const std::vector<double>& parameters) {
  if (HasDiscontinuities(problem)) return true;
  return problem.solve.holding_parameter >= 0 && cost.Trace(parameters).stop_time < problem.data.time.back();
}

std::optional<std::vector<double>> FindLowerAlongNewtonStep(const Optimum& optimum, const SolveOptions& options,
                                                            const LeastSquares& cost, const Solution& solution) {
  double least = 0;
  if (!cost.SumOfSquares(solution.parameters, &least)) return std::nullopt;
  const Eigen::VectorXd step = -(optimum.inverse.matrix * optimum.gradient(optimum.free));
  const double length = RemainingShift(optimum);  // standard errors
  for (double share = 1;; share *= 0.5) {
    std::vector<double> there = solution.parameters;
    for (Index k = 0; k < step.size(); ++k) {
      const auto i = static_cast<std::size_t>(optimum.free[static_cast<std::size_t>(k)]);
      there[i] = std::clamp(there[i] + share * step[k], options.lower[i], options.upper[i]);
    }
    double sum = 0;
    if (cost.SumOfSquares(there, &sum) && sum < least) return there;
    if (!(share * length > kLargestShift)) return std::nullopt;
  }
}

void EscapeDiscontinuities(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options,
                           Solution& solution) {
  constexpr int kMaxEscapes = 10;
  if (!solution.usable || !JumpsAt(problem, cost, solution.parameters)) return;
  bool has_moved = false;
  for (int escape = 0; escape < kMaxEscapes; ++escape) {
    std::optional<Solution> across = SolveBeyondDiscontinuity(cost, problem, solution);
    if (!across) break;
    solution = *std::move(across);
    has_moved = true;
  }
  if (!has_moved) return;
  Solution reestimated = solution;
  ReestimateSigma(cost, problem, options, reestimated);
  if (reestimated.usable) {
    solution = std::move(reestimated);
  } else {
    cost.set_noise(solution.noise);
  }
}

}  // namespace pendulum
