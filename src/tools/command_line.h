// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// A flag that a tool understands.
struct FlagInfo {
  std::string name;             ///< Without dashes.
  std::string help;             ///< What, unit, meaning of the default.
  std::string type = "string";  ///< In gflags' words: bool (takes no value after a blank), string, double, int32, ...
  bool own = true;              ///< The tool's, not a library's: shown by --help and suggested for a misspelt one.
};

/// Walks through the arguments (without the program's name) by gflags' grammar, setting nothing, and gives those that
/// belong to no flag. gflags itself exits with 1 on what this refuses.
///
/// kInvalidArgument: an unknown flag (the nearest own flag is suggested), a flag without its value or with an empty
/// one, a number that is none, a flag other than a switch that is given twice.
Result<std::vector<std::string>> PositionalArguments(std::span<const std::string> arguments,
                                                     std::span<const FlagInfo> flags);

/// The arguments with --model where --models stands: they are one flag.
std::vector<std::string> WithModelForModels(std::vector<std::string> arguments);

/// What --help prints: the usage, then the own flags.
std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags);

}  // namespace pendulum
