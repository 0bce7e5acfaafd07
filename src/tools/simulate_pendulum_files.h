// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "tools/simulate_pendulum_options.h"

namespace pendulum {

/// Checks that the files of all recordings can be written, as CheckOutputs does, then makes the recordings on
/// options.threads threads and at last the manifest. Memory does not grow with the number of recordings.
///
/// Of one recording the files are synchronised with the disk as WriteOutputs does it, of several their file system is
/// once all are written, before the manifest. Of several errors that of the first recording is returned; files of
/// others may then have been made. Codes of CheckOutputs, WriteOutputs, SimulateRecording, SimulationOfRecording.
Result<void> WriteRecordings(const SimulateOptions& options);

}  // namespace pendulum
