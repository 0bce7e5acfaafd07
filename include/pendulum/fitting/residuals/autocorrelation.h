// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Autocorrelation of residuals: a stationary process z with mean 0 and variance 1.
struct Autocorrelation {
  enum class Kind {
    kWhite,
    kAutoregressive,  ///< AR(p): z_t = Σ φ_j z_{t-j} + e_t, one sample per interval.
    kMixed,           ///< ARMA(1,1): z_t = φ z_{t-1} + e_t + θ e_{t-1}; includes AR(1) plus white noise.
    kContinuous,      ///< ρ(Δt) = (1 - s) exp(-Δt / τ) for Δt > 0, at any time stamps.
  };
  Kind kind = Kind::kWhite;
  std::vector<double> autoregressive;  ///< φ_1..φ_p of a stationary process; p = 1 for kMixed.
  double moving_average = 0;           ///< θ of kMixed, |θ| < 1
  double innovation_variance = 1;      ///< Variance of e if z has variance 1.
  double interval = 0;                 ///< s, between samples of an even clock; the mean interval for kContinuous
  double decay_time = 0;               ///< τ of kContinuous, s
  double white_share = 0;              ///< s of kContinuous: share of the variance that is white noise

  /// "white", "AR(3)", "ARMA(1,1)", "continuous AR(1)", "continuous AR(1) + white".
  std::string Name() const;

  /// 1 + 2 Σ ρ_k: the factor by which autocorrelation increases the variance of the mean of many samples.
  double VarianceInflation() const;
  /// 1 + 2 Σ ρ_k²: the same factor for the variance of a variance estimated from many samples.
  double SquaredInflation() const;
};

/// A step longer than this many intervals is a gap in the clock, not jitter.
inline constexpr double kGapIntervals = 1.5;

/// The middle factor of a sandwich covariance, W' R W, where R is the N x N correlation matrix of z at these times. It
/// is the covariance of W'z. A gap in an even clock counts as missing samples. Costs O(N K (K + p)) time and O(K²)
/// memory.
/// time N x 1, s, increasing.  weights N x K.  Returns K x K, in the unit of weights squared, positive semidefinite.
Eigen::MatrixXd CorrelatedSum(const Autocorrelation& correlation, const Eigen::VectorXd& time,
                              const Eigen::MatrixXd& weights);

}  // namespace pendulum
