// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Estimates from recordings that the fit itself could have given.
struct Bootstrap {
  Eigen::MatrixXd estimates;  ///< B x P, the problem's units; rows of those that could be solved.
  int failed = 0;

  /// The quantile of parameter k's estimates, by linear interpolation between order statistics.
  double Quantile(int k, double probability) const;
};

/// Refits of kBootstrapFits recordings: the fitted readings with new noise, rounded and cut as the sensor does.
/// Independent Gaussian or quantized noise is drawn from its model; residuals that remember, and those of a robust
/// family, are resampled in circular blocks (Politis & Romano 1992). quantile_residuals: N. Runs on options.threads
/// threads; the same for a seed whatever their number. Once options.stop is requested the others count as failed.
Bootstrap RunBootstrap(const FitProblem& problem, const FitOptions& options, const Solution& solution,
                       const Eigen::VectorXd& quantile_residuals, const Autocorrelation& correlation);

inline constexpr int kBootstrapFits = 999;

}  // namespace pendulum
