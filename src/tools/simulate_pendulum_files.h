// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "tools/simulate_pendulum_options.h"

namespace pendulum {

/// Checks with CheckOutputs that all files can be written. Then it makes the recordings on options.threads threads, and
/// finally the manifest. Memory does not grow with the number of recordings.
///
/// The files of a single recording are synchronised as in WriteOutputs. For several recordings the file system is
/// synchronised once after all files, before the manifest. Of several errors the one of the first recording is
/// returned; files of other recordings may exist then. Codes of CheckOutputs, WriteOutputs, SimulateRecording,
/// SimulationOfRecording.
Result<void> WriteRecordings(const SimulateOptions& options);

}  // namespace pendulum
