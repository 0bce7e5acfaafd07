// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "tools/fit_pendulum_options.h"
#include "tools/fit_runs.h"

namespace pendulum {

/// Reads all recordings, fits each chosen swing alone and all of them together. Errors name the recording: as reading
/// and fitting it; kInvalidArgument: fewer than two swings, the same readings twice, one resolution for several units,
/// or outputs that are one too many; kDataLoss: recordings that describe different rigs.
Result<FitRun> FitJointRun(const FitPendulumOptions& options, const Setup& setup);

}  // namespace pendulum
