// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Fits one model to the whole of a recording. Seconds are true ones (clock_scale), but release_time is on the file's
/// own clock. zero_drift (bias_drift of a rate) is a parameter if the options name it; otherwise it is 0, and for
/// events the encoder's hysteresis is a parameter (MODEL.md eq. (7.4)). kInvalidArgument: no such model; a name in the
/// options that the model does not have with this start; a value outside its bounds; quantized noise without a
/// resolution; edges of a recording that has none. kDataLoss: counts or volts without a calibration.
/// kFailedPrecondition: no swing, or too little of one. kTryAgain: options.stop was requested. Cost: about a
/// millisecond for 2000 samples, three with the quantized likelihood, tens if the pendulum comes to rest.
Result<FitReport> FitRecording(const Recording& recording, const FitOptions& options);

}  // namespace pendulum
