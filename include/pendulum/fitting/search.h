// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pendulum/fitting/solve.h"

namespace pendulum {

/// Where a search begins when these parameters (P) are fixed, their values included.
using StartGuess = std::function<std::vector<double>(const std::vector<bool>& fixed)>;

/// Looks for the lowest of several minima over a whole recording, from start values that may be rough.
///
/// A start that explains the data goes straight to Solve. One that does not is refined over the first three cycles,
/// then over twice as many, and so on. Recordings that reach rest have one minimum per number of half swings before the
/// stop, so they are fitted over 30, 60 and 85 % of the motion first; then dry friction is shifted to either side, the
/// other parameters following along its profile, until the number of reversals changes, and the fit goes on from there
/// as long as the cost is lower. Where the pendulum comes to rest, or the result explains less than nine tenths
/// of the variance, each friction parameter in turn is also held at its bound in a search and then let go, for a law
/// should end no higher than the simpler laws within it. No promise: each stage ends after so many trajectories.
Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const StartGuess& guess, const SolveOptions& options);

/// Whether a solution leaves at most a tenth of the readings' variance.
bool Explains(const TrajectoryData& data, const Solution& solution);

}  // namespace pendulum
