// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_pendulums_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/readers/file_names.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

/// A command, its required flags, and its optional flags. A refit takes all flags that are not reserved for another
/// command.
struct CommandFlags {
  std::string_view name;
  RefitCommand command;
  std::vector<std::string_view> needed, taken;
};

const std::vector<CommandFlags>& Commands() {
  static const std::vector<CommandFlags> commands = {
      {"status", RefitCommand::kStatus, {"store"}, {"group_by", "details", "quiet"}},
      {"export", RefitCommand::kExport, {"store", "out"}, {}},
      {"compare", RefitCommand::kCompare, {}, {}},
      {"report", RefitCommand::kReport, {"store", "out"}, {"group_by", "trend_by"}},
      {"pack", RefitCommand::kPack, {"out"}, {"manifest", "data"}},
      {"prune", RefitCommand::kPrune, {"store"}, {"dry_run"}},
      {"missing", RefitCommand::kMissing, {"shard_dir", "shard_count"}, {}},
      {"merge", RefitCommand::kMerge, {"shard_dir", "shard_count", "store"}, {}},
  };
  return commands;
}

bool Contains(const auto& names, std::string_view name) { return std::ranges::find(names, name) != names.end(); }

/// Flags that a refit does not have.
constexpr std::array<std::string_view, 5> kNotForRefit = {"out", "shard_dir", "shard_count", "trend_by", "dry_run"};

Result<void> CheckFlagsOf(const CommandFlags& command, const RefitFlags& flags) {
  for (const std::string_view name : command.needed) {
    if (!Contains(flags.given, name)) return BadFlag(std::string(command.name) + " needs --" + std::string(name));
  }
  for (const std::string& name : flags.given) {
    if (Contains(command.needed, name) || Contains(command.taken, name)) continue;
    return BadFlag("--" + name + " is not a flag of " + std::string(command.name) + "; leave it out");
  }
  const bool is_pack = command.command == RefitCommand::kPack;
  const std::size_t most = command.command == RefitCommand::kCompare ? 3 : is_pack ? flags.positional.size() : 1;
  if (flags.positional.size() <= most) return {};
  return BadFlag("'" + flags.positional[most] + "' does not belong to a flag of " + std::string(command.name));
}

Result<Shard> ParseShard(const std::string& text) {
  constexpr std::int64_t kMaxShards = 1000000000;
  Shard shard;
  const char* end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  if (error == std::errc() && slash != end && *slash == '/') {
    const auto [rest, wrong] = std::from_chars(slash + 1, end, shard.count);
    if (wrong == std::errc() && rest == end && shard.index >= 0 && shard.index < shard.count &&
        shard.count <= kMaxShards) {
      return shard;
    }
  }
  return BadFlag("--shard is '" + text + "'; it must be k/N, shard k from 0 to N - 1 of N");
}

/// Parses the source of the runs.
Result<void> ParseSource(const RefitFlags& flags, RefitPendulumsOptions& options) {
  if (!options.manifest.empty() || !options.patterns.empty()) {  // named without a flag
    if (flags.manifest.empty() && flags.data.empty()) return {};
    return BadFlag((flags.manifest.empty() ? "--data" : "--manifest") + std::string(" and '") +
                   flags.positional.back() + "' both name runs; give one of them");
  }
  if (flags.manifest.empty() == flags.data.empty()) {
    return BadFlag(flags.manifest.empty() ? "no runs were given; name their manifest, as in refit_pendulums runs.csv "
                                            "--store results.sqlite, or folders, patterns and files with --data"
                                          : "--manifest and --data both name runs; give one of them");
  }
  options.manifest = flags.manifest;
  options.patterns = Split(flags.data, ',');
  if (!Contains(options.patterns, "")) return {};
  return BadFlag("--data '" + flags.data + "' has an empty name between its commas");
}

/// Takes the arguments from number `first` on as the source of the runs: a manifest, or a folder, or several files.
void TakeSource(const RefitFlags& flags, std::size_t first, RefitPendulumsOptions& options) {
  const std::vector<std::string>& names = flags.positional;
  if (names.size() <= first) return;
  std::error_code unknown;
  if (names.size() == first + 1 && !std::filesystem::is_directory(names[first], unknown)) {
    options.manifest = names[first];
  } else {
    options.patterns.assign(names.begin() + static_cast<std::ptrdiff_t>(first), names.end());
  }
}

Result<void> ParseShardFlags(const RefitFlags& flags, RefitPendulumsOptions& options) {
  if (flags.shard.empty()) {
    if (Contains(flags.given, "scratch")) return BadFlag("--scratch is for a shard; give --shard too");
    if (Contains(flags.given, "checkpoint_s")) return BadFlag("--checkpoint_s is for a shard; give --shard too");
    return {};
  }
  ASSIGN_OR_RETURN(const auto shard, ParseShard(flags.shard));
  if (!std::isfinite(flags.checkpoint_s) || flags.checkpoint_s <= 0) {
    return BadFlag("--checkpoint_s is " + NumberText(flags.checkpoint_s) + "; it must be a positive number of seconds");
  }
  options.refit.shard = shard;
  options.shard.store = flags.store;
  options.shard.scratch = flags.scratch;
  options.shard.checkpoint = flags.checkpoint_s;
  return {};
}

/// The flags with which fit_pendulum fits a recording of the batch.
nlohmann::ordered_json FlagsOfARun(const RunFlags& flags) {
  RunFlags of_a_run = flags;
  of_a_run.threads.clear();
  if (of_a_run.model.empty()) of_a_run.model = kDefaultModel;  // without it the recording may choose a spring
  return GivenFlags(of_a_run);
}

Result<void> ParseRefit(const RefitFlags& given, RefitPendulumsOptions& options) {
  RefitFlags flags = given;
  std::error_code unknown;
  const bool is_file = !flags.positional.empty() && (flags.positional.size() > 1 || flags.positional[0] == "-" ||
                                                     std::filesystem::exists(flags.positional[0], unknown));
  if (is_file) {
    TakeSource(flags, 0, options);
  } else if (!flags.positional.empty() && flags.positional[0].find_first_of("*?[") != std::string::npos) {
    return WithTry(
        BadFlag("'" + flags.positional[0] + "' is a pattern and no existing file; give patterns with --data"),
        {"--data " + flags.positional[0]});
  } else if (!flags.positional.empty()) {
    const std::string& word = flags.positional.front();
    if (HasRecordingName(word) || word.find('/') != std::string::npos) {
      return ErrorAt(StatusCode::kNotFound, word, "there is no such file or folder; check the path");
    }
    std::vector<std::string_view> names;
    for (const CommandFlags& command : Commands()) names.push_back(command.name);
    return BadFlag("'" + word + "' is not a command, nor an existing file or folder; the commands are " +
                   NameList(names) + "; to refit, give a manifest or folder");
  }
  for (const std::string_view name : kNotForRefit) {
    if (Contains(flags.given, name))
      return BadFlag("--" + std::string(name) + " is not a flag of a refit; leave it out");
  }
  if (flags.store.empty()) return BadFlag("no store was given; name the file for the results with --store");
  RETURN_IF_ERROR(ParseSource(flags, options));
  if (flags.release == "all") {
    return BadFlag("--release all makes several results per run, but a batch stores one; give one release");
  }
  options.refit.flags = JsonText(FlagsOfARun(flags));
  RETURN_IF_ERROR(ReadSensorFile(flags.sensor));
  ASSIGN_OR_RETURN(auto run, MakeIdentifyOptions(flags));
  options.refit.threads = run.fit.threads;
  options.refit.run = std::move(run);
  // The store has a row for each model that was asked for.
  options.refit.run.fit.may_be_spring = options.refit.run.rig_chooses_gravity = false;
  constexpr double kDay = 86'400;
  if (!(flags.fit_seconds > 0 && flags.fit_seconds <= kDay)) {
    return BadFlag("--fit_seconds is " + NumberText(flags.fit_seconds) + "; it must be above 0 and at most 86400");
  }
  options.refit.fit_time = std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(1e3 * flags.fit_seconds)));
  options.refit.force = flags.force;
  options.refit.retry_failed = flags.retry_failed;
  options.refit.replace_by_failures = flags.replace_by_failures;
  options.summary.group_by = flags.group_by;
  options.rig = flags.rig;
  options.calibration = flags.calibration;
  return ParseShardFlags(flags, options);
}

Result<void> ParseOther(const CommandFlags& command, const RefitFlags& flags, RefitPendulumsOptions& options) {
  RETURN_IF_ERROR(CheckFlagsOf(command, flags));
  options.command = command.command;
  options.out = flags.out;
  options.shard_dir = flags.shard_dir;
  options.shard_count = flags.shard_count;
  options.summary = {flags.group_by, flags.trend_by, false};
  if (Contains(command.needed, "shard_count") && flags.shard_count < 1) {
    return BadFlag("--shard_count is " + std::to_string(flags.shard_count) + "; it must be at least 1");
  }
  if (command.command == RefitCommand::kPack) {
    TakeSource(flags, 1, options);
    return ParseSource(flags, options);
  }
  if (command.command != RefitCommand::kCompare) return {};
  if (flags.positional.size() != 3)
    return BadFlag("compare takes two stores: refit_pendulums compare a.sqlite b.sqlite");
  options.stores = {flags.positional[1], flags.positional[2]};
  return {};
}

}  // namespace

Result<RefitPendulumsOptions> MakeRefitPendulumsOptions(const RefitFlags& flags) {
  RefitPendulumsOptions options;
  if (!flags.store.empty()) options.stores = {flags.store};
  if (flags.details && flags.quiet) {
    return BadFlag("--details and --quiet contradict each other; give one of them");
  }
  options.dry_run = flags.dry_run;
  options.details = flags.details;
  options.quiet = flags.quiet;
  const auto& commands = Commands();
  const auto found =
      flags.positional.empty() ? commands.end() : std::ranges::find(commands, flags.positional[0], &CommandFlags::name);
  RETURN_IF_ERROR(found == commands.end() ? ParseRefit(flags, options) : ParseOther(*found, flags, options));
  return options;
}

}  // namespace pendulum
