// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"

namespace pendulum {

/// What kind of quantity a key of the rig is; it decides which units a value may have on the command line.
enum class RigQuantity {
  kMass,
  kLength,
  kAcceleration,
  kTorque,
  kStiffness,
  kInertia,
};

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

/// The standard deviation of a value [SI] that is stated without one: a bare number is nominal.
/// - A mass: 1 g, as of kitchen scales; a length: 1 mm, as of a ruler. At least 0.1 % and at most 1 % of the value,
///   because large things are measured with coarser tools, and small ones with finer.
/// - g: 0.015 m/s^2, from the equator (9.780) to the poles (9.832 m/s^2; WGS 84).
/// - A torque, a stiffness or an inertia: 1 %, because it was computed from masses and lengths.
double NominalStdDev(RigQuantity quantity, double value);

/// A measured constant of the rig: value and standard deviation in the same SI unit; 0: exact.
struct RigValue {
  double value = 0;
  double std_dev = 0;
};

/// What the error of one value of the rig file adds to the restoring torque.
struct RigError {
  std::string_view key;     ///< Of RigKeys.
  double std_dev = 0;       ///< Of the value, in the key's unit, > 0.
  bool is_assumed = false;  ///< Nobody stated it: NominalStdDev.
  double of_torque = 0;     ///< Relative standard deviation of the restoring torque by this value alone.
};

/// Knowledge of the pendulum that does not come from its swing. It converts the ratios that a free swing determines to
/// SI.
struct Rig {
  /// The restoring torque G [N m], at θ = 90 deg of a pendulum, with its propagated standard deviation; the stiffness
  /// k [N m/rad] if is_spring. 1 if gives_torque is false.
  RigValue gravity_torque{1, 0};
  std::optional<RigValue> inertia;  ///< I_O from geometry or CAD [kg m^2]; compared with the fit, not used in it.
  nlohmann::ordered_json source;    ///< The rig file as it was read, for the report.
  std::string name = "the rig";     ///< The name of the file, for messages.
  bool gives_torque = true;         ///< False: torques and inertia stay in units of the restoring torque G.
  bool is_spring = false;           ///< The restoring torque is that of a spring or wire, proportional to the angle.
  std::optional<RigValue> known_inertia = {};  ///< I_O [kg m^2] if it, and not G, is known: the fit then gives G.
  std::optional<RigValue> gravity = {};        ///< g [m/s^2]
  std::optional<RigValue> length = {};         ///< Of a string or bifilar pendulum [m].
  std::optional<RigValue> mass = {};           ///< Of the whole pendulum [kg].
  std::vector<RigError> errors = {};           ///< Of the values that give the torque; empty if it was set directly.
};

/// Reads a rig from JSON text, in SI units. Each value is {"value", "std_dev"}, where only a std_dev of 0 is exact, or
/// a number, which has its NominalStdDev. A rig is one of
///   {"bob_mass", "rod_mass", "rod_length", "gravity"}   G = (M + m/2) g l (MODEL.md eq. (1.2)), and for comparison
///                                                       I_O = m l²/3 + M l² (eq. (1.3)) unless "inertia" is given
///   {"gravity_torque"}                                  G
///   {"mass", "center_of_mass", "gravity"}               G = m g d
///   {"stiffness"}                                       k of a spring or wire, instead of G
///   {"length"}, {"gravity"} or both, perhaps "mass"     a string or bifilar pendulum: without mass and gravity, G
///   stays
///                                                       unknown
///   {"inertia"}, perhaps "mass" or "gravity"            I_O, from which the fit gives G
/// each with optional "inertia". Variances are propagated to first order; the values count as independent.
/// kDataLoss: not JSON (line and column), longer than 64 KiB, an unknown, missing or repeated key, keys of different
/// descriptions, or a value that is not positive (rod_mass may be 0). The message begins with `name` and names the key.
Result<Rig> ParseRig(std::string_view text, const std::string& name);

/// Reads a rig from a file. kNotFound: no such file. kDataLoss: as above, or the path is a directory or cannot be read.
Result<Rig> ReadRig(const std::filesystem::path& path);

}  // namespace pendulum
