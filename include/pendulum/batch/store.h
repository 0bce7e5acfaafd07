// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/manifest.h"
#include "pendulum/batch/provenance.h"
#include "pendulum/batch/reason.h"
#include "pendulum/batch/source.h"

namespace SQLite {  // NOLINT(readability-identifier-naming): SQLiteCpp's
class Database;
}

namespace pendulum {

/// One of `count` (at most a thousand million) parts of a batch; `index` begins at 0. With k = index and N = count, it
/// has the positions [R k / N, R (k + 1) / N) of R runs.
struct Shard {
  std::int64_t index = 0;
  std::int64_t count = 1;

  std::int64_t Begin(std::int64_t runs) const { return Cut(runs, index); }
  std::int64_t End(std::int64_t runs) const { return Cut(runs, index + 1); }

 private:
  std::int64_t Cut(std::int64_t runs, std::int64_t k) const;
};

/// The outcome of a run.
struct RunOutcome {
  Provenance provenance;
  int exit_code = 0;                ///< Exit code of fit_pendulum.
  Reason reason;                    ///< Why the run could not be fitted; empty if it was fitted.
  std::vector<std::string> models;  ///< The requested models; if there is no result, each gets a failed row.
  nlohmann::ordered_json result;    ///< ToJson of the identification; null if the run could not be fitted.
};

/// A run of the batch with its state in the store.
struct StoredRun {
  ManifestEntry entry;           ///< Without `place`.
  std::optional<int> exit_code;  ///< std::nullopt: not refitted yet.
  Provenance provenance;         ///< Provenance of its rows, if there are any.
  std::string stale;             ///< Why the last attempt left these rows in place; empty: they are current.
  std::string attempt;           ///< What that attempt was made with.
};

/// Data about the whole store.
struct StoreMeta {
  std::string version, manifest_sha256, options_sha256;
  std::optional<Shard> shard;  ///< std::nullopt: the whole manifest.
  std::int64_t runs = 0;       ///< Runs of the manifest, over all shards.
  bool complete = false;
  std::string began, ended;  ///< Of the last refit, RFC 3339, UTC; empty: not known, or not ended.
  std::string flags;   ///< A JSON object: the flags of fit_pendulum that the last refit was given; empty: not known.
  std::string folder;  ///< The paths of runs are relative to it, from where the last refit was started.

  /// A refit was stopped before its end, or is running.
  bool is_interrupted() const { return !complete && !manifest_sha256.empty(); }
};

/// What is said of a store whose meta data is_interrupted().
inline constexpr std::string_view kNotComplete = "the last refit is not complete";

/// Counts of a store's runs and fits.
struct StoreCounts {
  /// All runs, those not refitted yet, those that could not be fitted, and of these the ones without a recording.
  std::int64_t runs = 0, pending = 0, unfitted = 0, missing = 0;
  std::int64_t stale = 0;             ///< Runs of the last manifest that keep a former result.
  std::int64_t earlier = 0;           ///< Runs that are not in the last manifest.
  std::int64_t fits = 0, failed = 0;  ///< Rows (run, model), and those with status failed.
  std::int64_t former_fits = 0;       ///< Further rows, of models that the last refit did not ask for.
  std::int64_t fitted = 0;            ///< Runs of the last manifest with a current result that converged.
  std::int64_t without_file = 0;      ///< Runs of the last manifest whose recording, rig or calibration is missing.

  /// Whether a run that should have a current result has none: it keeps a former one, or one of its files is missing,
  /// or no run at all has one. The content of a single recording may be refused or not be fitted.
  bool lacks_results() const { return stale > 0 || without_file > 0 || (runs > earlier && fitted == 0); }
};

/// The results of a batch in an SQLite file with self-explaining tables (store_schema.h). Data is durable after the
/// next Commit. A crash or a loss of power loses only what was written after the last Commit. Any number of processes
/// may read while one writes; a commit waits up to ten minutes for readers to finish. For one thread at a time. Errors
/// of all functions: kCannotWrite, no space or no permission; kTryAgain, another process uses the file; kDataLoss, it
/// is damaged.
class Store {
 public:
  enum class Mode { kRead, kWrite, kServe };

  /// Updates a store of an older version. kRead needs an existing file (kNotFound: no such file); other modes create a
  /// missing file. kServe keeps a log next to the file while it is open, so writers do not wait for readers. kDataLoss:
  /// not a store, or a newer version.
  static Result<Store> Open(const std::filesystem::path& path, Mode mode);

  Store(Store&& other) noexcept;
  Store(const Store&) = delete;
  Store& operator=(Store&& other) noexcept;
  Store& operator=(const Store&) = delete;
  ~Store();

  /// Starts a batch with all entries of a source, or with a shard of them. An entry with a new id is added; an entry
  /// with a known id replaces the manifest's data of that run. Other runs are removed, except runs of a service and,
  /// without a shard, runs with results. An error changes nothing. `options_json`: the options of all fits; if they are
  /// not those of the last batch, all results become stale until they are replaced or MarkCurrent. kDataLoss: a
  /// repeated id; kFailedPrecondition: there is no entry. `check` is called last; its error is returned.
  Result<StoreMeta> Begin(const Source& source, const std::optional<Shard>& shard, const std::string& options_json,
                          const std::function<Result<void>()>& check = {});

  /// Returns up to `max_runs` runs of the batch from `position` on, in order.
  Result<std::vector<StoredRun>> Next(std::int64_t position, int max_runs);

  /// Replaces the rows of a run. Its fits of models that the outcome does not have stay, and are marked stale.
  Result<void> Put(const std::string& id, const RunOutcome& outcome);

  /// Whether there is no file at the path of a recording.
  using IsGone = std::function<bool(const std::string& path)>;

  /// As Put, but keeps the result of a run if the outcome has none, does not converge as the result does, or has fewer
  /// samples, of the same path or while the former one `is_gone`; the rows are then marked stale. `attempt`: what the
  /// outcome was made with. Returns why the rows were kept; empty if they were replaced.
  Result<std::string> PutUnlessWorse(const std::string& id, const RunOutcome& outcome, const std::string& attempt,
                                     const IsGone& is_gone);

  /// Marks the results of the batch whose rig or calibration is not the file that the source has now, because it
  /// changed during the refit. Returns their number.
  Result<std::int64_t> MarkChangedFiles(const Source& source);

  /// A run of the batch without a result takes the rows of a run that the batch does not name, if that run is the same
  /// under another name: it has a result of a recording with these bytes, the same
  /// window,
  /// rig, calibration and models, and the same path or one that `is_gone`. Of several such runs none is taken. Returns
  /// whether one was taken.
  Result<bool> TakeOver(const std::string& id, const std::string& data_sha256, const IsGone& is_gone);

  /// Marks all results of the batch as former ones, which the next refit replaces whatever their inputs are.
  Result<void> MarkBatch();

  /// Marks the rows of a run as current: the inputs of its result have come back.
  Result<void> MarkCurrent(const std::string& id);

  Result<void> Commit();

  /// Begins a transaction unless one is open. The next Commit makes it durable.
  Result<void> BeginWrite();

  /// Discards all changes since the last Commit.
  void Rollback();

  /// Adds a run that belongs to no manifest; its position is its number, in the order of arrival, from 0. kInternal:
  /// the id is known.
  Result<std::int64_t> Add(const ManifestEntry& entry);

  /// Commits, and records that every run of the batch has its rows.
  Result<void> Complete();

  /// Reads all pages and indices. kDataLoss: they are inconsistent.
  Result<void> Check();

  /// The clock for the times in the store, instead of the current time in UTC.
  void SetClock(std::function<std::string()> now);

  /// Stores what a command needs that fits one run of the batch again (StoreMeta::flags, folder). The next Commit makes
  /// it durable.
  Result<void> KeepCommand(const std::string& flags, const std::string& folder);

  /// When `stop` is true, commits wait two seconds for readers instead of ten minutes. `stop` must outlive the store.
  void ShortenWaitsOnStop(const std::atomic<bool>* stop);

  Result<StoreMeta> Meta();
  Result<StoreCounts> Count();

  const std::string& name() const;

  /// The database, for the queries of exports, comparisons and summaries.
  SQLite::Database& database();

 private:
  struct State;
  explicit Store(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace pendulum
