// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// What the command line asks for, once the FLAGS_ variables are set.
struct ParsedFlags {
  std::string answer;                   ///< What --help or --version prints; empty when the tool is to do its work.
  std::vector<std::string> positional;  ///< What belongs to no flag.
};

/// Sets the flags that `main_file` (its __FILE__), what lies beside it and the libraries define. The process exits with
/// 2, never 1, should gflags refuse what PositionalArguments let through. `usage` begins the help.
///
/// kInvalidArgument: as PositionalArguments.
Result<ParsedFlags> ParseFlags(int argc, char** argv, std::string_view main_file, std::string_view usage);

}  // namespace pendulum
