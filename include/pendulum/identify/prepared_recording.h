// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/identify/identification.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// A recording that is ready to be fitted: repaired, with the free swings that were chosen in it.
struct PreparedRecording {
  Recording recording;
  ChosenSwings swings;
  Eigen::Index samples = 0;  ///< Number as read; for an event-driven recording including samples for its silences.
  std::optional<SensorStatement> sensor;  ///< Replaces what the recording states.
  std::optional<Rig> rig;
  IdentifiedRecording known;  ///< Common to all its swings: calibration and warnings.
};

/// Repairs a recording, converts an event-driven one to edges (unless options.fit.noise requests otherwise), and
/// chooses its swings. `rig` replaces the rig that the recording describes. Errors as ParseRig and ChooseSwings.
Result<PreparedRecording> PrepareRecording(Recording read, const IdentifyOptions& options, std::optional<Rig> rig);

/// The same from a file; "-" is standard input. Errors as ReadRecording too.
Result<PreparedRecording> PrepareFile(const std::string& path, const IdentifyOptions& options, std::optional<Rig> rig);

/// The error of one run among several; adds the recording and, unless it is 0, the number of the release to its place,
/// which may be in the recording already: a line, a member of an archive.
tl::unexpected<Status> ErrorOfRun(Status status, const std::string& path, int release);

}  // namespace pendulum
