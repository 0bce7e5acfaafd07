// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/shards.h"

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "batch/kept_result.h"
#include "batch/sqlite.h"
#include "batch/store_queries.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/store_lock.h"
#include "pendulum/batch/temporary_store.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

/// The meta data of the store with that path; std::nullopt if it is not a store.
std::optional<StoreMeta> MetaOf(const fs::path& path) {
  auto store = Store::Open(path, Store::Mode::kRead);
  if (!store) return std::nullopt;
  const auto meta = store->Meta();
  return meta ? std::optional(*meta) : std::nullopt;
}

bool IsSameBatch(const StoreMeta& one, const StoreMeta& other) {
  return one.version == other.version && one.manifest_sha256 == other.manifest_sha256 &&
         one.options_sha256 == other.options_sha256 && one.shard.has_value() == other.shard.has_value() &&
         (!one.shard || one.shard->count == other.shard->count);
}

bool IsSound(const fs::path& path) {
  auto store = Store::Open(path, Store::Mode::kRead);
  return store && store->Check();
}

/// Copies the store from which an attempt starts, if there is one: the checkpoint, which also contains the rows of the
/// earlier store, otherwise the earlier store. Skips damaged files and files that another attempt removes meanwhile.
Result<void> CopyBeginning(const ShardOptions& shard, const fs::path& attempt) {
  for (const fs::path& path : {WithSuffix(shard.store, ".part"), shard.store}) {
    if (!IsSound(path)) continue;
    auto copied = Publish(path, attempt);
    if (copied || copied.error().code != StatusCode::kNotFound) return copied;
  }
  return {};
}

/// Refits into the attempt's own file, and publishes it as the checkpoint from time to time and after a stop.
Result<RefitCounts> Attempt(const Source& source, const ShardOptions& shard, RefitOptions options,
                            const fs::path& attempt) {
  using Clock = std::chrono::steady_clock;
  ASSIGN_OR_RETURN(auto store, Store::Open(attempt, Store::Mode::kWrite));
  const fs::path checkpoint = WithSuffix(shard.store, ".part");
  auto last = Clock::now();
  options.committed = [&]() -> Result<void> {
    if (std::chrono::duration<double>(Clock::now() - last).count() < shard.checkpoint) return {};
    auto published = Publish(attempt, checkpoint);
    last = Clock::now();
    return published;
  };
  auto counts = Refit(source, store, options);
  if (!counts || !counts->stopped) return counts;
  RETURN_IF_ERROR(Publish(attempt, checkpoint));
  return counts;
}

}  // namespace

Result<RefitCounts> RefitShard(const Source& source, const ShardOptions& shard, const RefitOptions& options) {
  const fs::path folder = shard.scratch.empty() ? shard.store.parent_path() : shard.scratch;
  const TemporaryStore attempt(folder / (shard.store.filename().string() + ".attempt-" + shard.attempt));
  RETURN_IF_ERROR(CheckFolderOf(shard.store));
  const auto before = MetaOf(shard.store);
  if (before && !before->shard) {
    return ErrorAt(StatusCode::kInvalidArgument, shard.store.string(),
                   "this is the store of a whole batch, which a shard would replace; "
                   "name a file such as out/shard-" +
                       std::to_string(options.shard ? options.shard->index : 0) + ".sqlite");
  }
  RETURN_IF_ERROR(CopyBeginning(shard, attempt.path()));
  auto counts = Attempt(source, shard, options, attempt.path());
  if (!counts || counts->stopped) return counts;
  const auto after = MetaOf(attempt.path());
  const bool is_new = counts->refitted > 0 || counts->restored > 0 || !before || !before->complete || !after ||
                      !IsSameBatch(*before, *after) || before->shard->index != after->shard->index;
  if (is_new) {
    RETURN_IF_ERROR(Publish(attempt.path(), shard.store));
  }
  std::error_code unknown;
  fs::remove(WithSuffix(shard.store, ".part"), unknown);
  return counts;
}

fs::path ShardPath(const fs::path& folder, std::int64_t index) {
  return folder / ("shard-" + std::to_string(index) + ".sqlite");
}

std::string ShardList(const std::vector<std::int64_t>& shards) {
  std::string list;
  for (const std::int64_t k : shards) list += (list.empty() ? "" : ",") + std::to_string(k);
  return list;
}

Result<std::vector<std::int64_t>> MissingShards(const fs::path& folder, std::int64_t count) {
  std::error_code unknown;
  if (!fs::is_directory(folder, unknown)) {
    return ErrorAt(StatusCode::kNotFound, folder.string(), "there is no such folder; check the path");
  }
  std::vector<std::int64_t> missing;
  for (std::int64_t k = 0; k < count; ++k) {
    const fs::path path = ShardPath(folder, k);
    if (!fs::exists(path, unknown)) {
      missing.push_back(k);
      continue;
    }
    auto store = Store::Open(path, Store::Mode::kRead);
    if (!store) return tl::unexpected(store.error());
    ASSIGN_OR_RETURN(const auto meta, store->Meta());
    if (!meta.shard || meta.shard->index != k || meta.shard->count != count) {
      const std::string found =
          meta.shard ? "shard " + std::to_string(meta.shard->index) + "/" + std::to_string(meta.shard->count)
                     : "a whole batch";
      return Fault(path.string(), "this is the store of " + found + ", not of shard " + std::to_string(k) + "/" +
                                      std::to_string(count) +
                                      "; give the number of shards with which it was made, or another folder");
    }
    if (!meta.complete || !store->Check()) missing.push_back(k);
  }
  return missing;
}

namespace {

/// A table's columns except `run`, with a prefix, separated by commas.
std::string ColumnsOf(SQLite::Database& database, const std::string& table, const char* prefix = "") {
  SQLite::Statement columns(database,
                            "SELECT group_concat(? || name, ', ') FROM pragma_table_info(?) WHERE name <> 'run'");
  sqlite::Bind(columns, prefix, table).executeStep();
  return sqlite::Text(columns, 0);
}

/// "id = excluded.id, ..." for all columns except `run`.
std::string AssignmentsOf(SQLite::Database& database, const std::string& table) {
  SQLite::Statement columns(database,
                            "SELECT group_concat(name || ' = excluded.' || name, ', ') "
                            "FROM pragma_table_info(?) WHERE name <> 'run'");
  sqlite::Bind(columns, table).executeStep();
  return sqlite::Text(columns, 0);
}

/// Copies the rows of a table of the attached store `shard`, for the runs in `shard` that are not kept.
void CopyRows(SQLite::Database& database, const std::string& table) {
  database.exec("INSERT INTO main." + table + "(run, " + ColumnsOf(database, table) + ") SELECT mine.run, " +
                ColumnsOf(database, table, "theirs.") + " FROM shard." + table +
                " AS theirs JOIN shard.runs AS their_run USING(run) JOIN main.runs AS mine ON mine.id = their_run.id "
                "WHERE mine.id NOT IN (SELECT id FROM kept)");
}

/// Lists in the table `kept` the runs whose result stays (WhyKept) instead of that of the attached store `shard`; they
/// become stale.
void KeepFormerResults(SQLite::Database& database) {
  database.exec(
      "DROP TABLE IF EXISTS temp.kept; CREATE TEMP TABLE kept(id TEXT PRIMARY KEY, stale TEXT, place TEXT, sentence "
      "TEXT)");
  SQLite::Statement both(database, R"sql(
SELECT id, mine.result, coalesce(theirs.result, ''), coalesce(theirs.place, ''), coalesce(theirs.sentence, theirs.reason, ''),
    mine.exit_code, theirs.exit_code, theirs.data_sha256 IS mine.data_sha256
  FROM main.runs AS mine JOIN shard.runs AS theirs USING(id)
  WHERE mine.result IS NOT NULL AND theirs.exit_code IS NOT NULL
    AND (theirs.result IS NULL OR theirs.data_sha256 IS NOT mine.data_sha256
      OR theirs.exit_code <> mine.exit_code))sql");
  SQLite::Statement keep(database, "INSERT INTO kept VALUES(?, ?, nullif(?, ''), ?)");
  const auto text = [&](int column) { return sqlite::Text(both, column); };
  const auto is_gone = [](const std::string&) { return false; };  // a merge does not see the recordings
  while (both.executeStep()) {
    const std::string result = text(2);
    const auto parsed = nlohmann::ordered_json::parse(result, nullptr, false);
    const NewerOutcome newer{!result.empty(),
                             RecordingOf(parsed),
                             {text(3), text(4)},
                             both.getColumn(6).getInt(),
                             both.getColumn(7).getInt() != 0};
    const Reason why = WhyKept(text(1), both.getColumn(5).getInt(), newer, is_gone);
    if (why.empty()) continue;
    sqlite::Bind(keep, text(0), why.text(), why.place, why.sentence).exec();
    keep.reset();
  }
  database.exec(R"sql(
UPDATE main.runs SET (position, path, rig, calibration, from_s, to_s, models, columns) =
    (SELECT position, path, rig, calibration, from_s, to_s, models, columns FROM shard.runs AS theirs
      WHERE theirs.id = main.runs.id),
    (stale, place, sentence) = (SELECT stale, place, sentence FROM kept WHERE kept.id = main.runs.id)
  WHERE id IN (SELECT id FROM kept))sql");
}

/// Marks the fits of the models that the attached store `shard` does not have for the same run, as Store::Put does.
void KeepOtherModels(SQLite::Database& database) {
  SQLite::Statement runs(database, R"sql(
SELECT mine.run, (SELECT json_group_array(model) FROM shard.fits AS theirs WHERE theirs.run = other.run)
  FROM main.runs AS mine JOIN shard.runs AS other USING(id) WHERE mine.id NOT IN (SELECT id FROM kept))sql");
  std::array<SQLite::Statement, 3> steps = {SQLite::Statement(database, kKeepFits),
                                            SQLite::Statement(database, kDropQuantities),
                                            SQLite::Statement(database, kDropFits)};
  while (runs.executeStep()) {
    for (SQLite::Statement& step : steps) {
      sqlite::Bind(step, runs.getColumn(0).getInt64(), sqlite::Text(runs, 1)).exec();
      step.reset();
    }
  }
}

/// Copies the rows of the attached store `shard` into this store. Rows of the same runs are replaced, except a result
/// by a failure.
void CopyAttachedShard(SQLite::Database& database) {
  KeepFormerResults(database);
  KeepOtherModels(database);
  const std::string runs = ColumnsOf(database, "runs");
  database.exec(
      "INSERT INTO main.runs(" + runs + ") SELECT " + runs +
      " FROM shard.runs WHERE id NOT IN (SELECT id FROM kept) ORDER BY position ON CONFLICT(id) DO UPDATE SET " +
      AssignmentsOf(database, "runs"));
  CopyRows(database, "quantities");
  CopyRows(database, "fits");
  database.exec("INSERT OR IGNORE INTO main.options SELECT * FROM shard.options");
  database.exec(
      "INSERT INTO main.meta SELECT * FROM shard.meta WHERE true "
      "ON CONFLICT(key) DO UPDATE SET value = CASE key WHEN 'began' THEN min(value, excluded.value) "
      "WHEN 'ended' THEN max(value, excluded.value) ELSE excluded.value END");
  database.exec("UPDATE main.meta SET value = '' WHERE key IN ('shard', 'shard_count')");
}

/// Copies all shards into the store. They are attached one at a time, because SQLite attaches at most ten.
Result<std::int64_t> CopyShards(const fs::path& folder, std::int64_t count, Store& store) {
  return sqlite::Guard(store.name(), [&]() -> Result<std::int64_t> {
    SQLite::Database& database = store.database();
    database.exec("PRAGMA synchronous = OFF");  // the complete file is synchronised at the end
    database.exec("UPDATE runs SET position = -1, news = NULL WHERE position <> -1");
    database.exec("DELETE FROM meta WHERE key IN ('began', 'ended')");
    database.exec(
        "CREATE TEMP TABLE known(id TEXT PRIMARY KEY, fitted TEXT);"
        "INSERT INTO known SELECT id, fitted FROM runs WHERE exit_code IS NOT NULL");
    std::int64_t runs = 0;
    for (std::int64_t k = 0; k < count; ++k) {
      SQLite::Statement attach(database, "ATTACH ? AS shard");
      sqlite::Bind(attach, sqlite::FileName(ShardPath(folder, k).string())).exec();
      SQLite::Transaction all(database);
      CopyAttachedShard(database);
      runs += database.execAndGet("SELECT count(*) FROM shard.runs").getInt64();
      all.commit();
      database.exec("DETACH shard");
    }
    database.exec(  // for a shard, a run is new that the merged store has had before
        "UPDATE runs SET news = iif(runs.fitted IS known.fitted, NULL, 'again') FROM known "
        "WHERE runs.id = known.id AND news IS NOT NULL");
    return runs;
  });
}

/// The rigs and calibrations of a shard's current results: path and hash of each.
Result<std::set<std::pair<std::string, std::string>>> FilesOf(const fs::path& path) {
  ASSIGN_OR_RETURN(auto store, Store::Open(path, Store::Mode::kRead));
  return sqlite::Guard(path.string(), [&]() -> Result<std::set<std::pair<std::string, std::string>>> {
    std::set<std::pair<std::string, std::string>> files;
    SQLite::Statement rows(store.database(),
                           "SELECT rig, rig_sha256 FROM runs WHERE result IS NOT NULL AND stale IS NULL AND rig <> '' "
                           "UNION SELECT calibration, calibration_sha256 FROM runs WHERE result IS NOT NULL AND stale "
                           "IS NULL AND calibration <> ''");
    while (rows.executeStep()) files.emplace(sqlite::Text(rows, 0), sqlite::Text(rows, 1));
    return files;
  });
}

/// Checks that no rig or calibration changed between the refits of the shards.
Result<void> CheckSameFiles(const fs::path& folder, std::int64_t count) {
  std::map<std::string, std::pair<std::string, fs::path>> known;  // hash and shard by path
  for (std::int64_t k = 0; k < count; ++k) {
    const fs::path shard = ShardPath(folder, k);
    ASSIGN_OR_RETURN(const auto files, FilesOf(shard));
    for (const auto& [path, hash] : files) {
      const auto& first = known.try_emplace(path, hash, shard).first->second;
      if (first.first == hash) continue;
      return Fault(shard.string(), path + " changed between the refits of this shard and of " + first.second.string() +
                                       "; run the shards again");
    }
  }
  return {};
}

/// Checks that all shards belong to one batch.
Result<void> CheckOneBatch(const fs::path& folder, std::int64_t count) {
  const auto first = MetaOf(ShardPath(folder, 0));
  for (std::int64_t k = 1; k < count; ++k) {
    const fs::path path = ShardPath(folder, k);
    const auto meta = MetaOf(path);
    if (first && meta && IsSameBatch(*first, *meta)) continue;
    return Fault(path.string(), "this is a shard of another batch than " + ShardPath(folder, 0).string() +
                                    " (manifest, options or version differ); run the shards of one batch again");
  }
  return {};
}

/// Checks that the merged store is not one of the shards.
Result<void> CheckIsNoShard(const fs::path& folder, std::int64_t count, const fs::path& store) {
  std::error_code unknown;
  for (std::int64_t k = 0; k < count; ++k) {
    if (!fs::equivalent(ShardPath(folder, k), store, unknown)) continue;
    return ErrorAt(StatusCode::kInvalidArgument, store.string(),
                   "this is one of the shards; name another store to merge them into");
  }
  return {};
}

/// Removes the files of other attempts. All shards are complete, so those attempts have crashed or are no longer
/// needed.
void RemoveLeftovers(const fs::path& folder, std::int64_t count) {
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool attempt = name.starts_with("shard-") && name.find(".sqlite.attempt-") != std::string::npos;
    if (attempt || StagedFile::IsTemporary(name)) leftovers.push_back(at->path());
  }
  for (std::int64_t k = 0; k < count; ++k) leftovers.push_back(WithSuffix(ShardPath(folder, k), ".part"));
  for (const fs::path& path : leftovers) fs::remove(path, error);
}

}  // namespace

Result<std::int64_t> MergeShards(const fs::path& folder, std::int64_t count, const fs::path& store) {
  const auto missing = MissingShards(folder, count);
  if (!missing) return tl::unexpected(missing.error());
  if (!missing->empty()) {
    return ErrorAt(StatusCode::kNotFound, folder.string(),
                   "of " + std::to_string(count) + " shards these are missing: " + ShardList(*missing) +
                       "; run them and merge again");
  }
  RETURN_IF_ERROR(CheckOneBatch(folder, count));
  RETURN_IF_ERROR(CheckSameFiles(folder, count));
  RETURN_IF_ERROR(CheckIsNoShard(folder, count, store));
  ASSIGN_OR_RETURN(const auto lock, StoreLock::Take(store));
  const TemporaryStore merged(WithSuffix(store, ".merging"));
  std::error_code unknown;
  if (fs::exists(store, unknown)) {
    RETURN_IF_ERROR(Store::Open(store, Store::Mode::kRead));
    RETURN_IF_ERROR(Publish(store, merged.path()));
  }
  Result<std::int64_t> runs = 0;
  {
    ASSIGN_OR_RETURN(auto target, Store::Open(merged.path(), Store::Mode::kWrite));
    runs = CopyShards(folder, count, target);
  }
  if (!runs) return runs;
  RETURN_IF_ERROR(Publish(merged.path(), store));
  RemoveLeftovers(folder, count);
  return runs;
}

}  // namespace pendulum
