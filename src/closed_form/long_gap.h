// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/recording/recording.h"

namespace pendulum {

/// The last sample before each long gap. A gap is long if it lasts for more than 20 half periods [s] and for longer
/// than all times between samples that are shorter than that: the readings do not tell how many swings it hides, and
/// computing the motion through it takes as long as it lasts.
std::vector<Eigen::Index> FindLongGaps(const Recording& recording, double half_period);

}  // namespace pendulum
