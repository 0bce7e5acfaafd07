// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// Estimates the autocorrelation of standardized residuals, with the order chosen by Schwarz's criterion (Ann. Stat.
/// 6:461, 1978).
///
/// Even time stamps, with or without gaps: white, AR(p) by Burg's method, or ARMA(1,1) by maximum likelihood. Uneven
/// time stamps, or parts too short between gaps: white, or continuous AR(1), with or without added white noise. Except
/// for AR(p > 1), the restricted likelihood (Patterson & Thompson, Biometrika 58:545, 1971) refines the result.
///
/// time      N x 1, s, increasing.
/// residual  N x 1, of about unit variance (any scale gives the same correlations).
/// weights   N x K, derivatives of the residuals with respect to the parameters; K = 0 if they are not from a fit.
/// Fewer than 30 residuals, or only zeros, are reported as white. After a stop request it returns soon; the result is
/// then meaningless.
Autocorrelation EstimateAutocorrelation(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& weights, const std::stop_token& stop = {});

/// Whether white is a candidate. It is excluded if more readings with the same noise have shown an autocorrelation.
enum class Whiteness { kPossible, kExcluded };

/// The same for quantile residuals z of readings with that noise. Rounding hides a known part of the autocorrelation of
/// noise, so that an AR(1) of the noise is one more candidate at even time stamps (MODEL.md section 7, Autocorrelated
/// residuals). jacobian N x K, the readings' derivatives with respect to all fitted parameters.
Autocorrelation EstimateAutocorrelation(const NoiseModel& noise, const Eigen::VectorXd& time, const Eigen::VectorXd& z,
                                        const Eigen::MatrixXd& jacobian, const std::stop_token& stop = {},
                                        Whiteness whiteness = Whiteness::kPossible);

/// Whether residuals of unit variance may be correlated: the Ljung-Box test has p <= 0.05.
bool MayBeCorrelated(const Eigen::VectorXd& z);

}  // namespace pendulum
