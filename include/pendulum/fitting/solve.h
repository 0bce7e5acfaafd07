// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/fitting/trajectory_cost.h"

namespace pendulum {

/// What may move, and how far.
struct SolveOptions {
  std::vector<double> lower;   ///< P; -kUnbounded where there is no bound.
  std::vector<bool> fixed;     ///< P
  int holding_parameter = -1;  ///< The parameter that keeps the pendulum at rest (dry friction); -1: none.
  int max_iterations = 100;
};

/// A minimum that was found beside the lowest.
struct Rival {
  std::vector<double> parameters;  ///< P
  double sum = 0;                  ///< |r|², in units of the cost's scale²
};

/// A least-squares solution and what the solver did to reach it.
struct Solution {
  std::vector<double> parameters;  ///< P, TrajectoryCost's units.
  double sum = 0;                  ///< |r|², in units of the cost's scale².
  bool usable = false;             ///< False when the trajectory could not be traced at the start values.
  bool converged = false;          ///< Ceres' own verdict.
  int iterations = 0;
  int evaluations = 0;
  std::string message;        ///< Ceres' own words.
  Eigen::VectorXd readings;   ///< N x 1, the model's, rad or rad/s; set by FitRecording.
  double trace_error = 0;     ///< Largest difference of readings to those at a hundredth of the tolerance; likewise.
  std::vector<Rival> rivals;  ///< Where the neighbouring starts of Search ended; the same minimum may be among them.
};

/// Levenberg-Marquardt (Ceres) from `start` over all samples the cost uses; parameters stay at or above their bounds.
///
/// An active-set method: a parameter whose step lands on its bound is held there while the others go on, and let go
/// again when the cost pulls it inwards at their optimum. Each run stops when the cost changes by less than 1e-10 of
/// itself, which leaves the estimates within some 1e-3 standard errors. `cost` is not owned.
Solution Solve(TrajectoryCost& cost, const std::vector<double>& start, const SolveOptions& options);

/// Solve from where `from` ended; the work of both is counted, its rivals are kept.
Solution Continue(TrajectoryCost& cost, const Solution& from, const SolveOptions& options);

/// Solve for a whole recording from start values that may be rough, and where there are several minima.
///
/// A start that explains the data goes straight to Solve. One that does not is refined over the first three cycles,
/// then over twice as many, and so on. Recordings that reach rest have one minimum per number of half swings before the
/// stop, so they are fitted over 30, 60 and 85 % of the motion first; then dry friction is shifted to either side, the
/// other parameters following along its profile, until the number of reversals changes, and the fit goes on from there
/// as long as the cost is lower.
Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const std::vector<double>& start,
                const SolveOptions& options);

}  // namespace pendulum
