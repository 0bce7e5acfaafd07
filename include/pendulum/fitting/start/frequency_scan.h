// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <vector>

#include "pendulum/fitting/start/sensor_start.h"
#include "pendulum/fitting/start/start_values.h"

namespace pendulum {

/// The natural frequencies [rad/s, true seconds] to search. If low and high are equal, only that one is tried.
struct FrequencyRange {
  double low = 0;
  double high = 0;
};

/// Start values that need no turning points, for a recording sampled too slowly to show them. The recording must be in
/// motion from its first sample on; times may be uneven. Returns at most twelve starts, the best first, one for each
/// local minimum over frequency; none after a stop request. At each frequency the readings are fitted by linear least
/// squares with A(t) cos φ(t), A(t) sin φ(t) and 1. Here φ is the phase of a pendulum with amplitude A(t) (MODEL.md
/// eq. (6.15)). Cost: some ms to a second, depending on range and duration.
std::vector<StartValues> ScanFrequencies(const Recording& recording, const MotionModel& model,
                                         const FrequencyRange& range, const std::stop_token& stop = {});

/// The linear oscillations that describe the first 60 readings, whatever their unit: at most twelve, the best first.
/// Left out are those that leave more than four times the smallest sum of squares.
std::vector<Oscillation> ScanOscillations(const Recording& view, const FrequencyRange& range,
                                          const std::stop_token& stop = {});

}  // namespace pendulum
