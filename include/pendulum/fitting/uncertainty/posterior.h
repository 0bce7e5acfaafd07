// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// A linearized fit to quantized readings: the model is readings + jacobian · δ. δ is the difference of the F free
/// parameters from their fitted values. N samples; rad or rad/s.
struct LinearizedFit {
  Eigen::VectorXd value, readings;           ///< N x 1, measured, and modelled at δ = 0.
  Eigen::MatrixXd jacobian;                  ///< N x F, ∂readings/∂δ; F >= 1.
  NoiseModel noise;                          ///< Quantized; its σ is only the start of the sampling.
  Eigen::VectorXd lower, upper;              ///< F x 1, lower <= 0 <= upper, lower < upper; may be infinite.
  Eigen::VectorXd prior_mean, prior_weight;  ///< F x 1, of normal priors on δ; 1 / standard deviation, 0 = none.
};

/// Posterior of F parameters and σ. Parameters have the units of δ; σ has the unit of the readings.
struct Posterior {
  Eigen::VectorXd mean, lower95, upper95;  ///< F x 1, of δ: mean, quantiles .025 and .975.
  Eigen::MatrixXd covariance;              ///< F x F
  double sigma = 0, sigma_std_dev = 0;     ///< Mean and standard deviation of σ.
  Eigen::MatrixXd draws;                   ///< R x (F + 1), δ and σ: for the posterior of derived quantities.
  double effective_draws = 0;  ///< Equivalent number of independent draws for the least certain mean, of δ or of σ.
};

/// Draws from the posterior of δ and σ given quantized readings (MODEL.md eq. (7.1)), for noise so small that the
/// posterior is not normal.
///
/// Prior: flat in δ within the bounds, times the normal priors; flat in σ on (0, 2q]. Uses slice sampling (R. M. Neal,
/// Ann. Stat. 31:705, 2003) until there are 500 effective draws, which give means to 5 % of a standard deviation. It
/// ends earlier after 1e9 evaluated samples (5 s): see effective_draws. The same seed gives the same numbers.
///
/// kInvalidArgument: sizes that disagree, numbers that are not finite, noise that is not quantized or has no
/// resolution, δ = 0 out of bounds. kFailedPrecondition: neither the readings nor the priors determine a combination of
/// the parameters. kTryAgain: a stop was requested. Cost: 0.2 s for 2000 samples and 7 parameters.
Result<Posterior> SamplePosterior(const LinearizedFit& fit, std::uint64_t seed, const std::stop_token& stop = {});

}  // namespace pendulum
