// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/fitting/start/frequency_scan.h"
#include "pendulum/fitting/start/start_values.h"

namespace pendulum {

/// Start values from a scan over frequency (ScanFrequencies) for the readings of any sensor, complete with the sensor's
/// parameters. If the scale of the sensor is unknown, each frequency has one start for each amplitude that the readings
/// may represent. kFailedPrecondition: an acceleration along the rod; the message says what to do. Empty after a stop
/// request.
Result<std::vector<StartValues>> ScanStarts(const Recording& recording, const MotionModel& model,
                                            const FrequencyRange& range, const FitOptions& options);

}  // namespace pendulum
