// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/autocorrelation.h"

namespace pendulum {

/// The memory of standardized residuals, of the order that Schwarz's criterion N ln σ_e² + p ln N prefers.
///
/// Even stamps: white, AR(1..p) by Burg's method, or ARMA(1,1) of the greatest likelihood; gaps split the residuals
/// into stretches. Uneven stamps, or stretches too short for that: white, or the continuous AR(1), with white noise
/// over it or without.
///
/// A fit takes of the residuals what its parameters can follow, and so the slowest part of their memory. The
/// likelihood of what parameters cannot follow, the restricted one, gives it back; it refines all but AR(p > 1).
///
/// time       N x 1, s, increasing.
/// residual   N x 1, of about unit variance (any scale gives the same correlations).
/// weights    N x K, the residuals' derivatives by the parameters; K = 0 for residuals of no fit.
/// Fewer than 30 residuals, or residuals that are all 0, are white.
///
/// J. P. Burg, Maximum entropy spectral analysis, 1975; G. Schwarz, Annals of Statistics 6:461, 1978; H. D. Patterson
/// and R. Thompson, Biometrika 58:545, 1971; P. J. Brockwell and R. A. Davis, Time Series: Theory and Methods, section
/// 5.3, 1991.
Autocorrelation EstimateAutocorrelation(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& weights);

}  // namespace pendulum
