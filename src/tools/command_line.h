// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// A flag of a tool.
struct FlagInfo {
  std::string name;             ///< Without dashes.
  std::string help;             ///< Meaning, unit and default.
  std::string type = "string";  ///< gflags' type: bool (no value in a following argument), string, double, int32, ...
  bool own = true;              ///< Of the tool, not of a library: in --help and suggestions.
};

/// Parses the arguments (without the program's name) by gflags' grammar, without setting flags. Returns the arguments
/// that belong to no flag. Without this check gflags would exit with 1.
///
/// kInvalidArgument: an unknown flag (the nearest own flag is suggested), a flag without a value or with an empty one,
/// an invalid number, a repeated flag other than a switch.
Result<std::vector<std::string>> PositionalArguments(std::span<const std::string> arguments,
                                                     std::span<const FlagInfo> flags);

/// The arguments with --models replaced by --model; both names mean the same flag.
std::vector<std::string> ReplaceModelsAlias(std::vector<std::string> arguments);

/// The output of --help: the usage, then the own flags.
std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags);

}  // namespace pendulum
