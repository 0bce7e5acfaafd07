// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// The result of parsing; the FLAGS_ variables are set.
struct ParsedFlags {
  std::string answer;                   ///< The text of --help or --version; empty if the tool is to run.
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

}  // namespace pendulum
