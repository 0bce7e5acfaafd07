// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// A tool as its main describes it.
struct Tool {
  std::string_view name;       ///< As in messages.
  std::string_view main_file;  ///< __FILE__ of the main that defines its flags.
  std::string usage;           ///< Begins the help.
  /// The tool's work, once the flags are set; `positional` belongs to no flag. Gives the exit code of what it did.
  std::function<Result<int>(const std::vector<std::string>& positional)> work;
};

/// The exit code of work that Ctrl-C ended before its time.
inline constexpr int kInterrupted = 130;

/// "name: sentence" on standard error.
void Say(std::string_view name, std::string_view sentence);

/// What a tool's main does around its work: flags, --help, --version, and the sentence and exit code of an error; an
/// exception is our bug, 70.
int RunTool(const Tool& tool, int argc, char** argv);

}  // namespace pendulum
