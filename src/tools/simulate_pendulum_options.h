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
#include "pendulum/trajectory/scatter.h"
#include "pendulum/trajectory/synthetic.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of simulate_pendulum as they were given. Names and units of `set` are those of MODEL.md, SI; noise,
/// resolution and range are in `unit`.
struct SimulateFlags {
  std::string model = "coulomb";
  std::string gravity;       ///< "sin" or "linear"; empty is the model's own.
  std::string set;           ///< name=value,...
  std::string spread;        ///< name=std_dev,...; empty scatters nothing.
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
  int threads = 0;                      ///< 0: as many as there are cores.
  bool plan = false;                    ///< Predict standard errors instead of making recordings.
  std::string rig;                      ///< Path, or empty for none.
  std::string out;                      ///< Path, or "-" for stdout.
  std::string truth;                    ///< Path, "-" for stdout, or empty for none.
  std::string manifest;                 ///< Path, "-" for stdout, or empty for none.
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
  SyntheticOptions synthetic;  ///< Recording i has seed + i; parameters are those of `truth`.
  std::vector<std::pair<std::string, double>>
      truth;                                  ///< Parameters by name: SI with a rig, torques in units of G without.
  std::vector<ScatteredParameter> scattered;  ///< Of `truth`, in its order and units; empty where nothing scatters.
  double gravity_torque = 1;                  ///< N m, 1 without a rig: what divides the torques of `truth`.
  OutputUnit unit;
  double resolution = 0;             ///< In `unit`, 0 is none.
  std::optional<SensorRange> range;  ///< In `unit`.
  bool plan = false;                 ///< A plan on standard output, and no recording.
  int count = 1;                     ///< Recordings.
  int threads = 0;                   ///< As in the flags.
  std::string rig_path;              ///< As in the flags; empty for none.
  std::string out;                   ///< As in the flags.
  std::string truth_out;             ///< As in the flags; empty for none.
  std::string manifest_out;          ///< As in the flags; empty for none.

  /// The files of recording `index` (0-based), with their flags: the recording, and the truth if it is wanted.
  std::vector<NamedFile> Outputs(int index) const;
};

/// What makes recording `index` (0-based) of several: its seed, and its own true values where they scatter.
///
/// kInvalidArgument: the values of that seed stay outside their bounds (ScatterParameters).
Result<SimulateOptions> OptionsOfRecording(SimulateOptions options, int index);

/// Checks the flags and turns them into what is to be done; `rig` is what --rig names, if anything.
///
/// kInvalidArgument: a value outside its domain, a name that the model does not have (the message lists those it has),
/// no inertia, no start or two, a spread that leaves the bounds; the message names the flag.
Result<SimulateOptions> MakeSimulateOptions(const SimulateFlags& flags, const std::optional<Rig>& rig);

}  // namespace pendulum
