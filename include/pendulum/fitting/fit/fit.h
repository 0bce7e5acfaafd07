// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Fits one model to the whole of a recording. Times are in true seconds (clock_scale), except release_time, which is
/// on the file's own clock. zero_drift (bias_drift of a rate) is a parameter if the options name it; otherwise the
/// drift is 0. For events without a drift, the encoder's hysteresis is a parameter (MODEL.md eq. (7.4)).
/// kInvalidArgument: no such model; a name in the options that the model does not have with this start; a value outside
/// its bounds; quantized noise without a resolution; edge noise for a recording without edges. kDataLoss: counts or
/// volts without a calibration. kFailedPrecondition: no swing, or too short a swing. kTryAgain: options.stop was
/// requested. Cost: about 1 ms for 2000 samples, 3 ms with the quantized likelihood, tens of ms if the pendulum comes
/// to rest.
Result<FitReport> FitRecording(const Recording& recording, const FitOptions& options);

}  // namespace pendulum
