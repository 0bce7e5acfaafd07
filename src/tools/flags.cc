// SPDX-License-Identifier: Apache-2.0
#include "tools/flags.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include <gflags/gflags.h>

#include "pendulum/base/version.h"
#include "tools/command_line.h"

DECLARE_bool(help);
DECLARE_bool(version);

namespace pendulum {
namespace {

bool gflags_is_parsing = false;

/// gflags exits with 1 on a flag that it refuses; the tools use 2.
void ExitWithTwo() {
  if (gflags_is_parsing) std::_Exit(ExitCode(StatusCode::kInvalidArgument));
}

std::vector<FlagInfo> RegisteredFlags(std::string_view main_file) {
  std::vector<gflags::CommandLineFlagInfo> registered;
  gflags::GetAllFlags(&registered);
  std::vector<FlagInfo> flags;
  for (const gflags::CommandLineFlagInfo& flag : registered) {
    if (flag.name == "help" || flag.name == "version") continue;
    flags.push_back({flag.name, flag.description, flag.type, IsOwnFlag(flag.filename, main_file)});
  }
  flags.push_back({"help", "Print this text.", "bool", true});
  flags.push_back({"version", "Print the version.", "bool", true});
  return flags;
}

}  // namespace

bool IsOwnFlag(std::string_view flag_file, std::string_view main_file) {
  const auto folder = [](std::string_view file) { return std::filesystem::path(file).parent_path().filename(); };
  return folder(flag_file) == folder(main_file);
}

Result<ParsedFlags> ParseFlags(int argc, char** argv, std::string_view main_file, std::string_view usage) {
  const std::vector<FlagInfo> flags = RegisteredFlags(main_file);
  const bool has_model = std::ranges::find(flags, "model", &FlagInfo::name) != flags.end();
  static std::vector<std::string> arguments;  // gflags keeps pointers
  arguments = has_model ? ReplaceModelsAlias({argv + 1, argv + argc}) : std::vector<std::string>(argv + 1, argv + argc);
  for (int i = 1; i < argc; ++i) argv[i] = arguments[static_cast<std::size_t>(i - 1)].data();
  auto positional = PositionalArguments(arguments, flags);
  if (!positional) return tl::unexpected(positional.error());
  std::atexit(ExitWithTwo);
  gflags_is_parsing = true;
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  gflags_is_parsing = false;
  ParsedFlags parsed;
  parsed.positional = *std::move(positional);
  if (FLAGS_help) {
    parsed.answer = HelpText(usage, flags);
  } else if (FLAGS_version) {
    parsed.answer = std::filesystem::path(argv[0]).filename().string() + " " + std::string(kVersion) + "\n";
  }
  return parsed;
}

}  // namespace pendulum
