// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/solve.h"

namespace pendulum {

/// Where a search begins when these parameters (P) are fixed, their values included.
using StartGuess = std::function<std::vector<double>(const std::vector<bool>& fixed)>;

/// Solves over all samples from where `from` ended, and goes on to the neighbouring minima, on both sides along the
/// profile of dry friction, where the pendulum comes to rest.
Solution Refine(LeastSquares& cost, const Solution& from, const SolveOptions& options);

/// Looks for the lowest of several minima over a whole recording, from start values that may be rough: over growing
/// parts of it, to either side where it reaches rest, and over the simpler laws within the friction law, so that a law
/// ends no higher than they do. No promise: budgets end it.
Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const StartGuess& guess, const SolveOptions& options);

}  // namespace pendulum
