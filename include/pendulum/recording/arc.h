// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/base/status.h"

namespace pendulum {

/// The circle on which a tracked point moves, computed from its coordinates. Lengths are in the unit of the
/// coordinates.
struct Arc {
  double x = 0, y = 0;  ///< Of the centre, which is the pivot.
  double radius = 0;
  double down = 1;             ///< 1 if y increases downwards, as in a picture; -1 if it increases upwards.
  Eigen::Matrix3d covariance;  ///< Of x, y and radius.
  double std_dev = 0;          ///< Of the points about the circle, radially.

  /// The direction of a point from the centre [rad]: 0 straight down, increasing with x.
  double Angle(double point_x, double point_y) const;
};

/// The circle nearest to N points by geometric distance (Gauss-Newton, started from G. Taubin's algebraic fit, IEEE
/// Trans. Pattern Anal. 13 (1991) 1115). The middle of the points is assumed to lie below the centre; this determines
/// the direction of y. kFailedPrecondition: fewer than four points; the points lie nearly on a line, so the pivot is
/// undetermined, or all round the pivot, so the downward direction is undetermined.
Result<Arc> FitArc(const Eigen::VectorXd& x, const Eigen::VectorXd& y);

}  // namespace pendulum
