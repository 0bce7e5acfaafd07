// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/synthetic.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of simulate_pendulum as they were given. Names and units of `set` are those of MODEL.md, SI; noise,
/// resolution and range are in `unit`.
struct SimulateFlags {
  std::string model = "coulomb";
  std::string gravity;       ///< "sin" or "linear"; empty is the model's own.
  std::string set;           ///< name=value,...
  std::string unit = "deg";  ///< deg, rad, deg_s or rad_s
  double duration = 20;      ///< s
  double rate = 100;         ///< Hz
  double jitter = 0;         ///< s
  double start_time = 0;     ///< s
  double noise = 0;
  double noise_correlation = 0;
  double noise_freedom = 0;
  double resolution = 0;
  std::string range;  ///< "low,high"; empty is unlimited.
  std::uint64_t seed = 1;
  int count = 1;
  bool plan = false;                    ///< Predict standard errors instead of making recordings.
  std::string out;                      ///< Path, or "-" for stdout.
  std::string truth;                    ///< Path, "-" for stdout, or empty for none.
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// A unit in which the tool can write its column.
struct OutputUnit {
  std::string_view name;    ///< As in --unit.
  std::string_view column;  ///< As in the header of the CSV file.
  Quantity quantity;
  double si;  ///< rad or rad/s per unit.
};

/// What simulate_pendulum is to do.
struct SimulateOptions {
  SyntheticOptions synthetic;  ///< The first recording; recording i has seed + i.
  std::vector<std::pair<std::string, double>>
      truth;  ///< Parameters by name: SI with a rig, torques in units of G without.
  OutputUnit unit;
  double resolution = 0;             ///< In `unit`, 0 is none.
  std::optional<SensorRange> range;  ///< In `unit`.
  bool plan = false;                 ///< A plan on standard output, and no recording.
  int count = 1;                     ///< Recordings.
  std::string out;                   ///< As in the flags.
  std::string truth_out;             ///< As in the flags; empty for none.

  /// The files of recording `index` (0-based), with their flags: the recording, and the truth if it is wanted.
  std::vector<NamedFile> Outputs(int index) const;
};

/// Checks the flags and turns them into what is to be done; `rig` is what --rig names, if anything.
///
/// kInvalidArgument: a value outside its domain, a name that the model does not have (the message lists those it has),
/// no inertia, no start or two; the message names the flag.
Result<SimulateOptions> MakeSimulateOptions(const SimulateFlags& flags, const std::optional<Rig>& rig);

}  // namespace pendulum
