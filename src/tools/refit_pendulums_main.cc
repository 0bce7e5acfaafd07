// SPDX-License-Identifier: Apache-2.0
// Refits batches of recordings into a store of results, and tells what is in it: flags and exit codes.
#include <string>
#include <vector>

#include <gflags/gflags.h>

#include "tools/flags.h"
#include "tools/refit_commands.h"
#include "tools/refit_pendulums_options.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

constexpr const char* kUsage =
    "Fits all recordings of a batch, as fit_pendulum fits one, into a store of results. Refits only what changed.\n"
    "\n"
    "  refit_pendulums --manifest runs.csv --models viscous,coulomb --store results.sqlite\n"
    "  refit_pendulums --data recordings --models all --store results.sqlite\n"
    "\n"
    "  refit_pendulums status  --store results.sqlite\n"
    "  refit_pendulums report  --store results.sqlite --out summary.html [--group_by rig] [--trend_by date]\n"
    "  refit_pendulums export  --store results.sqlite --out results.csv|results.jsonl\n"
    "  refit_pendulums compare before.sqlite after.sqlite\n"
    "  refit_pendulums pack    --manifest runs.csv --out runs.pack\n"
    "  refit_pendulums --manifest runs.csv --store out/shard-3.sqlite --shard 3/64\n"
    "  refit_pendulums missing --shard_dir out --shard_count 64\n"
    "  refit_pendulums merge   --shard_dir out --shard_count 64 --store results.sqlite\n"
    "\n"
    "A run that cannot be read or fitted has a row that says why. After an interruption the same command continues.\n"
    "Exit codes: 0 every run has its rows, 1 compare found a result that moved by more than its error, has another "
    "status or\n"
    "is missing, 2 wrong flags, 3 file or\n"
    "shards not found, 4 unreadable manifest or store, 5 no run, 70 a bug, 73 the store or an output cannot be "
    "written,\n"
    "75 terminated or the store is in use: try again, 130 interrupted.\n"
    "\n";

/// Names of the tool's flags on the command line; the tool sets libraries' flags itself.
std::vector<std::string> GivenFlags() {
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  std::vector<std::string> given;
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    if (IsOwnFlag(flag.filename, __FILE__) && !flag.is_default) given.push_back(flag.name);
  }
  return given;
}

using Flags = RefitFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  return {
      {"manifest", &Flags::manifest,
       "Runs to refit: CSV with the column path and optional columns id, rig, calibration, from_s, to_s, models and "
       "others, paths relative to the CSV file; or a file made by pack; - is standard input."},
      {"data", &Flags::data,
       "Instead of a manifest: folders (all *.csv, *.mat and *.zip files below), patterns such as "
       "'runs/**/*.txt' and files, between commas."},
      {"store", &Flags::store, "SQLite file of the results; it is created or updated."},
      {"force", &Flags::force, "Refits also runs whose data, rig, calibration, options and version have not changed."},
      {"retry_failed", &Flags::retry_failed,
       "Refits also runs that could not be fitted; default off, because the same files fail again."},
      {"shard", &Flags::shard,
       "k/N: refits only part k (from 0) of N, each into its own store out/shard-k.sqlite; default all."},
      {"scratch", &Flags::scratch, "Folder of a shard until it is complete; default beside the store."},
      {"checkpoint_s", &Flags::checkpoint_s,
       "Seconds between checkpoints of a shard, from which another attempt continues; default 60."},
      {"shard_dir", &Flags::shard_dir,
       "Folder of the stores shard-0.sqlite, shard-1.sqlite, ... of missing and merge."},
      {"shard_count", &Flags::shard_count, "How many shards there are."},
      {"out", &Flags::out, "Output of export (.csv or .jsonl), report (.html or .json) or pack."},
      {"group_by", &Flags::group_by,
       "Manifest column of the report: runs with the same value are of one rig; default rig if several are named, else "
       "all runs are of one rig."},
      {"trend_by", &Flags::trend_by,
       "Manifest column of the report, numbers or dates, over which trends are computed; default the position."},
  };
}

Result<int> Work(Flags flags) {
  flags.given = GivenFlags();
  const auto options = MakeRefitPendulumsOptions(flags);
  if (!options) return tl::unexpected(options.error());
  return RunRefitCommand(*options);
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(pendulum::kRefitToolName, __FILE__, pendulum::kUsage, pendulum::FlagTable(), pendulum::Work,
                           argc, argv);
}
