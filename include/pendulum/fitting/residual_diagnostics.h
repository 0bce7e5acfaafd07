// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// Measures of the fit. N samples, k = free parameters + 1 for sigma.
struct FitStatistics {
  double rms_residual = 0;  ///< sqrt(RSS / N), rad or rad/s
  double log_likelihood =
      0;            ///< Gaussian, at the maximum-likelihood sigma; densities times the resolution (or 1 rad, 1 rad/s).
  double aic = 0;   ///< 2 k - 2 log L
  double aicc = 0;  ///< AIC + 2 k (k + 1) / (N - k - 1) (Hurvich & Tsai, Biometrika 76:297, 1989)
  double bic = 0;   ///< k ln N - 2 log L
  double durbin_watson = 0;  ///< Σ (r_i - r_{i-1})² / Σ r_i²
};

/// Correlation of each residual with the next, Σ r_i r_{i-1} / Σ r_i²; 0 for residuals that are all 0.
double Lag1Correlation(const Eigen::VectorXd& residual);

/// Whether residuals follow each other, against independence: Box and Pierce's portmanteau N Σ ρ_k² over at most 50
/// lags k from 1 to longest_lag, spaced as squares, is six standard deviations above its mean (Box & Pierce, JASA
/// 65:1509, 1970), which independent residuals reach in 2e-6 of all cases. Noise that remembers shows at the first
/// lags, a misfit that swings with the pendulum at some lag within one period.
bool FollowEachOther(const Eigen::VectorXd& residual, int longest_lag);

/// Whether residuals swing along with the pendulum, against independence (MODEL.md eq. (25)): the model's errors of
/// phase and amplitude from period to period [s] exceed what independent residuals give in 2e-4 of all cases. N
/// samples.
bool SwingAlong(const Eigen::VectorXd& time, const Eigen::VectorXd& fitted, const Eigen::VectorXd& residual,
                double period);

/// Statistics of N residuals [rad or rad/s] of a fit with that many free parameters. resolution: same unit, 0 for none.
FitStatistics ComputeStatistics(const Eigen::VectorXd& residual, int free_parameters, double resolution);

}  // namespace pendulum
