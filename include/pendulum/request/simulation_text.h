// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/recording/recording.h"
#include "pendulum/request/simulation.h"

namespace pendulum {

/// The recording as a CSV file: comments about its origin, metadata `resolution` and `range` in the file's unit, then
/// time_s and the column of simulation.unit. Numbers are the shortest text that reads back exactly. If resolution and
/// range of a sensor are decimals, its levels are written as the decimals low + k resolution, without rounding errors
/// from radians.
std::string RecordingCsv(const Simulation& simulation, const Recording& recording, std::uint64_t seed);

/// The simulated recording as such a file, with both coordinates of a point if it records a point. Errors as
/// SimulateRecording.
Result<std::string> SimulatedCsv(const Simulation& simulation, std::uint64_t seed);

/// The true values as a flat JSON object: the parameters' names, SI with a rig, then sigma_rad, resolution_rad and
/// seed. A rate has sigma_rad_s and resolution_rad_s; other units are similar. noise_correlation and noise_freedom are
/// included if they are not 0; sigma is the scale of Student's t noise. lost_counts is an array of time_s and counts,
/// if there are any.
std::string TruthJson(const Simulation& simulation, std::uint64_t seed);

}  // namespace pendulum
