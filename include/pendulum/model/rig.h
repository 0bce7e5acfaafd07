// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"

namespace pendulum {

/// What kind of quantity a key of the rig is; it decides which units a value may have on the command line.
enum class RigQuantity { kMass, kLength, kAcceleration, kTorque, kStiffness, kInertia };

/// A key of the rig file.
struct RigKey {
  std::string_view name;
  std::string_view flag;  ///< Of the command line; the name, except for "gravity", because --gravity is the law.
  RigQuantity quantity;
  std::string_view unit;  ///< SI.
  std::string_view help;  ///< A sentence.
};

/// All keys of the rig file. The parser, its messages and the flags of the tools are made from this table.
std::span<const RigKey> RigKeys();

/// A measured constant of the rig: value and standard deviation in the same SI unit. A standard deviation of 0 means
/// that none was given.
struct RigValue {
  double value = 0;
  double std_dev = 0;
};

/// Knowledge of the pendulum that does not come from its swing. It converts the ratios that a free swing determines to
/// SI.
struct Rig {
  RigValue gravity_torque;          ///< G [N m], the torque at θ = 90 deg, with its propagated standard deviation.
  std::optional<RigValue> inertia;  ///< I_O from geometry or CAD [kg m^2]; compared with the fit, not used in it.
  nlohmann::ordered_json source;    ///< The rig file as it was read, for the report.
};

/// Reads a rig from JSON text: one of {"bob_mass", "rod_mass", "rod_length", "gravity"}, {"gravity_torque"} or {"mass",
/// "center_of_mass", "gravity"}, each with optional "inertia". Values are in SI units, each a number or {"value",
/// "std_dev"}. A rod and a bob give I_O = m l²/3 + M l² (MODEL.md eq. (1.3)) unless "inertia" is given, and
/// G = (M + m/2) g l (MODEL.md eq. (1.2)). Variances are propagated to first order; the values count as independent.
/// kDataLoss: not JSON (line and column), longer than 64 KiB, an unknown, missing or repeated key, keys of different
/// descriptions, or a value that is not positive (rod_mass may be 0). The message begins with `name` and names the key.
Result<Rig> ParseRig(std::string_view text, const std::string& name);

/// Reads a rig from a file. kNotFound: no such file. kDataLoss: as above, or the path is a directory or cannot be read.
Result<Rig> ReadRig(const std::filesystem::path& path);

}  // namespace pendulum
