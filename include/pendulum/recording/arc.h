// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/base/status.h"

namespace pendulum {

/// The circle on which a tracked point moves, from its coordinates alone. Lengths in the unit of the coordinates.
struct Arc {
  double x = 0, y = 0;  ///< Of its centre, the pivot.
  double radius = 0;
  double down = 1;             ///< 1 where y grows downwards, as in a picture; -1 where it grows upwards.
  Eigen::Matrix3d covariance;  ///< Of x, y and radius.
  double std_dev = 0;          ///< Of the points about the circle, along the radius.

  /// The direction of a point from the centre [rad], 0 straight down, growing with x.
  double Angle(double point_x, double point_y) const;
};

/// The circle nearest to N points by geometric distance (Gauss-Newton from G. Taubin's algebraic fit, IEEE Trans.
/// Pattern Anal. 13 (1991) 1115). The middle of the points lies below the centre: that is how y grows.
/// kFailedPrecondition: the points stand on a line, or nearly, so that they do not tell where the pivot is; or all
/// round it, so that they do not tell which way is down.
Result<Arc> FitArc(const Eigen::VectorXd& x, const Eigen::VectorXd& y);

}  // namespace pendulum
