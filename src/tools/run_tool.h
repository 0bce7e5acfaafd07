// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// The description of a tool by its main.
struct Tool {
  std::string_view name;       ///< Used in messages.
  std::string_view main_file;  ///< __FILE__ of the main that defines its flags.
  std::string usage;           ///< First text of the help.
  /// The tool's work, with the flags set; `positional`: arguments that belong to no flag. Returns the exit code.
  std::function<Result<int>(const std::vector<std::string>& positional)> work;
};

/// The exit code after an interruption by Ctrl-C.
inline constexpr int kInterrupted = 130;

/// Prints "name: sentence" on standard error.
void PrintMessage(std::string_view name, std::string_view sentence);

/// Runs a tool: parses flags, handles --help and --version, prints errors and maps them to exit codes. An exception is
/// a bug, 70.
int RunTool(const Tool& tool, int argc, char** argv);

}  // namespace pendulum
