// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// One recording's part in a fit of one or several.
struct FittedRun {
  const FitProblem& problem;
  const TrajectoryCost& cost;
  const Solution& solution;            ///< Its own P parameters and noise.
  const Autocorrelation& correlation;  ///< Of its residuals.
  std::vector<int> at;                 ///< P: where its parameters stand among those of the fit.
};

/// What is known of a recording's noise besides.
struct NoiseErrors {
  std::optional<double> sigma;   ///< Standard error of σ, rad or rad/s.
  double effective_samples = 0;  ///< N over the variance inflation 1 + 2 Σ ρ_k, at most N.
  std::string method;            ///< How its part in the covariance was obtained.
};

/// Errors of the F free parameters of a fit.
struct Errors {
  Eigen::MatrixXd covariance;     ///< F x F
  Eigen::VectorXd t95;            ///< F, Student's t of N_k - F degrees of freedom, N_k / N as naive / true variance.
  std::vector<NoiseErrors> runs;  ///< One for each recording.
};

/// The covariance of the free parameters: the inverse of the observed information of parameters and log σ, and for a
/// robust family or residuals that remember a sandwich of it (MODEL.md eq. (18), (28) to (30)); of several recordings
/// from the sums of both (eq. (57)).
Errors ComputeErrors(std::span<const FittedRun> runs, std::span<const PriorTerm> priors, const Optimum& optimum);

/// Of one recording.
Errors ComputeErrors(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                     const Optimum& optimum, const Autocorrelation& correlation);

}  // namespace pendulum
