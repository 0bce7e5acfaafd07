// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/refit.h"
#include "pendulum/batch/source.h"

namespace pendulum {

/// How one shard of a batch is refitted where another attempt at it may be alive: an attempt works in a file of its own
/// and only ever renames whole stores to the names that others look at, `store` and its checkpoint `store`.part.
struct ShardOptions {
  std::filesystem::path store;    ///< out/shard-3.sqlite
  std::filesystem::path scratch;  ///< Folder of the attempt, such as a node's own disk; empty: beside the store.
  std::string attempt;            ///< Unlike that of any other attempt, on any machine.
  double checkpoint = 60;         ///< Between checkpoints, s.
};

/// Refits options.shard, beginning with what the store or its checkpoint has. Unless it was stopped the store is
/// published at the end, if there is anything new, and the checkpoint goes; else the checkpoint is. Errors as Refit;
/// kInvalidArgument: the store is that of a whole batch.
Result<RefitCounts> RefitShard(const Source& source, const ShardOptions& shard, const RefitOptions& options);

/// out/shard-K.sqlite
std::filesystem::path ShardPath(const std::filesystem::path& folder, std::int64_t index);

/// "3,17"
std::string ShardList(const std::vector<std::int64_t>& shards);

/// The shards of so many that are not complete in the folder, or damaged, increasing. kDataLoss: one is no store, or
/// belongs to another number of shards. kNotFound: no such folder.
Result<std::vector<std::int64_t>> MissingShards(const std::filesystem::path& folder, std::int64_t count);

/// Puts all shards into a store, replacing what that has of their runs; the store is replaced as a whole at the end, so
/// that this may be done again at any time. Removes checkpoints and the files of attempts from the folder: an attempt
/// that is still alive, which nobody needs any more, fails. Gives the number of runs that were merged. kNotFound:
/// shards are missing; the message names them. kDataLoss: shards of different batches. kInvalidArgument: the store is
/// a shard itself. kTryAgain: another process writes to the store.
Result<std::int64_t> MergeShards(const std::filesystem::path& folder, std::int64_t count,
                                 const std::filesystem::path& store);

}  // namespace pendulum
