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

/// Options for refitting one shard of a batch while other attempts at it may run. An attempt works in its own file. It
/// publishes whole copies of this file: as the checkpoint `store`.part meanwhile, and as `store` at the end.
struct ShardOptions {
  std::filesystem::path store;    ///< out/shard-3.sqlite
  std::filesystem::path scratch;  ///< Folder of the attempt, such as a node's local disk; empty: next to the store.
  std::string attempt;            ///< Unique among all attempts on all machines.
  double checkpoint = 60;         ///< Time between checkpoints, s.
};

/// Refits options.shard, starting from the store or its checkpoint. At the end the store is published, if it has
/// changed, and the checkpoint is removed. After a stop the checkpoint is published instead. Errors as Refit;
/// kInvalidArgument: the store belongs to a whole batch.
Result<RefitCounts> RefitShard(const Source& source, const ShardOptions& shard, const RefitOptions& options);

/// out/shard-K.sqlite
std::filesystem::path ShardPath(const std::filesystem::path& folder, std::int64_t index);

/// "3,17"
std::string ShardList(const std::vector<std::int64_t>& shards);

/// Increasing indices of those of the `count` shards that are missing, incomplete or damaged. kDataLoss: a file is not
/// a store, or belongs to another shard or another number of shards. kNotFound: no such folder.
Result<std::vector<std::int64_t>> MissingShards(const std::filesystem::path& folder, std::int64_t count);

/// Merges all shards into a store. Rows of the same runs are replaced. The store is replaced as a whole at the end, so
/// a merge can be repeated at any time. Removes checkpoints and files of attempts from the folder; attempts still
/// running fail, but are no longer needed. Returns the number of merged runs. kNotFound: shards are missing; the
/// message names them. kDataLoss: the shards belong to different batches. kInvalidArgument: the store is itself a
/// shard. kTryAgain: another process writes to the store.
Result<std::int64_t> MergeShards(const std::filesystem::path& folder, std::int64_t count,
                                 const std::filesystem::path& store);

}  // namespace pendulum
