// SPDX-License-Identifier: Apache-2.0
// Refits batches of recordings into a store of results, and reports on stores: flags and exit codes.
#include <string>
#include <vector>

#include <gflags/gflags.h>

#include "pendulum/base/try.h"
#include "pendulum/recording/readers/file_names.h"
#include "tools/flags.h"
#include "tools/refit_commands.h"
#include "tools/refit_pendulums_options.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

constexpr const char* kUsage =
    "Fits all recordings of a batch as fit_pendulum does and stores the results. Refits only the runs that changed.\n"
    "\n"
    "  refit_pendulums runs.csv --models viscous,coulomb --store results.sqlite\n"
    "  refit_pendulums recordings/ --models all --store results.sqlite\n"
    "\n"
    "  refit_pendulums status  --store results.sqlite [--details]\n"
    "  refit_pendulums report  --store results.sqlite --out summary.html [--group_by rig] [--trend_by date]\n"
    "  refit_pendulums export  --store results.sqlite --out results.csv|results.jsonl\n"
    "  refit_pendulums compare before.sqlite after.sqlite\n"
    "  refit_pendulums prune   --store results.sqlite [--dry_run]\n"
    "  refit_pendulums pack    runs.csv --out runs.pack\n"
    "  refit_pendulums runs.csv --store out/shard-3.sqlite --shard 3/64\n"
    "  refit_pendulums missing --shard_dir out --shard_count 64\n"
    "  refit_pendulums merge   --shard_dir out --shard_count 64 --store results.sqlite\n"
    "\n"
    "A run that cannot be read or fitted gets a row that says why, or keeps its former result. After an interruption, "
    "repeat the same command.\n"
    "Exit codes: 0 done; a recording that is refused or not fitted is a stored result of a refit, too. 1 compare\n"
    "found a result that moved by more than its error, has another status, or is missing or stale in the second\n"
    "store. 2 wrong flags. 3 a file or shard does not exist; or, for a refit and merge, a run that should have a\n"
    "current result has none: its recording, rig or calibration is missing, it keeps a former result, or no run at\n"
    "all has one. status says the same in its first line and exits with 0. 4 the manifest or store cannot be read.\n"
    "5 there is no run. 70 a bug. 73 the store or an output cannot be written. 75 terminated, or the store is in\n"
    "use: try again. 130 interrupted.\n"
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
  static const std::string data_help =
      "Instead of a manifest: folders (all " + RecordingNames() +
      " files below), patterns such as 'runs/**/*.json' and files, separated by commas.";
  return {
      {"manifest", &Flags::manifest,
       "Runs to refit; may also be named without a flag: CSV file with the column path (relative to the CSV file) and "
       "optional columns such as id, rig, "
       "calibration, from_s, to_s and models; or a file made by pack; - is standard input."},
      {"data", &Flags::data, data_help.c_str()},
      {"store", &Flags::store, "SQLite file of the results; it is created or updated."},
      {"force", &Flags::force,
       "Also refits runs whose data, rig, calibration, options and version have not changed; default off."},
      {"retry_failed", &Flags::retry_failed,
       "Also refits runs that could not be fitted; default off, because the same files fail again."},
      {"replace_by_failures", &Flags::replace_by_failures,
       "Also replaces results of runs that can no longer be read or fitted, or whose recordings have become shorter; "
       "default off: such a run keeps its former result, which is marked stale and left out of statistics."},
      {"fit_seconds", &Flags::fit_seconds,
       "Longest time of the fit of one recording, s; one that takes longer gets a row with this reason, and another "
       "time tries it again; default 600."},
      {"dry_run", &Flags::dry_run,
       "For prune: only says what would be removed, which is what statistics leave out: fits of models that the last "
       "refit did not ask for, runs that keep a former result, and runs that it was not given."},
      {"details", &Flags::details,
       "Prints counts of fits, recommendations and failures, and the summary last; default: the summary alone."},
      {"quiet", &Flags::quiet,
       "Prints the parameters alone, a line each: name, median, standard deviation over the recordings, unit."},
      {"shard", &Flags::shard,
       "k/N: refits only part k (from 0) of N, each into its own store out/shard-k.sqlite; default all."},
      {"scratch", &Flags::scratch,
       "Folder for the store of a shard until it is complete; default the folder of --store."},
      {"checkpoint_s", &Flags::checkpoint_s,
       "Seconds between checkpoints of a shard; after an interruption, the next attempt continues from the last one; "
       "default 60."},
      {"shard_dir", &Flags::shard_dir,
       "For missing and merge: folder with the stores shard-0.sqlite, shard-1.sqlite, ..."},
      {"shard_count", &Flags::shard_count, "For missing and merge: number of shards, N of --shard."},
      {"out", &Flags::out, "Output file of export (.csv or .jsonl), report (.html or .json) or pack."},
      {"group_by", &Flags::group_by,
       "What tells the pendulums apart: a manifest column (recordings with the same value are repeats of one "
       "pendulum), "
       "folder, or all (all are of one); default the columns pendulum, group or rig_id, the true values of simulated "
       "recordings, or the rig files; without these, folders or all."},
      {"trend_by", &Flags::trend_by,
       "For report: manifest column of numbers or dates along which trends are computed; default the position in the "
       "manifest."},
  };
}

Result<int> Work(Flags flags) {
  flags.given = GivenFlags();
  ASSIGN_OR_RETURN(const auto options, MakeRefitPendulumsOptions(flags));
  return RunRefitCommand(options);
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(pendulum::kRefitToolName, __FILE__, pendulum::kUsage, pendulum::FlagTable(), pendulum::Work,
                           argc, argv);
}
