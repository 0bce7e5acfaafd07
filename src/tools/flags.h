// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// The result of parsing; the flags are set.
struct ParsedFlags {
  std::string answer;                   ///< The text of --help, --version or --completion; empty if the tool is to run.
  std::vector<std::string> positional;  ///< Arguments that belong to no flag.
};

/// Whether a flag is defined in the folder of `main_file`, and not in a library. Both paths come from __FILE__. The
/// compiler may spell the path of a folder differently for sources and headers, so only the folder's name is compared.
bool IsOwnFlag(std::string_view flag_file, std::string_view main_file);

/// Sets the flags of `main_file` (its __FILE__), of its folder and of the libraries. If gflags refuses a flag that
/// passed PositionalArguments, the process exits with 2, never 1. The help begins with `usage`.
///
/// kInvalidArgument: as PositionalArguments.
Result<ParsedFlags> ParseFlags(int argc, char** argv, std::string_view main_file, std::string_view usage);

/// A flag of a tool.
struct FlagInfo {
  std::string name;             ///< Without dashes.
  std::string help;             ///< Meaning, unit and default.
  std::string type = "string";  ///< gflags' type: bool (no value in a following argument), string, double, int32, ...
  bool own = true;              ///< Defined by the tool, not by a library. Only own flags are in --help.
  std::vector<std::string> words = {};  ///< All its values if they are words, for the completion.
  bool is_path = false;                 ///< Its value is the path of a file or a folder.
};

/// Parses the arguments (without the program's name) by gflags' grammar, without setting flags. Returns the arguments
/// that belong to no flag. Without this check gflags itself would report an error and exit with 1.
///
/// kInvalidArgument: an unknown flag (the nearest own flag is suggested), a flag without a value or with an empty one,
/// an invalid number, a repeated flag other than a switch.
Result<std::vector<std::string>> PositionalArguments(std::span<const std::string> arguments,
                                                     std::span<const FlagInfo> flags);

/// The arguments with --models replaced by --model, and -h by --help; both names mean the same flag.
std::vector<std::string> ReplaceAliases(std::vector<std::string> arguments, bool has_model);

}  // namespace pendulum
