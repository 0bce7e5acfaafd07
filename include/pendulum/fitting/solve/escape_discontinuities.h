// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// Whether the sum of squares has jumps. The acceleration jumps when dry friction changes direction. The sum jumps
/// where a change of the parameters moves such an instant past a sample. The minimum may lie at a jump, where the slope
/// is not 0.
bool HasDiscontinuities(const FitProblem& problem);

/// Whether the sum of squares may jump near these parameters: also where the pendulum comes to rest within the
/// recording, because the number of half swings before may change.
bool JumpsAt(const FitProblem& problem, const TrajectoryCost& cost, const std::vector<double>& parameters);

/// Searches along the remaining Newton step, within the bounds, for a point with a smaller sum of squares. Tries the
/// whole step, then half of it and so on down to kLargestShift standard errors. Returns std::nullopt if no point is
/// lower.
std::optional<std::vector<double>> FindLowerAlongNewtonStep(const Optimum& optimum, const SolveOptions& options,
                                                            const LeastSquares& cost, const Solution& solution);

/// Continues from a solution at which a jump has stopped the search, and estimates σ again. The solution is replaced
/// only by a better one.
void EscapeDiscontinuities(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options,
                           Solution& solution);

}  // namespace pendulum
