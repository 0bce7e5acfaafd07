// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pendulum/fitting/solve.h"

namespace pendulum {

/// Where a search begins when these parameters (P) are fixed, their values included.
using StartGuess = std::function<std::vector<double>(const std::vector<bool>& fixed)>;

/// Looks for the lowest of several minima over a whole recording, from start values that may be rough: over the first
/// three cycles, then twice as many and so on, unless the start explains the data. A recording that reaches rest has a
/// minimum per number of half swings before the stop: it is fitted over 30, 60 and 85 % of the motion first, then dry
/// friction is shifted along its profile to either side as long as that lowers the cost, and each friction parameter is
/// held at its bound in a search and let go, so that a law ends no higher than the simpler ones within it. No promise:
/// budgets end it.
Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const StartGuess& guess, const SolveOptions& options);

}  // namespace pendulum
