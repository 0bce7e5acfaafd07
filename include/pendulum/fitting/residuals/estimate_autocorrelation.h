// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// The memory of standardized residuals, of the order that Schwarz's criterion prefers (Ann. Stat. 6:461, 1978). Even
/// stamps, with gaps or without: white, AR(p) by Burg's method, or ARMA(1,1) of the greatest likelihood. Uneven stamps,
/// or stretches too short for that: white, or the continuous AR(1), with white noise over it or without. The restricted
/// likelihood (Patterson & Thompson, Biometrika 58:545, 1971) refines all but AR(p > 1). time N x 1, s, increasing.
/// residual N x 1, of about unit variance (any scale gives the same correlations). weights N x K, the residuals'
/// derivatives by the parameters; K = 0 for residuals of no fit. Fewer than 30, or all 0, are white. Once a stop is
/// requested it ends soon, with a memory that means nothing.
Autocorrelation EstimateAutocorrelation(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& weights, const std::stop_token& stop = {});

/// The same for quantile residuals z of readings with that noise. jacobian N x K, the readings' derivatives by all
/// fitted parameters.
Autocorrelation EstimateAutocorrelation(const NoiseModel& noise, const Eigen::VectorXd& time, const Eigen::VectorXd& z,
                                        const Eigen::MatrixXd& jacobian, const std::stop_token& stop = {});

/// Whether residuals of unit variance may be correlated: the Ljung-Box test has p <= 0.05.
bool MayBeCorrelated(const Eigen::VectorXd& z);

}  // namespace pendulum
