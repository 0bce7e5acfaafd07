// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// Whether the sum of squares has jumps: the acceleration jumps when dry friction changes its side, and with it the sum
/// each time such an instant passes a sample. It is least beside a jump, where its slope is not 0.
bool HasJumps(const FitProblem& problem);

/// Where along the Newton step that is left, within the bounds, the sum of squares is less than at the solution:
/// the whole step, or half of it and so on down to kLargestShift standard errors. Nothing where it is nowhere.
std::optional<std::vector<double>> LowerAlongShift(const Optimum& optimum, const SolveOptions& options,
                                                   const LeastSquares& cost, const Solution& solution);

/// Goes on where jumps have stopped the solver, and finds σ again. A solution is left only for a better one.
void CrossJumps(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options, Solution& solution);

}  // namespace pendulum
