// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/sensor_errors.h"
#include "pendulum/request/simulation.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of simulate_pendulum as given.
struct SimulateFlags : SimulationFlags {
  int count = 1;
  int threads = 0;                      ///< 0: one per core.
  bool plan = false;                    ///< Predict standard errors instead of making recordings.
  bool details = false;                 ///< The plan with all its rows.
  std::string rig;                      ///< Path; empty: none.
  std::string sensor;                   ///< Of a plan: a kind, JSON or a path; empty: assumed.
  std::string out;                      ///< Path, or "-" for stdout.
  std::string truth;                    ///< Path, "-" for stdout; empty: none.
  std::string manifest;                 ///< Path, "-" for stdout; empty: none.
  std::vector<std::string> positional;  ///< Arguments that belong to no flag: an error.
};

/// The task of simulate_pendulum.
struct SimulateOptions : Simulation {
  bool plan = false;                      ///< A plan on standard output instead of recordings.
  bool details = false;                   ///< As in the flags.
  std::optional<SensorStatement> sensor;  ///< Of a plan.
  int count = 1;                          ///< Number of recordings.
  int threads = 0;                        ///< As in the flags.
  std::string rig_path;                   ///< As in the flags; empty: none.
  std::string out;                        ///< As in the flags.
  std::string truth_out;                  ///< As in the flags; empty: none.
  std::string manifest_out;               ///< As in the flags; empty: none.

  /// The files of recording `index` (0-based), with their flags: the recording, and the true values if requested.
  std::vector<NamedFile> Outputs(int index) const;
};

/// Checks the flags and converts them to options. `rig`: the rig from --rig, if given.
///
/// kInvalidArgument: as MakeSimulation, or outputs that contradict each other; the message names the flag. Others: as
/// ReadSensorFile.
Result<SimulateOptions> MakeSimulateOptions(const SimulateFlags& flags, const std::optional<Rig>& rig);

}  // namespace pendulum
