// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/recording/recording.h"

namespace pendulum {

struct Extremum {
  double time = 0, value = 0;  ///< s; rad or rad/s, as the recording
  Eigen::Index sample = 0;
};

/// Standard deviation of the noise [unit of the recording], from each sample's distance to the line through its
/// neighbours. Curvature between samples counts as noise; quantized data may give 0.
double SuccessiveDifferenceNoise(const Recording& recording);

/// What a reading must move back by before a turn counts [unit of the recording]: noise, 2 sqrt(2 ln N) + 1 standard
/// deviations of it, two resolutions and 3 % of the range (of a turn at most).
double TurningThreshold(const Recording& recording, double noise);

/// Turning points as FindExtrema, before them the first candidate: perhaps the start, or in a hold. May be empty.
std::vector<Extremum> FindTurns(const Recording& recording, double threshold);

/// Turning points in time order, maxima and minima in turn, located to O(h³), not to a sample. One counts once the
/// reading has moved back from it by more than TurningThreshold; a hold, or a start in the middle of a swing, is none.
/// kFailedPrecondition: fewer than three; the message says how many there were.
Result<std::vector<Extremum>> FindExtrema(const Recording& recording);

}  // namespace pendulum
