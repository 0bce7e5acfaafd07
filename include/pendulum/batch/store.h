// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/manifest.h"
#include "pendulum/batch/provenance.h"
#include "pendulum/batch/source.h"

namespace SQLite {  // NOLINT(readability-identifier-naming): SQLiteCpp's
class Database;
}

namespace pendulum {

/// Number k, from 0, of `count` (a thousand million at most) parts of a batch of R runs: those of positions [R k / N, R
/// (k + 1) / N).
struct Shard {
  std::int64_t index = 0;
  std::int64_t count = 1;

  std::int64_t Begin(std::int64_t runs) const { return Cut(runs, index); }
  std::int64_t End(std::int64_t runs) const { return Cut(runs, index + 1); }

 private:
  std::int64_t Cut(std::int64_t runs, std::int64_t k) const;
};

/// What came of a run.
struct RunOutcome {
  Provenance provenance;
  int exit_code = 0;                ///< As of fit_pendulum.
  std::string reason;               ///< Why it could not be fitted; empty where it could.
  std::vector<std::string> models;  ///< That were asked for: where there is no result, each has a failed row.
  nlohmann::ordered_json result;    ///< ToJson of its report; null where it could not be fitted.
};

/// A run of the batch, and what the store knows of it.
struct StoredRun {
  ManifestEntry entry;           ///< Without `place`.
  std::optional<int> exit_code;  ///< None: not refitted yet.
  Provenance provenance;         ///< Of its rows, if it has any.
};

/// What a store is about.
struct StoreMeta {
  std::string version, manifest_sha256, options_sha256;
  std::optional<Shard> shard;  ///< None: all of the manifest.
  std::int64_t runs = 0;       ///< Of the manifest, all shards together.
  bool complete = false;
};

/// Runs of a store, counted.
struct StoreCounts {
  std::int64_t runs = 0, pending = 0, unfitted = 0;  ///< All; not refitted yet; those that could not be fitted.
  std::int64_t earlier = 0;                          ///< Those that the last manifest did not name.
  std::int64_t fits = 0, failed = 0;                 ///< Rows of (run, model); those of them with status failed.
};

/// The results of a batch in an SQLite file, whose tables explain themselves (store_schema.h). What is put in is
/// durable from the next Commit on; a process that dies in between, or a machine without power, loses what came after
/// the last one, and no more. Any number of processes may read meanwhile, one may write, for whose commits a reader has
/// to end within ten minutes. Not for several threads at a time. Errors of all functions: kCannotWrite, no room or no
/// permission; kTryAgain, another process has the file; kDataLoss, it is damaged.
class Store {
 public:
  enum class Mode { kRead, kWrite, kServe };

  /// kRead: kNotFound, no such file. The others make one that is not there, and bring older ones up to date; kServe
  /// keeps a log beside it while it is open, so that writing waits for no reader. kDataLoss: no store, or one of a
  /// newer version.
  static Result<Store> Open(const std::filesystem::path& path, Mode mode);

  Store(Store&& other) noexcept;
  Store(const Store&) = delete;
  Store& operator=(Store&& other) noexcept;
  Store& operator=(const Store&) = delete;
  ~Store();

  /// Takes the entries of a source, all or a shard of them, for the batch to come: new ones are added, those with an id
  /// that is known replace what the manifest said of it, others stay as they are. All or nothing. `options_json`: what
  /// is asked of all fits. kDataLoss: an id twice; kFailedPrecondition: there is no entry.
  Result<StoreMeta> Begin(const Source& source, const std::optional<Shard>& shard, const std::string& options_json);

  /// At most `most` runs of the batch from `position` on, in that order.
  Result<std::vector<StoredRun>> Next(std::int64_t position, int most);

  /// Replaces all rows of a run.
  Result<void> Put(const std::string& id, const RunOutcome& outcome);

  Result<void> Commit();

  /// Begins what the next Commit makes durable, unless that has begun.
  Result<void> BeginWrite();

  /// Forgets what came since the last Commit.
  void Rollback();

  /// Adds a run that belongs to no manifest; its position is its number, as
  /// it comes, from 0. kInternal: the id is known.
  Result<std::int64_t> Add(const ManifestEntry& entry);

  /// Commits that every run of the batch has its rows.
  Result<void> Complete();

  /// Reads all pages and indices. kDataLoss: they do not fit together.
  Result<void> Check();

  /// Once it is set, which must outlive the store, readers have two seconds instead of ten minutes.
  void HurryOn(const std::atomic<bool>* stop);

  Result<StoreMeta> Meta();
  Result<StoreCounts> Count();

  const std::string& name() const;

  /// For queries of what is exported, compared, summed up.
  SQLite::Database& database();

 private:
  struct State;
  explicit Store(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace pendulum
