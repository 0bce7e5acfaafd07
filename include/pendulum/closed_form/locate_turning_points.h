// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/closed_form/turning_points.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Locates the turning points of FindTurningPoints with higher precision, and gives their errors. Each turning point is
/// located with a polynomial fitted to the readings within a sixth of a period, or a quarter with few samples. The
/// degree is 6, or 4 or 2 with few samples. Before the fit the higher terms of a cosine and the kink are subtracted
/// (MODEL.md eq. (6.6)). The noise is the scatter about all polynomials together; the errors follow from it. The zero
/// is the mean with ZeroWeights. Turning points at an end of the recording or of the sensor's range, or within a gap,
/// are left out. kFailedPrecondition: as FindTurningPoints, or fewer than three can be located.
Result<TurningPointTable> LocateTurningPoints(const Recording& recording, const Kink& kink = {});

/// Covariance (K x K, first order) of K numbers computed from located turning points. gradient: K x 2 M, derivatives
/// with respect to (time_0, value_0, time_1, ...).
Eigen::MatrixXd CovarianceOf(const TurningPointTable& table, const Eigen::MatrixXd& gradient);

/// Derivatives (N x K) of such numbers with respect to the N readings of the recording.
Eigen::MatrixXd InfluenceOf(const TurningPointTable& table, const Eigen::MatrixXd& gradient, Eigen::Index samples);

}  // namespace pendulum
