// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/recording/recording.h"
#include "pendulum/request/simulation.h"

namespace pendulum {

/// The recording as a CSV file: comments that say what made it, metadata `resolution` and `range` in the file's unit,
/// then time_s and the column of simulation.unit. Numbers are the shortest text that reads back; the levels of a sensor
/// whose resolution and range are decimals are those decimals, low + k resolution, without the rounding of radians.
std::string RecordingCsv(const Simulation& simulation, const Recording& recording, std::uint64_t seed);

/// What the simulation records, as such a file: both coordinates of a point where that is what it sees. Errors as
/// SimulateRecording.
Result<std::string> SimulatedCsv(const Simulation& simulation, std::uint64_t seed);

/// The truth as a flat JSON object: the parameters' names, SI with a rig, then sigma_rad, resolution_rad and seed;
/// sigma_rad_s and resolution_rad_s for a rate, likewise for other units. noise_correlation and
/// noise_freedom stand there where they are not 0; sigma is the scale of Student's t noise. lost_counts, an array of
/// time_s and counts, where there are any.
std::string TruthJson(const Simulation& simulation, std::uint64_t seed);

}  // namespace pendulum
