// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/refit.h"
#include "pendulum/batch/shards.h"
#include "pendulum/batch/summary.h"
#include "pendulum/request/run_flags.h"

namespace pendulum {

/// The flags of refit_pendulums as given; empty or the default if not given.
struct RefitFlags : RunFlags {
  std::string manifest;
  std::string data;
  std::string store;
  std::string shard;
  std::string scratch;
  std::string shard_dir;
  std::string out;
  std::string group_by;
  std::string trend_by;
  double checkpoint_s = 60;
  std::int64_t shard_count = 0;
  double fit_seconds = 600;
  bool force = false;
  bool retry_failed = false;
  bool replace_by_failures = false;
  bool dry_run = false;
  bool details = false;
  bool quiet = false;
  std::vector<std::string> positional;  ///< The command and its arguments, or the runs of a refit.
  std::vector<std::string> given;       ///< Names of the given flags.
};

/// The commands of refit_pendulums.
enum class RefitCommand { kRefit, kStatus, kExport, kCompare, kReport, kPack, kPrune, kMissing, kMerge };

/// The task of refit_pendulums.
struct RefitPendulumsOptions {
  RefitCommand command = RefitCommand::kRefit;
  std::string manifest;               ///< Path of a manifest or a packed file; empty: use `patterns`.
  std::vector<std::string> patterns;  ///< Folders, patterns and files.
  std::string rig, calibration;       ///< Paths for the whole batch; empty: none.
  std::vector<std::string> stores;    ///< One; two for compare.
  std::string out;                    ///< Output path of export, report and pack.
  std::string shard_dir;
  std::int64_t shard_count = 0;
  RefitOptions refit;  ///< The caller reads rig and calibration.
  ShardOptions shard;  ///< Options of a shard; the caller names its attempt.
  SummaryOptions summary;
  bool dry_run = false;  ///< Prune only says what it would remove.
  bool details = false;  ///< Also prints counts of fits, recommendations and failures.
  bool quiet = false;    ///< Prints the parameters alone.
};

/// Converts flags to options. kInvalidArgument: an unknown command, a missing required flag, a flag of another command,
/// a wrong value; the message names the flag.
Result<RefitPendulumsOptions> MakeRefitPendulumsOptions(const RefitFlags& flags);

}  // namespace pendulum
