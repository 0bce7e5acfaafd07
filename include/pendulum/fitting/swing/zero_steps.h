// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// A step of the zero: from `sample` on the readings stand higher by `size` than those before. Unit of the readings.
struct ZeroStep {
  Eigen::Index sample = 0;
  double size = 0, std_error = 0;
};

/// What a fit leaves of N readings, and what its P parameters may still take of that.
struct FitResiduals {
  Eigen::VectorXd time;      ///< N x 1, s, increasing
  Eigen::VectorXd residual;  ///< N x 1, rad or rad/s
  Eigen::VectorXd rate;      ///< N x 1, rad/s or rad/s^2: of the modelled reading
  Eigen::MatrixXd jacobian;  ///< N x P, derivatives of the readings, any units; the last column is the zero's
  double period = 0;         ///< s, of a small swing
};

/// Steps in residuals that their memory does not explain (MODEL.md eq. (67)), in time order, `most` at most. Each
/// raises the likelihood of an autoregression about the fit by e^18 and more, and by more than a zero that drifts, a
/// spike, a kink, a pendulum touched at that instant or a clock that slipped would; or all together leave white noise.
std::vector<ZeroStep> FindZeroSteps(const FitResiduals& residuals, int most, const std::stop_token& stop = {});

}  // namespace pendulum
