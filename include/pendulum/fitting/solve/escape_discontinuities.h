// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// Whether the sum of squares has jumps. The acceleration jumps when dry friction changes direction, and the sum jumps
/// each time such an instant passes a sample. The minimum then lies next to a jump, where the slope is not 0.
bool HasDiscontinuities(const FitProblem& problem);

/// Searches along the remaining Newton step, within the bounds, for a point with a smaller sum of squares. Tries the
/// whole step, then half of it and so on down to kLargestShift standard errors. Returns std::nullopt if no point is
/// lower.
std::optional<std::vector<double>> FindLowerAlongNewtonStep(const Optimum& optimum, const SolveOptions& options,
                                                            const LeastSquares& cost, const Solution& solution);

/// Continues a solution that jumps have stopped, and estimates σ again. The solution changes only for a better one.
void EscapeDiscontinuities(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options,
                           Solution& solution);

}  // namespace pendulum
