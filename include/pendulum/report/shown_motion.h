// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/identify/identification.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A fitted motion at M equal steps from the release, or from the first sample, to the last sample, dense enough to be
/// drawn.
struct ShownMotion {
  double start = 0, interval = 0;  ///< s, on the file's clock.
  Eigen::VectorXd angle, rate;     ///< M: rad from the equilibrium, rad/s.
  Eigen::VectorXd reading;         ///< M, of the sensor, in the unit of the recording; may be empty.
};

/// Whether a recording's samples do not show the motion: they are not angles, some are missing, or a period has few of
/// them.
bool HidesMotion(const IdentifiedRecording& recording);

/// About 60 points a period, but no more than `max_steps`. std::nullopt if there is no motion or it cannot be computed.
std::optional<ShownMotion> MotionToShow(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig,
                                        double max_steps);

}  // namespace pendulum
