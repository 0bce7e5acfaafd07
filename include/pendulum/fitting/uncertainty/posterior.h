// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// A fit to rounded readings, made linear: the model says readings + jacobian · δ, δ being how far the F free
/// parameters are from their fitted values. N samples; rad or rad/s.
struct LinearizedFit {
  Eigen::VectorXd value, readings;  ///< N x 1, measured, and modelled at δ = 0.
  Eigen::MatrixXd jacobian;         ///< N x F, ∂readings/∂δ; F >= 1.
  NoiseModel noise;                 ///< Quantized; its σ is where the draws begin, and does not matter otherwise.
  Eigen::VectorXd lower, upper;     ///< F x 1, lower <= 0 <= upper, lower < upper; may be infinite.
  Eigen::VectorXd prior_mean, prior_weight;  ///< F x 1, of normal priors on δ; 1 / standard deviation, 0 = none.
};

/// What the readings leave possible of F parameters and σ. Units: those of δ, and of the readings.
struct Posterior {
  Eigen::VectorXd mean, lower95, upper95;  ///< F x 1, of δ; its quantiles .025 and .975.
  Eigen::MatrixXd covariance;              ///< F x F
  double sigma = 0, sigma_std_dev = 0;     ///< Mean and standard deviation of σ.
  Eigen::MatrixXd draws;                   ///< R x (F + 1), δ and σ: for the posterior of whatever follows from them.
  double effective_draws = 0;  ///< As many independent draws say as much of the worst-known mean, of δ or of σ.
};

/// Draws from the posterior of δ and σ given rounded readings (MODEL.md eq. (26)), for readings so quiet that it is no
/// normal distribution. Prior: flat in δ within the bounds, times the normal ones; flat in σ on (0, 2q]. Slice sampling
/// (R. M. Neal, Ann. Stat. 31:705, 2003) until 500 effective draws make means good to 5 % of a standard deviation, or
/// 1e9 samples have been looked at (5 s): see effective_draws. kInvalidArgument: sizes that disagree, numbers that are
/// not finite, noise that is not quantized or has no resolution, δ = 0 out of bounds. kFailedPrecondition: a
/// combination of the parameters leaves no trace in the readings or the priors. kTryAgain: a stop was requested. The
/// same seed gives the same numbers. 2000 samples, 7 parameters: 0.2 s.
Result<Posterior> SamplePosterior(const LinearizedFit& fit, std::uint64_t seed, const std::stop_token& stop = {});

}  // namespace pendulum
