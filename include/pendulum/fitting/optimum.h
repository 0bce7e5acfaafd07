// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/autocorrelation.h"
#include "pendulum/fitting/covariance.h"
#include "pendulum/fitting/fit_problem.h"

namespace pendulum {

/// The likelihood around a solution, in the problem's units, and what is free there.
struct Optimum {
  Eigen::MatrixXd information;  ///< P x P, observed, priors included.
  Eigen::VectorXd gradient;     ///< P, of minus the log-likelihood.
  std::vector<int> free;        ///< F parameters that are neither fixed nor at a bound.
  std::vector<int> at_bound;    ///< Those at a bound that the likelihood pushes outwards.
  InformationInverse inverse;   ///< Of the information, over free.
};

/// Nothing when the trajectory cannot be traced.
std::optional<Optimum> Linearize(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution);

/// Derivatives of the readings by the free parameters, N x F; no rows when the trajectory cannot be traced.
Eigen::MatrixXd FreeJacobian(const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum);

/// Length of the Newton step that is left, in standard errors (its square is twice the expected gain of log L).
double RemainingShift(const Optimum& optimum);

/// Errors of the free parameters, and how they were obtained.
struct Errors {
  Eigen::MatrixXd covariance;    ///< F x F
  std::optional<double> sigma;   ///< Standard error of σ, rad or rad/s.
  Eigen::VectorXd t95;           ///< F, Student's t of N_k - F degrees of freedom, N_k / N as naive / true variance.
  double effective_samples = 0;  ///< N over the variance inflation 1 + 2 Σ ρ_k, at most N.
  std::string method;
};

/// The covariance of the free parameters: the inverse of the observed information of parameters and log σ, and for a
/// robust family or residuals that remember a sandwich of it (MODEL.md eq. (18), (28) to (30)).
Errors ComputeErrors(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                     const Optimum& optimum, const Autocorrelation& correlation);

}  // namespace pendulum
