// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Estimates from simulated repetitions of a recording, for bootstrap intervals.
struct Bootstrap {
  Eigen::MatrixXd estimates;  ///< B x P, the problem's units; one row per solved replica.
  int failed = 0;

  /// The quantile of parameter k's estimates, by linear interpolation between order statistics.
  double Quantile(int k, double probability) const;
};

/// Refits kBootstrapFits replicas: the fitted readings plus new noise, rounded and clipped like the sensor's readings.
/// Independent Gaussian or quantized noise is drawn from its model. Autocorrelated residuals, and those of a robust
/// family, are resampled in circular blocks (Politis & Romano 1992). quantile_residuals: N. Runs on options.threads
/// threads; the result depends only on the seed. After a stop request the remaining replicas count as failed.
Bootstrap RunBootstrap(const FitProblem& problem, const FitOptions& options, const Solution& solution,
                       const Eigen::VectorXd& quantile_residuals, const Autocorrelation& correlation);

inline constexpr int kBootstrapFits = 999;

}  // namespace pendulum
