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

namespace pendulum {

/// The flags that say what a simulated recording is, as they were given. Names and units of `set` are those of
/// MODEL.md, SI; noise, resolution and range are in `unit`.
struct SimulationFlags {
  std::string model = "coulomb";
  std::string gravity;       ///< "sin" or "linear"; empty is the model's own.
  std::string set;           ///< name=value,...
  std::string spread;        ///< name=std_dev,...; empty scatters nothing.
  std::string unit = "deg";  ///< deg, rad, deg_s, rad_s, volts (of a gyro), m_s2, px or m
  double duration = 20;      ///< s
  double rate = 100;         ///< Hz
  double jitter = 0;         ///< s
  double start_time = 0;     ///< s
  double noise = 0;
  double noise_correlation = 0;
  double noise_freedom = 0;
  double resolution = 0;
  std::string range;          ///< "low,high"; empty is unlimited.
  std::string lose;           ///< "time:counts,..." [s]; empty loses none.
  bool event_driven = false;  ///< A row only when the count changes.
  double time_noise = 0;      ///< s
  std::uint64_t seed = 1;
};

/// A unit in which a recording's column can be.
struct OutputUnit {
  std::string_view name;    ///< As in --unit.
  std::string_view column;  ///< As in the header of the CSV file.
  Quantity quantity;
  double si;                 ///< rad or rad/s per unit, 1 of another.
  std::string_view si_name;  ///< Of the unit in SI, as in the keys of the truth.
  SensorKind sensor = SensorKind::kDirect;
};

/// What is to be simulated, and how it is written down.
struct Simulation {
  SyntheticOptions synthetic;  ///< Recording i has seed + i; parameters are those of `truth`.
  std::vector<std::pair<std::string, double>>
      truth;                                  ///< Parameters by name: SI with a rig, torques in units of G without.
  std::vector<ScatteredParameter> scattered;  ///< Of `truth`, in its order and units; empty where nothing scatters.
  double gravity_torque = 1;                  ///< N m, 1 without a rig: what divides the torques of `truth`.
  OutputUnit unit;
  double resolution = 0;             ///< In `unit`, 0 is none.
  std::optional<SensorRange> range;  ///< In `unit`.
};

/// What makes recording `index` (0-based) of several: its seed, and its own true values where they scatter.
///
/// kInvalidArgument: the values of that seed stay outside their bounds (ScatterParameters).
Result<Simulation> SimulationOfRecording(const Simulation& all, int index);

/// Checks the flags and turns them into what is to be simulated; `rig` is what --rig names, if anything.
///
/// kInvalidArgument: a value outside its domain, a name that the model does not have (the message lists those it has),
/// no inertia, no start or two, a spread that leaves the bounds; the message names the flag.
Result<Simulation> MakeSimulation(const SimulationFlags& flags, const std::optional<Rig>& rig);

}  // namespace pendulum
