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

/// Whether a flag is defined beside `main_file`, not in a library. Files are as __FILE__ gives them: the compiler may
/// spell the way to one folder differently for a source file and for a header, so the name of the folder alone is
/// compared.
bool IsOwnFlag(std::string_view flag_file, std::string_view main_file);

/// Sets the flags that `main_file` (its __FILE__), what lies beside it and the libraries define. The process exits with
/// 2, never 1, should gflags refuse what PositionalArguments let through. `usage` begins the help.
///
/// kInvalidArgument: as PositionalArguments.
Result<ParsedFlags> ParseFlags(int argc, char** argv, std::string_view main_file, std::string_view usage);

}  // namespace pendulum
