// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/recording/recording.h"

namespace pendulum {

/// The last sample before the first long gap between samples `first` and `last`; `last` if there is none. A gap is long
/// if it lasts for 20 half periods [s] and for more than the times between all other samples: the recorded part does
/// not tell how many swings it contains, and computing the motion through it takes as long as it lasts.
Eigen::Index BeforeLongGap(const Recording& recording, double half_period, Eigen::Index first, Eigen::Index last);

/// The first sample after the last long gap between samples `first` and `last`; `first` if there is none.
Eigen::Index AfterLongGap(const Recording& recording, double half_period, Eigen::Index first, Eigen::Index last);

}  // namespace pendulum
