// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/rig.h"
#include "pendulum/request/simulation.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of simulate_pendulum as they were given.
struct SimulateFlags : SimulationFlags {
  int count = 1;
  int threads = 0;                      ///< 0: as many as there are cores.
  bool plan = false;                    ///< Predict standard errors instead of making recordings.
  std::string rig;                      ///< Path, or empty for none.
  std::string out;                      ///< Path, or "-" for stdout.
  std::string truth;                    ///< Path, "-" for stdout, or empty for none.
  std::string manifest;                 ///< Path, "-" for stdout, or empty for none.
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// What simulate_pendulum is to do.
struct SimulateOptions : Simulation {
  bool plan = false;         ///< A plan on standard output, and no recording.
  int count = 1;             ///< Recordings.
  int threads = 0;           ///< As in the flags.
  std::string rig_path;      ///< As in the flags; empty for none.
  std::string out;           ///< As in the flags.
  std::string truth_out;     ///< As in the flags; empty for none.
  std::string manifest_out;  ///< As in the flags; empty for none.

  /// The files of recording `index` (0-based), with their flags: the recording, and the truth if it is wanted.
  std::vector<NamedFile> Outputs(int index) const;
};

/// Checks the flags and turns them into what is to be done; `rig` is what --rig names, if anything.
///
/// kInvalidArgument: as MakeSimulation, or outputs that contradict each other; the message names the flag.
Result<SimulateOptions> MakeSimulateOptions(const SimulateFlags& flags, const std::optional<Rig>& rig);

}  // namespace pendulum
