// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// The memory of residuals: a stationary process z of mean 0 and variance 1.
struct Autocorrelation {
  enum class Kind {
    kWhite,
    kAutoregressive,  ///< AR(p): z_t = Σ φ_j z_{t-j} + e_t, one sample an interval.
    kMixed,           ///< ARMA(1,1): z_t = φ z_{t-1} + e_t + θ e_{t-1}; among them AR(1) under white noise.
    kContinuous,      ///< ρ(Δt) = (1 - s) exp(-Δt / τ) for Δt > 0, at any stamps.
  };
  Kind kind = Kind::kWhite;
  std::vector<double> autoregressive;  ///< φ_1..φ_p, of a stationary process; p = 1 for kMixed.
  double moving_average = 0;           ///< θ of kMixed, |θ| < 1
  double innovation_variance = 1;      ///< of e, for z of variance 1
  double interval = 0;                 ///< s, between samples: of the clock; the mean one for kContinuous
  double decay_time = 0;               ///< τ of kContinuous, s
  double white_share = 0;              ///< s of kContinuous: of the variance, what the next sample has forgotten

  /// "white", "AR(3)", "ARMA(1,1)", "continuous AR(1)", "continuous AR(1) + white".
  std::string Name() const;

  /// 1 + 2 Σ ρ_k and 1 + 2 Σ ρ_k²: variance of many samples' mean, and variance, over that of independent ones.
  double VarianceInflation() const;
  double SquaredInflation() const;
};

/// A step beyond this many intervals is a gap in the clock, not jitter.
inline constexpr double kGapIntervals = 1.5;

/// The meat of a sandwich covariance, W' R W with R the N x N correlations of z at these times: the covariance of W'z.
/// A gap in an even clock is so many samples that were not taken. Costs O(N K (K + p)) and O(K²) memory.
/// time N x 1, s, increasing.  weights N x K.  Returns K x K, in the unit of weights squared, never indefinite.
Eigen::MatrixXd CorrelatedSum(const Autocorrelation& correlation, const Eigen::VectorXd& time,
                              const Eigen::MatrixXd& weights);

}  // namespace pendulum
