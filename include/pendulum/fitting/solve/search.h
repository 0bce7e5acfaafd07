// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/solve.h"

namespace pendulum {

/// Returns the start of a search in which the given parameters (P) are fixed, with their fixed values.
using StartGuess = std::function<std::vector<double>(const std::vector<bool>& fixed)>;

/// Solves over all samples, starting from the solution `from`. If the pendulum comes to rest, also visits the
/// neighbouring local minima on both sides along the profile of dry friction.
Solution Refine(LeastSquares& cost, const Solution& from, const SolveOptions& options);

/// Searches for the lowest of several local minima over a whole recording, from start values that may be rough. It fits
/// growing parts of the recording, searches on both sides if the pendulum comes to rest, and tries the simpler laws
/// contained in the friction law. The sum of squares of a law is therefore not significantly larger than that of its
/// simpler laws; where two minima hardly differ, the one is taken at which the readings determine all parameters.
/// The global minimum is not guaranteed: budgets limit the search.
Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const StartGuess& guess, const SolveOptions& options);

}  // namespace pendulum
