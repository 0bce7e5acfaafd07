// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/recording/recording.h"

namespace pendulum {

struct Extremum {
  double time = 0, value = 0;  ///< s; rad or rad/s, as in the recording
  Eigen::Index sample = 0;
};

/// Standard deviation of the noise [unit of the recording], from each sample's distance to the line through its
/// neighbours. Curvature between samples counts as noise; quantized data may give 0.
double SuccessiveDifferenceNoise(const Recording& recording);

/// How far a reading must move back before a turning point counts [unit of the recording]. This is the maximum of 2
/// sqrt(2 ln N) + 1 standard deviations of `noise`, two resolutions, and 3 % of the range (of an angle's range at most
/// one turn counts).
double TurningThreshold(const Recording& recording, double noise);

/// The turning points that FindExtrema finds, preceded by the first candidate, which may be the start or lie in a hold.
/// May be empty.
std::vector<Extremum> FindTurningPoints(const Recording& recording, double threshold);

/// Turning points in time order, alternately maxima and minima, located to O(h³) instead of to one sample. A turning
/// point counts once the reading has moved back by more than TurningThreshold. A hold, or a start in the middle of a
/// swing, is not one. kFailedPrecondition: fewer than three; the message gives their number.
Result<std::vector<Extremum>> FindExtrema(const Recording& recording);

}  // namespace pendulum
