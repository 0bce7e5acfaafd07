// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"

namespace pendulum {

/// Error estimates of one recording's noise.
struct NoiseErrors {
  std::optional<double> sigma;   ///< Standard error of σ, rad or rad/s.
  double effective_samples = 0;  ///< N divided by the variance inflation 1 + 2 Σ ρ_k, at most N.
  std::string method;            ///< How its contribution to the covariance was computed.
};

/// Errors of the F free parameters of a fit.
struct Errors {
  Eigen::MatrixXd covariance;     ///< F x F
  Eigen::VectorXd t95;            ///< F, Student's t of N_k - F degrees of freedom, N_k / N = naive / true variance.
  std::vector<NoiseErrors> runs;  ///< One for each recording.
};

/// The covariance of the free parameters: the inverse of the observed information of parameters and log σ. For a robust
/// family or autocorrelated residuals it is a sandwich of that inverse (MODEL.md eq. (5.1), (7.3), (7.7), (7.8)). For
/// several recordings both matrices are summed (eq. (10.2)).
Errors ComputeErrors(const SolvedFit& fit, const Optimum& optimum);

/// The part of recording k. own: OwnOptimum of that recording.
Errors OwnErrors(const SolvedFit& fit, std::size_t k, const Optimum& own, const Optimum& optimum, const Errors& errors);

}  // namespace pendulum
