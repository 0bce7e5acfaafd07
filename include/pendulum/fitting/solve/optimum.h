// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/least_squares.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/covariance.h"
#include "pendulum/fitting/solve/solve.h"

namespace pendulum {

/// The likelihood around a solution, in the problem's units, and the free parameters there.
struct Optimum {
  Eigen::MatrixXd information;  ///< P x P, observed, priors included.
  Eigen::VectorXd gradient;     ///< P, of minus the log-likelihood.
  std::vector<int> free;        ///< F parameters that are neither fixed nor at a bound.
  std::vector<int> at_bound;    ///< Parameters at a bound beyond which the likelihood would be higher.
  InformationInverse inverse;   ///< Inverse of the information over `free`.
};

/// Returns std::nullopt if the trajectory cannot be computed.
std::optional<Optimum> Linearize(const SolveOptions& options, const LeastSquares& cost, const Solution& solution);

/// The optimum in which the parameters at bounds are free, as a posterior requires, with this information (P x P).
Optimum WithoutBounds(Optimum optimum, const Eigen::MatrixXd& information);

/// Derivatives of the readings with respect to the free parameters, N x F. No rows if there is no trajectory.
Eigen::MatrixXd FreeJacobian(const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum);

/// Length of the remaining Newton step in standard errors. Its square is twice the expected gain of log L.
double RemainingShift(const Optimum& optimum);

/// A solution has converged if its RemainingShift is at most this many standard errors.
inline constexpr double kLargestShift = 0.1;

}  // namespace pendulum
