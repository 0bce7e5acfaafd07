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

#include "pendulum/base/try.h"
#include "pendulum/base/version.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/request/flag_values.h"
#include "pendulum/request/run_flags.h"
#include "tools/completion.h"
#include "tools/help.h"

DECLARE_bool(help);
DECLARE_bool(helpfull);
DECLARE_bool(helpshort);
DECLARE_bool(helppackage);
DECLARE_bool(helpxml);
DECLARE_bool(version);
DEFINE_string(completion, "", "Prints a script that completes the flags in a shell: bash, zsh or fish.");

namespace pendulum {
namespace {

bool gflags_is_parsing = false;

/// gflags exits with 1 on a flag that it refuses; the tools use 2.
void ExitWithTwo() {
  if (gflags_is_parsing) std::_Exit(ExitCode(StatusCode::kInvalidArgument));
}

/// The values of a flag if they are words.
std::vector<std::string> WordsOf(std::string_view name, bool is_run_flag) {
  std::vector<std::string> words;
  if (name == "model") {
    for (const MotionModel& model : MotionModels()) words.emplace_back(model.name);
    words.emplace_back("all");
  }
  if (!is_run_flag) return words;
  const auto& table = RunFlagTable();
  const auto flag = std::ranges::find(table, name, &RunFlag::name);
  if (flag == table.end()) return words;
  for (const auto& [word, label] : flag->words) {
    if (!word.empty() && word.find(' ') == std::string_view::npos) words.emplace_back(word);  // shells split at blanks
  }
  return words;
}

bool IsPathFlag(const std::string& name, const std::string& type) {
  constexpr std::array<std::string_view, 22> kPaths = {
      "data",      "data_list", "manifest",          "rig",  "calibration", "json",  "report",
      "residuals", "series",    "markdown",          "plot", "out",         "truth", "store",
      "scratch",   "shard_dir", "store_calibration", "port", "token_file",  "live",  "docs",
      "flagfile"};
  return type == "string" && std::ranges::find(kPaths, name) != kPaths.end();
}

std::vector<FlagInfo> RegisteredFlags(std::string_view main_file) {
  std::vector<gflags::CommandLineFlagInfo> registered;
  gflags::GetAllFlags(&registered);
  std::vector<FlagInfo> flags;
  const bool has_run_flags =
      std::ranges::find(registered, "closed_form_only", &gflags::CommandLineFlagInfo::name) != registered.end();
  for (const gflags::CommandLineFlagInfo& flag : registered) {
    if (flag.name == "help" || flag.name == "version") continue;
    const bool own = flag.name == "completion" || IsOwnFlag(flag.filename, main_file);
    flags.push_back({flag.name, flag.description, flag.type, own, WordsOf(flag.name, own && has_run_flags),
                     IsPathFlag(flag.name, flag.type)});
  }
  flags.push_back({"help", "Print this text (also -h); --helpfull adds the flags of libraries.", "bool", true});
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

/// The output of a flag that asks for a text instead of work; empty if there is none.
Result<std::string> AnswerOf(const std::string& program, std::string_view usage, std::span<const FlagInfo> flags) {
  if (FLAGS_helpfull) return FullHelpText(usage, flags);
  if (FLAGS_help || FLAGS_helpshort || FLAGS_helppackage || FLAGS_helpxml) return HelpText(usage, flags);
  if (FLAGS_version) return program + " " + std::string(kVersion) + "\n";
  if (!FLAGS_completion.empty()) return CompletionScript(FLAGS_completion, program, flags);
  return std::string();
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
  arguments = ReplaceAliases({argv + 1, argv + argc}, has_model);
  for (int i = 1; i < argc; ++i) argv[i] = arguments[static_cast<std::size_t>(i - 1)].data();
  ASSIGN_OR_RETURN(auto positional, PositionalArguments(arguments, flags));
  std::atexit(ExitWithTwo);
  gflags_is_parsing = true;
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  gflags_is_parsing = false;
  ASSIGN_OR_RETURN(std::string answer, AnswerOf(std::filesystem::path(argv[0]).filename().string(), usage, flags));
  return ParsedFlags{std::move(answer), std::move(positional)};
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
      ASSIGN_OR_RETURN(const auto flag, CheckFlag(arguments.subspan(i), flags));
      RETURN_IF_ERROR(CheckGivenOnce(flag, values));
      i += flag.arguments - 1;
    }
  }
  return positional;
}

std::vector<std::string> ReplaceAliases(std::vector<std::string> arguments, bool has_model) {
  for (std::string& argument : arguments) {
    if (argument == "--") break;
    if (argument == "-h") argument = "--help";
    const std::size_t dashes = argument.starts_with("--") ? 2 : 1;
    const std::string_view name = std::string_view(argument).substr(std::min(dashes, argument.size()));
    const bool is_models = argument.starts_with('-') && (name == "models" || name.starts_with("models="));
    if (has_model && is_models) argument.erase(dashes + std::string_view("model").size(), 1);
  }
  return arguments;
}

}  // namespace pendulum
