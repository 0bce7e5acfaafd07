// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"

namespace pendulum {

/// A measured constant of the rig: value and standard deviation in the same SI unit; 0 means none was given.
struct RigValue {
  double value = 0;
  double std_dev = 0;
};

/// What is known of the pendulum apart from its swing: it turns the ratios a free swing can tell into SI.
struct Rig {
  RigValue gravity_torque;          ///< G [N m], the torque at θ = 90 deg, with its propagated standard deviation.
  std::optional<RigValue> inertia;  ///< I_O from geometry or CAD [kg m^2]: compared with the fit, never fitted to.
  nlohmann::ordered_json source;    ///< The rig file as it was read, for the report.
};

/// Reads a rig from JSON text: one of {"bob_mass", "rod_mass", "rod_length", "gravity"}, {"gravity_torque"} or {"mass",
/// "center_of_mass", "gravity"}, each with optional "inertia"; SI units; a value is a number or {"value", "std_dev"}. A
/// rod and bob give I_O = m l²/3 + M l² (MODEL.md eq. (3)) unless "inertia" is there, and G = (M + m/2) g l (MODEL.md
/// eq. (2)); its variance to first order, from independent values.
/// kDataLoss: not JSON (line and column), longer than 64 KiB, an unknown, missing or repeated key, keys of different
/// descriptions, a value that is not positive (rod_mass may be 0); the message begins with `name` and names the key.
Result<Rig> ParseRig(std::string_view text, const std::string& name);

/// The same from a file. kNotFound: no such file. kDataLoss as well: it is a directory or cannot be read.
Result<Rig> ReadRig(const std::filesystem::path& path);

}  // namespace pendulum
