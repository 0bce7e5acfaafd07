// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "pendulum/fitting/likelihood/least_squares.h"
#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// The parameters that may change, and how far.
struct SolveOptions {
  std::vector<double> lower, upper;         ///< P; -kUnbounded and kUnbounded without a bound.
  std::vector<bool> fixed;                  ///< P
  int holding_parameter = -1;               ///< The parameter that keeps the pendulum at rest (dry friction); -1: none.
  int last_friction = 1;                    ///< The last parameter of friction; the first is 1, after inertia.
  int release_time = -1;                    ///< Index of the release time; -1: the recording begins in motion.
  std::vector<int> small_swing_parameters;  ///< Held while the last part is left out: only small swings determine them.
  int max_iterations = 100;                 ///< Limit of Ceres iterations for each run.
  int max_traces = std::numeric_limits<int>::max();  ///< LeastSquares::traces() at which no further run starts.
};

/// A local minimum: P parameters and |r|² where a search ended, as in Solution.
struct Minimum {
  std::vector<double> parameters;
  double sum = 0;
};

/// A least-squares solution and what the solver did to reach it.
struct Solution {
  std::vector<double> parameters;  ///< P, the cost's units.
  double sum = 0;                  ///< |r|², the deviance under the cost's noise.
  bool usable = false;             ///< False if the trajectory cannot be computed at these parameters.
  int iterations = 0;
  std::string message;
  NoiseModel noise;  ///< MaximizeLikelihood sets this and the next two members.
  std::string noise_reason;
  double log_likelihood = 0;  ///< Of probabilities; the density of a sample is multiplied by the resolution (or 1).
  Eigen::VectorXd readings;   ///< N x 1, of the model, rad or rad/s; set by FitRecording.
  double trace_error = 0;     ///< Largest change of the readings at a hundredth of the tolerance; set by FitRecording.
  std::vector<Minimum> other_minima;  ///< Other local minima found by Search, none lower; may include this one.
};

/// Position of a value relative to the bounds of parameter i: -1 at or below the lower bound, 1 at or above the upper
/// bound, 0 between.
int BoundSide(const SolveOptions& options, std::size_t i, double value);

/// Limit for |gradient_i| / sqrt(information_ii), from LeastSquares' sums. Below it, a step along parameter i alone
/// reduces |r|² by less than 1e-10 of itself, which is the solver's tolerance.
double NegligibleSlope(const Eigen::MatrixXd& sums);

/// Levenberg-Marquardt (Ceres) from `start` over the samples in use, within the bounds. `cost` is not owned. Ends when
/// the cost changes by less than 1e-10 of itself, or would do so with the next step. Estimates are then within
/// sqrt(1e-10 N) standard errors.
Solution Solve(LeastSquares& cost, const std::vector<double>& start, const SolveOptions& options);

/// Solves from the solution `from`. Adds the iterations of `from`; copies its noise, log-likelihood and other minima.
Solution Continue(LeastSquares& cost, const Solution& from, const SolveOptions& options);

}  // namespace pendulum
