// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "pendulum/base/status.h"
#include "pendulum/batch/fit_run.h"
#include "pendulum/batch/run_options.h"

namespace pendulum {

/// The bytes of a file, and the name it has in messages.
struct NamedBytes {
  std::string name, bytes;
};

/// A file that all runs of a batch share, held once; null where there is none.
using SharedFile = std::shared_ptr<const NamedBytes>;

inline SharedFile Share(NamedBytes file) { return std::make_shared<const NamedBytes>(std::move(file)); }

/// What a run is made from.
struct RunFiles {
  NamedBytes data;              ///< Its name is that of the result's data, too.
  SharedFile rig, calibration;  ///< JSON.
};

/// Reads and fits a recording as fit_pendulum does, from bytes that are at hand; of several swings the first that is
/// chosen. Errors as ParseRig, ParseCalibration, ParseRecording, FindSwings and FitRuns.
Result<FitRun> FitBytes(RunOptions options, RunFiles files);

}  // namespace pendulum
