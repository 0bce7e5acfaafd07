// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/refit.h"
#include "pendulum/batch/shards.h"
#include "pendulum/batch/summary.h"
#include "pendulum/request/run_flags.h"

namespace pendulum {

/// The flags of refit_pendulums as they were given; empty, or the default, where they were not.
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
  bool force = false;
  bool retry_failed = false;
  std::vector<std::string> positional;  ///< The command, and what belongs to it.
  std::vector<std::string> given;       ///< Names of the flags that were given.
};

/// What refit_pendulums can do.
enum class RefitCommand { kRefit, kStatus, kExport, kCompare, kReport, kPack, kMissing, kMerge };

/// What refit_pendulums is asked to do.
struct RefitPendulumsOptions {
  RefitCommand command = RefitCommand::kRefit;
  std::string manifest;               ///< Path of a manifest or a packed file; empty: `patterns` instead.
  std::vector<std::string> patterns;  ///< Folders, patterns and files.
  std::string rig, calibration;       ///< Paths of those of the whole batch; empty for none.
  std::vector<std::string> stores;    ///< One; of compare two.
  std::string out;                    ///< Of export, report and pack.
  std::string shard_dir;
  std::int64_t shard_count = 0;
  RefitOptions refit;  ///< Rig and calibration are for the caller to read.
  ShardOptions shard;  ///< Of a shard; its attempt is for the caller to name.
  SummaryOptions summary;
};

/// Turns flags into options. kInvalidArgument: no such command, a flag that it needs is missing, or one that is not its
/// own, a wrong value; the message names the flag.
Result<RefitPendulumsOptions> MakeRefitPendulumsOptions(const RefitFlags& flags);

}  // namespace pendulum
