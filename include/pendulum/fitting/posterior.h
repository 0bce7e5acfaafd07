// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/noise.h"

namespace pendulum {

/// A fit to rounded readings, its trajectory made linear: the model says readings + jacobian · δ, where δ is how far
/// the F free parameters are from their fitted values. N samples; rad or rad/s.
struct LinearizedFit {
  Eigen::VectorXd value;         ///< N x 1, measured.
  Eigen::VectorXd readings;      ///< N x 1, modelled at δ = 0.
  Eigen::MatrixXd jacobian;      ///< N x F, ∂readings/∂δ; F >= 1.
  NoiseModel noise;              ///< Quantized. Its σ is where the draws begin and does not matter otherwise.
  Eigen::VectorXd lower;         ///< F x 1, lower <= 0; may be infinite.
  Eigen::VectorXd upper;         ///< F x 1, upper >= 0, upper > lower; may be infinite.
  Eigen::VectorXd prior_mean;    ///< F x 1, of normal priors on δ.
  Eigen::VectorXd prior_weight;  ///< F x 1, 1 / their standard deviations; 0 = none.
};

/// What the readings leave possible of F parameters and σ. Units: those of δ, and of the readings.
struct Posterior {
  Eigen::VectorXd mean;        ///< F x 1, of δ.
  Eigen::VectorXd lower95;     ///< F x 1, its quantile .025
  Eigen::VectorXd upper95;     ///< F x 1, and .975.
  Eigen::MatrixXd covariance;  ///< F x F
  double sigma = 0;            ///< Mean of σ.
  double sigma_std_dev = 0;
  Eigen::MatrixXd draws;       ///< R x (F + 1), δ and σ: for the posterior of whatever follows from them.
  double effective_draws = 0;  ///< As many independent draws say as much of the worst-known mean, of δ or of σ.
};

/// Draws from the posterior of δ and σ given rounded readings (MODEL.md eq. (26)), for readings so quiet that it is no
/// normal distribution: without noise it is uniform on the polytope of the δ that every reading allows, and its width
/// falls as 1/N. Prior: flat in δ within the bounds, times the normal ones; flat in σ on (0, 2q].
///
/// Slice sampling (R. M. Neal, Ann. Stat. 31:705, 2003) along orthogonal directions, turned at random before every
/// round, of coordinates in which earlier draws are white; then along log σ. Ends at 500 effective draws (C. J. Geyer's
/// initial monotone sequence, Stat. Sci. 7:473, 1992): means are good to 5 % of a standard deviation. It also ends when
/// 1e9 samples have been looked at, which takes 5 s and is little for 1e5 samples with a σ that leaves few of them
/// certain (the posterior is then normal, and need not be sampled): see effective_draws.
///
/// kInvalidArgument: sizes that disagree, numbers that are not finite, noise that is not quantized or has no
/// resolution, δ = 0 out of bounds. kFailedPrecondition: a combination of the parameters leaves no trace in the
/// readings or the priors. The same seed gives the same numbers. 2000 samples, 7 parameters: 0.2 s.
Result<Posterior> SamplePosterior(const LinearizedFit& fit, std::uint64_t seed);

}  // namespace pendulum
