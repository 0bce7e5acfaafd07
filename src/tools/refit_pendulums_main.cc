// SPDX-License-Identifier: Apache-2.0
// Refits batches of recordings into a store of results, and tells what is in it: flags and exit codes.
#include <string>
#include <vector>

#include <gflags/gflags.h>

#include "tools/flags.h"
#include "tools/refit_commands.h"
#include "tools/refit_pendulums_options.h"
#include "tools/registered_run_flags.h"
#include "tools/run_tool.h"

DEFINE_string(manifest, "",
              "Runs to refit: CSV with the column path and optional columns id, rig, calibration, from_s, to_s, models "
              "and others, paths relative to the CSV file; or a file made by pack; - is standard input.");
DEFINE_string(data, "",
              "Instead of a manifest: folders (all *.csv, *.mat and *.zip files below), patterns such as "
              "'runs/**/*.txt' and files, between commas.");
DEFINE_string(store, "", "SQLite file of the results; it is created or updated.");
DEFINE_bool(force, false, "Refits also runs whose data, rig, calibration, options and version have not changed.");
DEFINE_bool(retry_failed, false,
            "Refits also runs that could not be fitted; default off, because the same files fail again.");
DEFINE_string(shard, "",
              "k/N: refits only part k (from 0) of N, each into its own store out/shard-k.sqlite; default all.");
DEFINE_string(scratch, "", "Folder of a shard until it is complete; default beside the store.");
DEFINE_double(checkpoint_s, 60,
              "Seconds between checkpoints of a shard, from which another attempt continues; default 60.");
DEFINE_string(shard_dir, "", "Folder of the stores shard-0.sqlite, shard-1.sqlite, ... of missing and merge.");
DEFINE_int64(shard_count, 0, "How many shards there are.");
DEFINE_string(out, "", "Output of export (.csv or .jsonl), report (.html or .json) or pack.");
DEFINE_string(group_by, "",
              "Manifest column of the report: runs with the same value are of one rig; default rig if several are "
              "named, else all runs are of one rig.");
DEFINE_string(trend_by, "",
              "Manifest column of the report, numbers or dates, over which trends are computed; default the position.");

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
    "status or\nis missing, 2 wrong flags, 3 file or\n"
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

RefitFlags CurrentFlags(const std::vector<std::string>& positional) {
  RefitFlags flags;
  static_cast<RunFlags&>(flags) = RegisteredRunFlags();
  flags.manifest = FLAGS_manifest;
  flags.data = FLAGS_data;
  flags.store = FLAGS_store;
  flags.shard = FLAGS_shard;
  flags.scratch = FLAGS_scratch;
  flags.shard_dir = FLAGS_shard_dir;
  flags.out = FLAGS_out;
  flags.group_by = FLAGS_group_by;
  flags.trend_by = FLAGS_trend_by;
  flags.checkpoint_s = FLAGS_checkpoint_s;
  flags.shard_count = FLAGS_shard_count;
  flags.force = FLAGS_force;
  flags.retry_failed = FLAGS_retry_failed;
  flags.positional = positional;
  flags.given = GivenFlags();
  return flags;
}

Result<int> Work(const std::vector<std::string>& positional) {
  const auto options = MakeRefitPendulumsOptions(CurrentFlags(positional));
  if (!options) return tl::unexpected(options.error());
  return RunRefitCommand(*options);
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  pendulum::RegisterRunFlags();
  return pendulum::RunTool({pendulum::kRefitToolName, __FILE__, pendulum::kUsage, pendulum::Work}, argc, argv);
}
