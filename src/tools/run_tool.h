// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gflags/gflags.h>

#include "pendulum/base/status.h"
#include "pendulum/request/run_flags.h"

namespace pendulum {

/// The description of a tool, which its main function gives to RunTool.
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

/// Prints an error as PrintMessage does. If there are flags to try, a line with the command that has them follows:
/// "try: fit_pendulum run.csv --unit deg".
void PrintError(std::string_view name, const Status& error);

/// Runs a tool: parses flags, handles --help and --version, prints errors and maps them to exit codes. An exception is
/// a bug: exit code 70.
int RunTool(const Tool& tool, int argc, char** argv);

/// A flag of a tool: its value is a member of the tool's `Flags`, whose initial value is the default.
template <typename Flags>
struct ToolFlag {
  const char* name;
  std::variant<bool Flags::*, int Flags::*, std::int64_t Flags::*, std::uint64_t Flags::*, double Flags::*,
               std::string Flags::*>
      value;
  const char* help;  ///< Meaning, unit and default.
};

/// Registers the flags of RunFlagTable with gflags, which keeps pointers to both arguments.
void RegisterRunFlags(RunFlags& values, RunFlags& defaults);

/// Runs a tool that has the flags of `table` and, if Flags is derived from RunFlags, also the flags of RunFlagTable. It
/// may be called only once in a process. `work` gets the flags' values; its `positional` has the arguments without a
/// flag.
template <typename Flags, typename Work>
int RunTool(std::string_view name, const char* main_file, const std::string& usage,
            const std::vector<ToolFlag<Flags>>& table, const Work& work, int argc, char** argv) {
  static Flags values, defaults;  // gflags keeps pointers to both
  for (const ToolFlag<Flags>& flag : table) {
    const auto add = [&](auto member) {
      gflags::FlagRegisterer(flag.name, flag.help, main_file, &(values.*member), &(defaults.*member));
    };
    std::visit(add, flag.value);
  }
  if constexpr (std::derived_from<Flags, RunFlags>) RegisterRunFlags(values, defaults);
  const auto run = [&](const std::vector<std::string>& positional) {
    values.positional = positional;
    return work(values);
  };
  return RunTool({name, main_file, usage, run}, argc, argv);
}

}  // namespace pendulum
