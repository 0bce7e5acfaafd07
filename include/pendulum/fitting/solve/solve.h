// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "pendulum/fitting/likelihood/least_squares.h"
#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// What may move, and how far.
struct SolveOptions {
  std::vector<double> lower, upper;  ///< P; -kUnbounded and kUnbounded where there is no bound.
  std::vector<bool> fixed;           ///< P
  int holding_parameter = -1;        ///< The parameter that keeps the pendulum at rest (dry friction); -1: none.
  int last_friction = 1;             ///< The last parameter of friction; the first is 1, behind inertia.
  int release_time = -1;             ///< -1: the recording begins in motion.
  std::vector<int> late;             ///< Parameters that only small swings tell: held while the last part is left out.
  int max_iterations = 100;          ///< Of Ceres, for each run.
  int max_traces = std::numeric_limits<int>::max();  ///< LeastSquares::traces() at which no further run is begun.
};

/// |r|² at P parameters where a search ended, as in Solution.
struct Minimum {
  std::vector<double> parameters;
  double sum = 0;
};

/// A least-squares solution and what the solver did to reach it.
struct Solution {
  std::vector<double> parameters;  ///< P, the cost's units.
  double sum = 0;                  ///< |r|², the deviance under the cost's noise.
  bool usable = false;             ///< False when the trajectory cannot be traced at the parameters.
  int iterations = 0;
  std::string message;
  NoiseModel noise;  ///< Set by MaximizeLikelihood, as are the next two.
  std::string noise_reason;
  double log_likelihood = 0;          ///< Probability per sample; a density is multiplied with the resolution (or 1).
  Eigen::VectorXd readings;           ///< N x 1, the model's, rad or rad/s; set by FitRecording.
  double trace_error = 0;             ///< Largest difference of readings to a hundredth of the tolerance; likewise.
  std::vector<Minimum> other_minima;  ///< Found by Search beside this one, none lower; this one may be among them.
};

/// Where parameter i stands at a value: -1 at its lower bound or below, 1 at its upper bound or above, 0 between.
int BoundSide(const SolveOptions& options, std::size_t i, double value);

/// |gradient_i| / sqrt(information_ii) below which a step along parameter i alone would take away less than 1e-10 of
/// |r|², from LeastSquares' sums: a solve may leave as much.
double NegligibleSlope(const Eigen::MatrixXd& sums);

/// Levenberg-Marquardt (Ceres) from `start` over the samples the cost uses; parameters stay within their bounds. Ends
/// when the cost, not owned, changes by less than 1e-10 of itself, or would with the next step: estimates within
/// sqrt(1e-10 N) standard errors.
Solution Solve(LeastSquares& cost, const std::vector<double>& start, const SolveOptions& options);

/// Solve from where `from` ended; the work of both is counted, its other minima are kept.
Solution Continue(LeastSquares& cost, const Solution& from, const SolveOptions& options);

}  // namespace pendulum
