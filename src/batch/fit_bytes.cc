// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/fit_bytes.h"

#include <utility>

#include "pendulum/batch/run_parts.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

Result<FitRun> FitBytes(RunOptions options, RunFiles files) {
  std::optional<Rig> rig;
  if (files.rig) {
    auto parsed = ParseRig(files.rig->bytes, files.rig->name);
    if (!parsed) return tl::unexpected(parsed.error());
    rig = *std::move(parsed);
  }
  if (files.calibration) {
    auto parsed = ParseCalibration(files.calibration->bytes, files.calibration->name);
    if (!parsed) return tl::unexpected(parsed.error());
    options.read.calibration = *std::move(parsed);
  }
  auto recording = ParseRecording(files.data.bytes, files.data.name, options.read);
  if (!recording) return tl::unexpected(recording.error());
  files.data.bytes = {};  // a long one fills the memory
  auto swings = FindSwings(*std::move(recording), options.swing, std::move(rig), options.fit);
  if (!swings) return tl::unexpected(swings.error());
  return std::move(FitRuns(options, *std::move(swings)).front());
}

}  // namespace pendulum
