// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/model/rig.h"

namespace pendulum {

inline constexpr std::string_view kDefaultModel = "coulomb";

/// The flags for reading and fitting a recording, as given; empty or the default if not given. Used by the tools that
/// fit recordings and by the service.
struct RunFlags {
  std::string rig;
  std::string calibration;
  std::string sensor;  ///< A kind or JSON; a tool replaces a file's name by its text (ReadSensorFile).
  std::string model;   ///< Empty: kDefaultModel, and the recording may show that it is a spring's (may_be_spring).
  std::string gravity = "auto";
  std::string start = "auto";
  std::string release;
  std::string from;
  std::string to;
  std::string fix;
  std::string init;
  std::string bounds;
  std::string prior;
  std::string time_column;
  std::string value_column;
  std::string unit;
  std::string sample_rate_hz;
  std::string resolution;
  std::string range;
  std::string oversample;
  std::string window_s;
  std::string noise = "auto";
  std::string loss = "none";
  std::string interval = "auto";
  std::string checks = "standard";
  std::string seed;
  std::string threads;
  bool closed_form_only = false;
  /// Values of the rig, in the order of RigKeys, such as "380g".
  std::vector<std::string> rig_values = std::vector<std::string>(RigKeys().size());
};

/// The value of the flag of a key of the rig, by its index in RigKeys.
struct RigFlagValue {
  std::size_t key;
};

/// A value that a flag may have, and its label in the form of the service.
struct FlagWord {
  std::string_view word, label;
};

/// A flag for reading and fitting a recording.
struct RunFlag {
  std::string_view name;
  std::variant<std::string RunFlags::*, bool RunFlags::*, RigFlagValue> value;
  std::string help;             ///< What it is, its unit, and what the default means. Other flags appear as --name.
  std::string_view label = {};  ///< Label of its field in the form of the service; empty: no field.
  std::string_view unit = {};   ///< Unit of its number, for the label.
  std::vector<FlagWord> words = {};         ///< All its values if they are words; an empty word is no value.
  nlohmann::ordered_json schema = nullptr;  ///< JSON Schema of its value in a request; generated if it has words.
  std::string example = {};                 ///< A value for the description of the service; empty: none.
  bool needs_fit = false;                   ///< It cannot be combined with --closed_form_only.
  bool is_local = false;                    ///< It names a file or threads; requests do not have it.

  /// Its value in `flags`.
  std::variant<std::string*, bool*> In(RunFlags& flags) const;

  /// Whether it is a value of the rig.
  bool IsOfRig() const { return std::holds_alternative<RigFlagValue>(value); }
};

/// All members of RunFlags, one flag for each key of the rig. The command line, --help, the parameters of requests,
/// openapi.json and the form of the service are made from this table.
const std::vector<RunFlag>& RunFlagTable();

/// The flags that differ from their defaults, by name: texts, or true.
nlohmann::ordered_json GivenFlags(const RunFlags& flags);

/// The error for a flag that cannot be combined with --closed_form_only.
tl::unexpected<Status> NeedsFitError(std::string_view flag);

/// Replaces the name of a file in the flag --sensor by the file's text, and returns the name; empty if the flag is a
/// kind, JSON or not given. kNotFound: no such file, nor such a kind. kDataLoss: as ReadFile and ParseSensorStatement.
Result<std::string> ReadSensorFile(std::string& sensor);

/// What the flag --sensor states, a kind or JSON; absent if it is not given. kInvalidArgument: as ParseSensorStatement.
Result<std::optional<SensorStatement>> StatedSensor(const std::string& sensor);

/// Converts flags to options; the caller reads rig and calibration. kInvalidArgument: a flag is wrong or contradicts
/// another; the message names it.
Result<IdentifyOptions> MakeIdentifyOptions(const RunFlags& flags);

}  // namespace pendulum
