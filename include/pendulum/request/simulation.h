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

/// The flags of a simulated recording, as given. Names and units of `set` are those of MODEL.md, SI; noise, resolution
/// and range are in `unit`.
struct SimulationFlags {
  std::string model = "coulomb";
  std::string gravity;       ///< A name in GravityModels; empty: the model's own.
  std::string set;           ///< name=value,...
  std::string spread;        ///< name=std_dev,...; empty: no scatter.
  std::string unit = "deg";  ///< deg, rad, deg_s, rad_s, volts (of a gyro), m_s2, px or m
  double duration = 20;      ///< s
  double rate = 100;         ///< Hz
  double jitter = 0;         ///< s
  double start_time = 0;     ///< s
  double noise = 0;
  double noise_correlation = 0;
  double noise_freedom = 0;
  double resolution = 0;
  std::string range;          ///< "low,high"; empty: unlimited.
  std::string lose;           ///< "time:counts,..." [s]; empty: no lost counts.
  bool event_driven = false;  ///< Writes a row only when the count changes.
  double time_noise = 0;      ///< s
  std::uint64_t oversample = 1;
  double window_s = 0;
  std::uint64_t seed = 1;
};

/// A unit for the column of a recording.
struct OutputUnit {
  std::string_view name;    ///< Name in --unit.
  std::string_view column;  ///< Name in the header of the CSV file.
  Quantity quantity;
  double si;                 ///< rad or rad/s per unit; 1 for other units.
  std::string_view si_name;  ///< Name of the SI unit in the keys of the truth file.
  SensorKind sensor = SensorKind::kDirect;
};

/// A simulation and the format of its output.
struct Simulation {
  SyntheticOptions synthetic;                         ///< Recording i has seed + i; the parameters come from `truth`.
  std::vector<std::pair<std::string, double>> truth;  ///< Parameters by name: SI with a rig, torques over G without.
  std::vector<ScatteredParameter> scattered;  ///< Subset of `truth`, in its order and units; empty without scatter.
  double gravity_torque = 1;                  ///< N m, 1 without a rig: the torques of `truth` are divided by it.
  OutputUnit unit;
  double resolution = 0;             ///< Spacing of levels in `unit`; 0: none.
  std::optional<SensorRange> range;  ///< Range in `unit`.
};

/// The simulation of recording `index` (0-based) of several, with its own seed and, if they scatter, its own true
/// values.
///
/// kInvalidArgument: the values of that seed stay outside their bounds (ScatterParameters).
Result<Simulation> SimulationOfRecording(const Simulation& all, int index);

/// Checks the flags and converts them to a simulation; `rig`: the rig from --rig, if given.
///
/// kInvalidArgument: a value outside its domain, a name that the model does not have (the message lists the valid
/// ones), no inertia, no start or two, a spread that violates the bounds; the message names the flag.
Result<Simulation> MakeSimulation(const SimulationFlags& flags, const std::optional<Rig>& rig);

}  // namespace pendulum
