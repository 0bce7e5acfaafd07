// SPDX-License-Identifier: Apache-2.0
#include "tools/flags.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#include <gflags/gflags.h>

#include "pendulum/base/version.h"
#include "pendulum/report/layout.h"
#include "pendulum/request/flag_values.h"

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

std::string Suggestion(std::string_view name, std::span<const FlagInfo> flags) {
  std::vector<std::string_view> own;
  for (const FlagInfo& flag : flags) {
    if (flag.own) own.push_back(flag.name);
  }
  const std::string nearest = NearestName(name, own);
  return nearest.empty() ? "--help lists the flags" : "did you mean --" + nearest + "?";
}

/// The flag with that name, with dashes read as underscores; "noNAME" finds the boolean NAME.
const FlagInfo* FindFlag(std::string name, std::span<const FlagInfo> flags) {
  std::replace(name.begin(), name.end(), '-', '_');
  const auto found = std::find_if(flags.begin(), flags.end(), [&](const FlagInfo& flag) {
    return flag.name == name || (flag.type == "bool" && "no" + flag.name == name);
  });
  return found == flags.end() ? nullptr : &*found;
}

tl::unexpected<Status> WrongFlag(const std::string& name, const std::string& why) {
  return Error(StatusCode::kInvalidArgument, "--" + name + " " + why);
}

/// False for a number flag whose value is not a number; gflags checks the range of the type.
bool HasValidType(const FlagInfo& flag, std::string_view value) {
  if (flag.type == "string" || flag.type == "bool") return true;
  const char* end = value.data() + value.size();
  double number = 0;
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  return error == std::errc() && rest == end && (flag.type == "double" || number == std::floor(number));
}

/// A flag and its value from the command line.
struct GivenFlag {
  const FlagInfo* info = nullptr;
  std::string value;
  std::size_t arguments = 1;  ///< Number of arguments used.
};

/// Checks the flag at the beginning of the arguments.
Result<GivenFlag> CheckFlag(std::span<const std::string> arguments, std::span<const FlagInfo> flags) {
  const std::string body = arguments[0].substr(arguments[0][1] == '-' ? 2 : 1);
  const std::size_t equals = body.find('=');
  const std::string name = body.substr(0, equals);
  const FlagInfo* flag = FindFlag(name, flags);
  if (flag == nullptr) return WrongFlag(name, "is not a flag of this tool; " + Suggestion(name, flags));
  const bool joined = equals != std::string::npos;
  if (flag->type == "bool" && !joined) return GivenFlag{flag, "", 1};
  if (!joined && arguments.size() == 1) return WrongFlag(name, "needs a value");
  const std::string value = joined ? body.substr(equals + 1) : arguments[1];
  if (value.empty()) return WrongFlag(name, "has an empty value; leave the flag out for its default");
  if (!HasValidType(*flag, value)) {
    return WrongFlag(name, "is '" + value + "'; it must be a" + (flag->type == "double" ? " number" : "n integer"));
  }
  return GivenFlag{flag, value, joined ? 1U : 2U};
}

/// gflags would silently use the last value. A repeated switch is allowed, because it has the same effect.
Result<void> CheckGivenOnce(const GivenFlag& flag, std::map<std::string, std::string>& values) {
  constexpr std::array<std::string_view, 5> kLists = {"data", "fix", "init", "bounds", "prior"};
  const std::string& name = flag.info->name;
  if (flag.info->type == "bool") return {};
  const auto [earlier, is_first] = values.emplace(name, flag.value);
  if (is_first) return {};
  if (std::ranges::find(kLists, name) == kLists.end()) return WrongFlag(name, "is given twice; leave one of them out");
  return WrongFlag(name, "is given twice; give all values in one flag, separated by commas: --" + name + " " +
                             earlier->second + "," + flag.value);
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

Result<std::vector<std::string>> PositionalArguments(std::span<const std::string> arguments,
                                                     std::span<const FlagInfo> flags) {
  std::vector<std::string> positional;
  std::map<std::string, std::string> values;
  bool flags_ended = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (flags_ended || argument.size() < 2 || argument[0] != '-') {
      positional.push_back(argument);
    } else if (argument == "--") {
      flags_ended = true;
    } else {
      const auto flag = CheckFlag(arguments.subspan(i), flags);
      if (!flag) return tl::unexpected(flag.error());
      if (const auto checked = CheckGivenOnce(*flag, values); !checked) return tl::unexpected(checked.error());
      i += flag->arguments - 1;
    }
  }
  return positional;
}

std::vector<std::string> ReplaceModelsAlias(std::vector<std::string> arguments) {
  for (std::string& argument : arguments) {
    if (argument == "--") break;
    const std::size_t dashes = argument.starts_with("--") ? 2 : 1;
    const std::string_view name = std::string_view(argument).substr(std::min(dashes, argument.size()));
    const bool is_match = argument.starts_with('-') && (name == "models" || name.starts_with("models="));
    if (is_match) argument.erase(dashes + std::string_view("model").size(), 1);
  }
  return arguments;
}

std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags) {
  constexpr int kWidth = 100;
  std::size_t longest = 0;
  for (const FlagInfo& flag : flags) longest = std::max(longest, flag.own ? flag.name.size() : 0);
  std::string text(usage);
  for (const FlagInfo& flag : flags) {
    if (!flag.own) continue;
    text += Paragraph(flag.help, "  --" + flag.name + std::string(longest - flag.name.size() + 2, ' '), kWidth);
  }
  return text;
}

}  // namespace pendulum
