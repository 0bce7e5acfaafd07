// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/closed_form/turning_points.h"
#include "pendulum/closed_form/window_reasons.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Where and why a swing begins.
struct Beginning {
  Eigen::Index sample;
  WindowBegin why;
  Eigen::Index after_hold = sample;
  Eigen::Index hold_first = sample, hold_last = sample;  ///< Of a hold that is not steady, without the release.
};

/// The beginning of a run of free half swings: the steady end of a hold, the start of the recording, or a turning
/// point.
Beginning FindBeginning(const Recording& recording, const TurningPointTable& table, const TurningPointRun& run);

/// Where and why a swing ends.
struct Ending {
  Eigen::Index sample;
  WindowEnd why;
};

/// The end of a run of free half swings: one period after the motion, or the last turning point before the pendulum is
/// touched.
Ending FindEnding(const Recording& recording, const TurningPointTable& table, const TurningPointRun& run);

}  // namespace pendulum
