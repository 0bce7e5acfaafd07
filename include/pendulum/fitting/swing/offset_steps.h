// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// A step of the zero: from `sample` on, the readings are higher by `size` than before. Unit of the readings.
struct OffsetStep {
  Eigen::Index sample = 0;
  double size = 0, std_error = 0;
};

/// The residuals of a fit to N readings, and their derivatives with respect to its P parameters.
struct FitResiduals {
  Eigen::VectorXd time;      ///< N x 1, s, increasing
  Eigen::VectorXd residual;  ///< N x 1, rad or rad/s
  Eigen::VectorXd rate;      ///< N x 1, rad/s or rad/s^2: of the modelled reading
  Eigen::MatrixXd jacobian;  ///< N x P, derivatives of the readings, any units; the last column is the zero's
  double period = 0;         ///< s, of a small swing
};

/// Steps in residuals that autocorrelation does not explain (MODEL.md eq. (13.1)), in time order, at most `max_steps`.
/// Each step raises the likelihood of an autoregression around the fit by at least e^18. It must also raise it by more
/// than a drifting zero, a spike, a kink, a touched pendulum or a clock slip would. Alternatively, all steps together
/// leave white noise.
std::vector<OffsetStep> FindOffsetSteps(const FitResiduals& residuals, int max_steps, const std::stop_token& stop = {});

}  // namespace pendulum
