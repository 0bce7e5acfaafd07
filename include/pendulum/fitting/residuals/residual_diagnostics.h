// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// Goodness of fit. N samples, k = free parameters + 1 for sigma. The tests of independence use quantile residuals.
struct FitStatistics {
  double rms_residual = 0;    ///< sqrt(RSS / N), rad or rad/s
  double log_likelihood = 0;  ///< See Solution; comparable only within one noise family.
  double aic = 0;             ///< 2 k - 2 log L
  double aicc = 0;            ///< AIC + 2 k (k + 1) / (N - k - 1) (Hurvich & Tsai, Biometrika 76:297, 1989)
  double bic = 0;             ///< k ln N - 2 log L
  double durbin_watson = 0;   ///< Σ (z_i - z_{i-1})² / Σ z_i² (Durbin & Watson, Biometrika 37:409, 1950)
  double ljung_box_p = 1, runs_p = 1;
  double effective_samples = 0;  ///< N / (1 + 2 Σ ρ_k), at most N.
};

/// Randomized quantile residuals of N samples (Dunn & Smyth, J. Comp. Graph. Stat. 5:236, 1996). They are standard
/// normal and independent if the model is correct, regardless of quantization. The random numbers are the same in every
/// call.
Eigen::VectorXd QuantileResiduals(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                                  const Eigen::Ref<const Eigen::VectorXd>& readings);

/// Probability that autocorrelations this large arise by chance, over min(20, N/5) lags (Ljung & Box, Biometrika
/// 65:297, 1978).
double LjungBoxP(const Eigen::VectorXd& residual);

/// Two-sided probability that independent residuals change sign this rarely or this often (Wald & Wolfowitz, Ann. Math.
/// Stat. 11:147, 1940); 1 if all residuals have one sign.
double RunsP(const Eigen::VectorXd& residual);

/// Correlation of each residual with the next, Σ r_i r_{i-1} / Σ r_i²; 0 for residuals that are all 0.
double Lag1Correlation(const Eigen::VectorXd& residual);

/// Whether residuals are autocorrelated, tested at up to 50 lags from 1 to longest_lag (Box & Pierce, JASA 65:1509,
/// 1970). False alarm rate for independent residuals: 2e-6.
bool AreAutocorrelated(const Eigen::VectorXd& residual, int longest_lag);

/// Whether the residuals oscillate with the pendulum: the errors of phase and amplitude in each period [s], or their
/// slow changes, exceed the noise (MODEL.md eq. (5.5)). False alarm rate for independent residuals: 2e-4. N samples.
bool HavePhaseOrAmplitudeErrors(const Eigen::VectorXd& time, const Eigen::VectorXd& fitted,
                                const Eigen::VectorXd& residual, double period);

/// Sets AIC, AICc (Hurvich & Tsai, Biometrika 76:297, 1989) and BIC (Schwarz, Ann. Stat. 6:461, 1978) from
/// statistics.log_likelihood. `parameters` includes σ.
void SetInformationCriteria(int parameters, double samples, FitStatistics& statistics);

/// The statistics of N residuals [rad or rad/s] of a fit with `free_parameters`; effective_samples is set to N.
FitStatistics ComputeStatistics(const Eigen::VectorXd& residual, const Eigen::VectorXd& quantile_residual,
                                double log_likelihood, int free_parameters);

}  // namespace pendulum
