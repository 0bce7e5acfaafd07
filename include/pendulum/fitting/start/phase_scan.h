// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <vector>

#include "pendulum/fitting/start/start_values.h"

namespace pendulum {

/// Natural frequencies [rad/s, true seconds] among which a recording's is looked for; both alike: that one alone.
struct FrequencyRange {
  double low = 0;
  double high = 0;
};

/// Start values without turning points, for a recording sampled too slowly to show them but in motion from its first
/// sample on, best first, at most twelve: at each frequency the readings are a linear least squares of A(t) cos φ(t),
/// A(t) sin φ(t) and 1, φ being the phase of a pendulum of the amplitude A(t) (MODEL.md eq. (46)); each local minimum
/// over frequency is one; none once a stop is requested. Times may be uneven. Cost: some ms to a second, by range and
/// duration.
std::vector<StartValues> ScanFrequencies(const Recording& recording, const MotionModel& model,
                                         const FrequencyRange& range, const std::stop_token& stop = {});

}  // namespace pendulum
