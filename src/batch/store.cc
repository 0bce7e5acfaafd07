// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/store.h"

#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include <SQLiteCpp/Backup.h>

#include "batch/entry_row.h"
#include "batch/former_results.h"
#include "batch/kept_result.h"
#include "batch/result_rows.h"
#include "batch/results_view.h"
#include "batch/run_kinds.h"
#include "batch/sqlite.h"
#include "batch/store_queries.h"
#include "batch/store_schema.h"
#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utc_time.h"
#include "pendulum/base/version.h"
#include "pendulum/batch/temporary_store.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The JSON line of an entry for the manifest's hash; equal for entries from CSV and from a pack.
std::string EntryLine(const ManifestEntry& entry) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  const Json line = {entry.id,           entry.path,       entry.rig,    entry.calibration,
                     number(entry.from), number(entry.to), entry.models, entry.columns};
  return JsonText(line);
}

std::optional<std::string> NullIfEmpty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

StoredRun RunOf(const SQLite::Statement& row) {
  StoredRun run;
  run.entry = EntryOf(row);
  if (!row.getColumn(9).isNull()) run.exit_code = row.getColumn(9).getInt();
  const auto text = [&](int column) { return sqlite::Text(row, column); };
  run.provenance = {text(10), text(11), text(12), text(13), text(14), ""};
  run.stale = text(15);
  run.attempt = text(16);
  return run;
}

/// Converts stored results, and the fits of former ones, to the present schema of the result JSON.
void ConvertResults(SQLite::Database& database) {
  SQLite::Statement results(database, "SELECT run, result FROM runs WHERE result IS NOT NULL");
  SQLite::Statement set(database, "UPDATE runs SET result = ? WHERE run = ?");
  while (results.executeStep()) {
    sqlite::Bind(set, ToCurrentResult(sqlite::Text(results, 1)), results.getColumn(0).getInt64()).exec();
    set.reset();
  }
  SQLite::Statement fits(database, "SELECT run, model, json FROM fits WHERE json IS NOT NULL");
  SQLite::Statement set_fit(database, "UPDATE fits SET json = ? WHERE run = ? AND model = ?");
  while (fits.executeStep()) {
    sqlite::Bind(set_fit, ToCurrentFit(sqlite::Text(fits, 2)), fits.getColumn(0).getInt64(), sqlite::Text(fits, 1))
        .exec();
    set_fit.reset();
  }
}

/// Gives fits and quantities of earlier versions the columns that their results imply.
void FillNewColumns(SQLite::Database& database) {
  database.exec(R"sql(
UPDATE quantities SET total_std_error = std_error WHERE systematic_std_error IS NULL)sql");
  SQLite::Statement both(database, R"sql(
SELECT run, model, name, std_error, systematic_std_error FROM quantities
  WHERE std_error IS NOT NULL AND systematic_std_error IS NOT NULL)sql");
  SQLite::Statement set(database, "UPDATE quantities SET total_std_error = ? WHERE run = ? AND model = ? AND name = ?");
  SQLite::Statement results(database, "SELECT run, result FROM runs WHERE result IS NOT NULL");
  SQLite::Statement sources(database, "UPDATE runs SET sources = ? WHERE run = ?");
  while (results.executeStep()) {
    const Json result = Json::parse(sqlite::Text(results, 1), nullptr, false);
    if (RecordingOf(result) == nullptr) continue;
    sqlite::Bind(sources, result_rows::SourcesOf(result), results.getColumn(0).getInt64()).exec();
  }
  while (both.executeStep()) {
    const double total = std::hypot(both.getColumn(3).getDouble(), both.getColumn(4).getDouble());
    sqlite::Bind(set, total, both.getColumn(0).getInt64(), sqlite::Text(both, 1), sqlite::Text(both, 2)).exec();
  }
}

/// Whether the view `results` is that of this program.
bool HasResultsView(SQLite::Database& database) {
  SQLite::Statement present(database, "SELECT sql FROM sqlite_schema WHERE type = 'view' AND name = 'results'");
  return present.executeStep() && sqlite::Text(present, 0) == ResultsView();
}

/// Replaces the view `results` unless it is that of this program. To be called within a transaction, because a store
/// has no such view between the two statements.
void UpdateResultsView(SQLite::Database& database) {
  if (HasResultsView(database)) return;
  database.exec("DROP VIEW IF EXISTS results");
  database.exec(ResultsView());
}

/// Updates the tables in one transaction; creates them in a new file. The version is read within the transaction,
/// because another process may update the file at the same time.
void Migrate(SQLite::Database& database) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version >= static_cast<int>(kStoreMigrations.size())) return;
  for (std::size_t step = version; step < kStoreMigrations.size(); ++step) {
    database.exec(std::string(kStoreMigrations.at(step)));
  }
  if (version > 0 && version <= kLastFormerResults) ConvertResults(database);
  if (version > 0 && version < kFirstWithTotalErrors) FillNewColumns(database);
  UpdateResultsView(database);
  database.exec("PRAGMA application_id = " + std::to_string(kStoreId));
  database.exec("PRAGMA user_version = " + std::to_string(kStoreMigrations.size()));
  transaction.commit();
}

/// Updates the tables of a store that is only read. If that is impossible, as on a full or read-only disk, a temporary
/// copy takes its place and is updated.
Result<void> MigrateOrCopy(const std::string& name, SQLite::Database& database) {
  const auto migrate = [](SQLite::Database& tables) -> Result<void> {
    Migrate(tables);
    return {};
  };
  auto migrated = sqlite::Guard(name, [&] { return migrate(database); });
  if (migrated || migrated.error().code != StatusCode::kCannotWrite) return migrated;
  SQLite::Database copy("", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);  // SQLite removes it when it is closed
  const int step = SQLite::Backup(copy, database).executeStep();
  if (step != SQLITE_DONE) {  // SQLITE_BUSY or SQLITE_LOCKED; SQLiteCpp throws other errors
    return ErrorAt(StatusCode::kTryAgain, name, "another process writes to the store; try again later");
  }
  database = std::move(copy);
  return migrate(database);
}

/// Checks that the file is a store of a known version; a file without tables may become one.
Result<void> CheckKind(const std::string& name, SQLite::Database& database, Store::Mode mode) {
  const int id = database.execAndGet("PRAGMA application_id").getInt();
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  const bool empty = database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
  if (empty && mode != Store::Mode::kRead) return {};
  if (id != kStoreId) {
    return Fault(name, "this is not a result store of refit_pendulums; name a result store or a new file");
  }
  if (version < 1) return Fault(name, "the store is damaged (version " + std::to_string(version) + "); restore it");
  if (version <= static_cast<int>(kStoreMigrations.size())) return {};
  return Fault(name, "the store has version " + std::to_string(version) +
                         " of a newer program, but this program reads versions up to " +
                         std::to_string(kStoreMigrations.size()) + "; use the newer program");
}

}  // namespace

std::int64_t Shard::Cut(std::int64_t runs, std::int64_t k) const {
  return runs / count * k + runs % count * k / count;  // R k / N without overflow for large R
}

struct Store::State {
  State(const std::string& path, Mode mode)
      : name(path),
        database(sqlite::FileName(path),
                 mode == Mode::kRead ? SQLite::OPEN_READWRITE : SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                 kReaderTimeoutMs) {
    if (mode == Mode::kWrite) ::sqlite3_busy_handler(database.getHandle(), Wait, this);
    if (mode == Mode::kServe) database.setBusyTimeout(kServerTimeoutMs);
  }

  /// Called by SQLite when readers block a writer for the `times`-th time; returns whether to keep waiting.
  static int Wait(void* self, int times) {
    const std::atomic<bool>* stop = static_cast<const State*>(self)->stop;
    const int timeout = stop != nullptr && stop->load() ? kStoppedTimeoutMs : kWriterTimeoutMs;
    return times * ::sqlite3_sleep(kStepMs) < timeout ? 1 : 0;
  }

  /// Prepares a statement at its first use.
  SQLite::Statement& Prepared(std::unique_ptr<SQLite::Statement>& statement, const char* sql) {
    if (!statement) statement = std::make_unique<SQLite::Statement>(database, sql);
    return *statement;
  }

  void BeginIfNone() {
    if (!transaction)
      transaction = std::make_unique<SQLite::Transaction>(database, SQLite::TransactionBehavior::IMMEDIATE);
  }

  void Commit() {
    if (transaction) transaction->commit();
    transaction.reset();
  }

  void SetMeta(const std::string& key, const std::string& value) const {
    SQLite::Statement set(database,
                          "INSERT INTO meta VALUES(?, ?) ON CONFLICT(key) DO UPDATE SET value = excluded.value");
    sqlite::Bind(set, key, value).exec();
  }

  std::string GetMeta(const std::string& key) const {
    SQLite::Statement get(database, "SELECT value FROM meta WHERE key = ?");
    return sqlite::Bind(get, key).executeStep() ? sqlite::Text(get, 0) : "";
  }

  /// The number of the run with this id, in a transaction. kInternal: there is none.
  Result<std::int64_t> Find(const std::string& id);
  /// Why an outcome must not replace the result of a run; empty if it may.
  Reason WhyWorse(const RunOutcome& outcome, std::int64_t run, const IsGone& is_gone);
  void SetStale(std::int64_t run, const Reason& why, const std::optional<std::string>& attempt);
  Result<std::string> FillBatchTable(const Source& source);
  Result<std::int64_t> MarkOtherFiles(const Source& source, bool marks_unreadable);
  void RestrictToShard(const std::optional<Shard>& shard, StoreMeta& meta);
  void BeginNews(const StoreMeta& meta);
  void PutRows(const RunOutcome& outcome, std::int64_t run);
  void PutRun(const RunOutcome& outcome, std::int64_t run);
  void PutFits(const std::vector<FitRow>& rows, std::int64_t run);

  static constexpr int kReaderTimeoutMs = 10000, kWriterTimeoutMs = 600000, kStoppedTimeoutMs = 2000,
                       kServerTimeoutMs = 2000, kStepMs = 20;

  std::string name;
  SQLite::Database database;
  const std::atomic<bool>* stop = nullptr;
  std::function<std::string()> now = [] { return UtcTimeText(); };
  std::unique_ptr<SQLite::Transaction> transaction;
  std::unique_ptr<SQLite::Statement> run_of, result_of, renamed_runs, set_stale, add_run, put_run, keep_fits, drop_fits,
      drop_quantities, put_fit, put_quantity;
};

Result<std::int64_t> Store::State::Find(const std::string& id) {
  BeginIfNone();
  SQLite::Statement& find = Prepared(run_of, "SELECT run FROM runs WHERE id = ?");
  if (!sqlite::Bind(find, id).executeStep()) return Error(StatusCode::kInternal, "no run " + id);
  const std::int64_t run = find.getColumn(0).getInt64();
  find.reset();
  return run;
}

Reason Store::State::WhyWorse(const RunOutcome& outcome, std::int64_t run, const IsGone& is_gone) {
  SQLite::Statement& before =
      Prepared(result_of, "SELECT data_sha256, result, exit_code FROM runs WHERE run = ? AND result IS NOT NULL");
  Reason why;
  if (sqlite::Bind(before, run).executeStep()) {
    const NewerOutcome newer{!outcome.result.is_null(), RecordingOf(outcome.result), outcome.reason, outcome.exit_code,
                             sqlite::Text(before, 0) == outcome.provenance.data_sha256};
    why = WhyKept(sqlite::Text(before, 1), before.getColumn(2).getInt(), newer, is_gone);
  }
  before.reset();
  return why;
}

void Store::State::SetStale(std::int64_t run, const Reason& why, const std::optional<std::string>& attempt) {
  sqlite::Bind(Prepared(set_stale, "UPDATE runs SET stale = ?, place = ?, sentence = ?, attempt = ? WHERE run = ?"),
               NullIfEmpty(why.text()), NullIfEmpty(why.place), NullIfEmpty(why.sentence), attempt, run)
      .exec();
}

/// Fills the temporary table `batch` with all entries; returns their hash.
Result<std::string> Store::State::FillBatchTable(const Source& source) {
  database.exec("DROP TABLE IF EXISTS temp.batch");
  database.exec(kBatchTable);
  SQLite::Statement add(database, "INSERT OR IGNORE INTO batch VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  std::string hash;  // a chain: the hash of an entry includes the previous hash
  RETURN_IF_ERROR(source.for_each([&](const ManifestEntry& entry) -> Result<void> {
    const int added = sqlite::Bind(add, entry.position, entry.id, entry.path, entry.rig, entry.calibration, entry.from,
                                   entry.to, entry.models, entry.columns, entry.place)
                          .exec();
    if (added == 0) {
      SQLite::Statement other(database, "SELECT place FROM batch WHERE id = ?");
      sqlite::Bind(other, entry.id).executeStep();
      return Fault(entry.place, "the id " + Quoted(entry.id) + " is also at " + sqlite::Text(other, 0) +
                                    "; give each run its own id");
    }
    ASSIGN_OR_RETURN(auto next, Sha256(hash + EntryLine(entry)));
    hash = std::move(next);
    return {};
  }));
  if (!hash.empty()) return hash;
  return ErrorAt(StatusCode::kFailedPrecondition, source.name, "it names no recording; give one per row");
}

/// Marks the results whose rig or calibration is not the file that the manifest names now.
Result<std::int64_t> Store::State::MarkOtherFiles(const Source& source, bool marks_unreadable) {
  std::int64_t marked = 0;
  constexpr std::pair<const char*, const char*> kRig{
      "SELECT DISTINCT rig FROM batch WHERE rig <> ''",
      "rig_sha256 IS NOT ? AND id IN (SELECT id FROM batch WHERE rig = ?)"};
  constexpr std::pair<const char*, const char*> kCalibration{
      "SELECT DISTINCT calibration FROM batch WHERE calibration <> ''",
      "calibration_sha256 IS NOT ? AND id IN (SELECT id FROM batch WHERE calibration = ?)"};
  for (const auto& [paths, has_other] : {kRig, kCalibration}) {
    SQLite::Statement mark(database, MarkFormer(has_other));
    for (const std::string& path : sqlite::Texts(database, paths)) {
      const Result<std::string> bytes = source.read(path);
      if (!bytes && !marks_unreadable) continue;
      ASSIGN_OR_RETURN(const std::string hash, bytes ? Sha256(*bytes) : Result<std::string>(""));
      marked += sqlite::Bind(mark, hash, path).exec();
      mark.reset();
    }
  }
  return marked;
}

/// Removes runs outside the shard from the batch and from the store. Without a shard, removes waiting runs that are no
/// longer in the manifest.
void Store::State::RestrictToShard(const std::optional<Shard>& shard, StoreMeta& meta) {
  meta.runs = database.execAndGet("SELECT count(*) FROM batch").getInt64();
  // Runs requested from a service belong to no manifest and stay.
  const std::string other_manifest = "id NOT IN (SELECT id FROM batch) AND run NOT IN (SELECT run FROM requests)";
  if (!shard) {  // results of runs that are no longer in the manifest stay
    database.exec("DELETE FROM runs WHERE exit_code IS NULL AND " + other_manifest);
    database.exec("UPDATE runs SET position = -1 WHERE position <> -1 AND " + other_manifest);
    return;
  }
  SQLite::Statement leave_out(database, "DELETE FROM batch WHERE position < ? OR position >= ?");
  sqlite::Bind(leave_out, shard->Begin(meta.runs), shard->End(meta.runs)).exec();
  // The store of a shard may have begun as the store of another shard.
  for (const char* table : {"quantities", "fits", "runs"}) {
    database.exec(std::string("DELETE FROM ") + table + " WHERE run IN (SELECT run FROM runs WHERE " + other_manifest +
                  ")");
  }
}

/// Forgets what the refit before did, unless this one continues it.
void Store::State::BeginNews(const StoreMeta& meta) {
  const bool continues = GetMeta("complete") == "0" && GetMeta("manifest_sha256") == meta.manifest_sha256 &&
                         GetMeta("options_sha256") == meta.options_sha256;
  if (continues) return;
  database.exec("UPDATE runs SET news = NULL WHERE news IS NOT NULL");
  SetMeta("began", now());
  SetMeta("ended", "");
}

void Store::State::PutRun(const RunOutcome& outcome, std::int64_t run) {
  const Provenance& provenance = outcome.provenance;
  const bool fitted = !outcome.result.is_null();
  std::optional<std::string> recommended, result, sources;
  if (fitted) {
    sources = result_rows::SourcesOf(outcome.result);
    const Json& comparison = outcome.result["comparison"];
    if (comparison.is_object() && comparison["recommended"].is_string()) {
      recommended = comparison["recommended"].get<std::string>();
    }
    result = JsonText(outcome.result);
  }
  sqlite::Bind(Prepared(put_run, kPutRun), outcome.exit_code, NullIfEmpty(outcome.reason.text()),
               NullIfEmpty(outcome.reason.place), NullIfEmpty(outcome.reason.sentence), recommended,
               provenance.data_sha256, provenance.rig_sha256, provenance.calibration_sha256, provenance.options_sha256,
               provenance.version, provenance.cpu, result, sources, now(), run)
      .exec();
}

void Store::State::PutRows(const RunOutcome& outcome, std::int64_t run) {
  const std::vector<FitRow> rows = FitRows(outcome);
  Json models = Json::array();
  for (const FitRow& row : rows) models.push_back(row.model);
  const std::string asked = JsonText(models);
  sqlite::Bind(Prepared(keep_fits, kKeepFits), run, asked).exec();
  sqlite::Bind(Prepared(drop_quantities, kDropQuantities), run, asked).exec();
  sqlite::Bind(Prepared(drop_fits, kDropFits), run, asked).exec();
  PutRun(outcome, run);
  PutFits(rows, run);
}

void Store::State::PutFits(const std::vector<FitRow>& rows, std::int64_t run) {
  SQLite::Statement& fit = Prepared(
      put_fit, "INSERT INTO fits VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, NULL, NULL)");
  SQLite::Statement& quantity =
      Prepared(put_quantity, "INSERT INTO quantities VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const FitRow& row : rows) {
    sqlite::Bind(fit, run, row.model, row.status, row.reason, row.used_samples, row.effective_samples,
                 row.residual_unit, row.rms_residual, row.sigma, row.noise_model, row.lag1_correlation,
                 row.log_likelihood, row.aic, row.aicc, row.bic, row.durbin_watson, row.ljung_box_p, row.runs_p,
                 row.iterations, row.evaluations, row.verdict)
        .exec();
    for (const QuantityRow& value : row.quantities) {
      sqlite::Bind(quantity, run, row.model, value.name, static_cast<int>(value.derived), value.estimate,
                   value.std_error, value.lower95, value.upper95, value.systematic_std_error, value.unit,
                   static_cast<int>(value.fixed), static_cast<int>(value.at_bound), value.total_std_error,
                   value.inconstancy_std_error, value.source_std_error)
          .exec();
    }
  }
}

Store::Store(std::unique_ptr<State> state) : state_(std::move(state)) {}
Store::Store(Store&& other) noexcept = default;
Store& Store::operator=(Store&& other) noexcept = default;
Store::~Store() = default;

Result<Store> Store::Open(const fs::path& path, Mode mode) {
  const std::string name = path.string();
  std::error_code unknown;
  if (mode == Mode::kRead && !fs::exists(path, unknown)) {
    return ErrorAt(StatusCode::kNotFound, name, "there is no such store; check the path");
  }
  if (const auto checked = CheckFolderOf(path); mode != Mode::kRead && !checked) {
    return tl::unexpected(checked.error());
  }
  if (fs::is_directory(path, unknown)) return Fault(name, "this is a directory; name a store in it");
  if (fs::is_other(path, unknown)) return Fault(name, "this is not a regular file; name a regular file");
  if (const auto readable = sqlite::CheckReadable(name); mode == Mode::kRead && !readable) {
    return tl::unexpected(readable.error());
  }
  return sqlite::Guard(name, [&]() -> Result<Store> {
    auto state = std::make_unique<State>(name, mode);
    RETURN_IF_ERROR(CheckKind(name, state->database, mode));
    // A rollback journal needs no shared memory and works on any file system; EXTRA also synchronises the folder. With
    // a write-ahead log writers do not wait for readers, except when the journal mode changes.
    if (mode != Mode::kRead) {
      state->database.exec(
          mode == Mode::kServe
              ? "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA cache_size = -32768"
              : "PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA; PRAGMA cache_size = -32768");
    }
    const int version = state->database.execAndGet("PRAGMA user_version").getInt();
    const bool is_current = version == static_cast<int>(kStoreMigrations.size());
    if (!is_current && mode != Mode::kRead) Migrate(state->database);
    if (!is_current && mode == Mode::kRead) {
      RETURN_IF_ERROR(MigrateOrCopy(name, state->database));
    }
    if (is_current && mode != Mode::kRead && !HasResultsView(state->database)) {  // looks first: another may be writing
      SQLite::Transaction transaction(state->database, SQLite::TransactionBehavior::IMMEDIATE);
      UpdateResultsView(state->database);
      transaction.commit();
    }
    return Store(std::move(state));
  });
}

Result<StoreMeta> Store::Begin(const Source& source, const std::optional<Shard>& shard, const std::string& options_json,
                               const std::function<Result<void>()>& check) {
  return sqlite::Guard(name(), [&]() -> Result<StoreMeta> {
    SQLite::Transaction all(state_->database, SQLite::TransactionBehavior::IMMEDIATE);
    StoreMeta meta;
    meta.version = std::string(kVersion);
    meta.shard = shard;
    ASSIGN_OR_RETURN(auto manifest, state_->FillBatchTable(source));
    auto options = Sha256(options_json);
    if (!options) return tl::unexpected(options.error());
    meta.manifest_sha256 = std::move(manifest);
    meta.options_sha256 = *std::move(options);
    state_->RestrictToShard(shard, meta);
    state_->BeginNews(meta);
    const std::string former_options = state_->GetMeta("options_sha256");
    state_->database.exec(MarkFormer(kHasOtherEntry));
    if (!former_options.empty() && former_options != meta.options_sha256) state_->database.exec(MarkFormer("true"));
    RETURN_IF_ERROR(state_->MarkOtherFiles(source, true));
    state_->database.exec(kUpdateRuns);
    SQLite::Statement add(state_->database, "INSERT OR IGNORE INTO options VALUES(?, ?)");
    sqlite::Bind(add, meta.options_sha256, options_json).exec();
    state_->SetMeta("version", meta.version);
    state_->SetMeta("manifest_sha256", meta.manifest_sha256);
    state_->SetMeta("options_sha256", meta.options_sha256);
    state_->SetMeta("runs", std::to_string(meta.runs));
    state_->SetMeta("shard", shard ? std::to_string(shard->index) : "");
    state_->SetMeta("shard_count", shard ? std::to_string(shard->count) : "");
    state_->SetMeta("complete", "0");
    if (check) {
      RETURN_IF_ERROR(check());
    }
    all.commit();
    return meta;
  });
}

Result<std::vector<StoredRun>> Store::Next(std::int64_t position, int max_runs) {
  return sqlite::Guard(name(), [&]() -> Result<std::vector<StoredRun>> {
    SQLite::Statement next(state_->database, kNextRuns);
    sqlite::Bind(next, position, max_runs);
    std::vector<StoredRun> runs;
    while (next.executeStep()) runs.push_back(RunOf(next));
    return runs;
  });
}

Result<void> Store::Put(const std::string& id, const RunOutcome& outcome) {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    ASSIGN_OR_RETURN(const auto run, state_->Find(id));
    state_->PutRows(outcome, run);
    return {};
  });
}

Result<std::string> Store::PutUnlessWorse(const std::string& id, const RunOutcome& outcome, const std::string& attempt,
                                          const IsGone& is_gone) {
  return sqlite::Guard(name(), [&]() -> Result<std::string> {
    ASSIGN_OR_RETURN(const auto run, state_->Find(id));
    const Reason why = state_->WhyWorse(outcome, run, is_gone);
    if (why.empty()) {
      state_->PutRows(outcome, run);
    } else {
      state_->SetStale(run, why, attempt);
    }
    return why.text();
  });
}

Result<bool> Store::TakeOver(const std::string& id, const std::string& data_sha256, const IsGone& is_gone) {
  return sqlite::Guard(name(), [&]() -> Result<bool> {
    ASSIGN_OR_RETURN(const auto added, state_->Find(id));
    std::vector<std::int64_t> renamed;
    SQLite::Statement& find = state_->Prepared(state_->renamed_runs, kRenamedRuns.c_str());
    sqlite::Bind(find, id, data_sha256);
    while (find.executeStep()) {  // the run of a file that is still there, under another path, is a run of a copy
      const bool is_same_file = find.getColumn(2).getInt() != 0;
      if (is_same_file || is_gone(sqlite::Text(find, 1))) renamed.push_back(find.getColumn(0).getInt64());
    }
    find.reset();
    if (renamed.size() != 1) return false;
    for (const char* table : {"quantities", "fits", "runs"}) {  // a failed attempt has rows, too
      SQLite::Statement drop(state_->database, std::string("DELETE FROM ") + table + " WHERE run = ?");
      sqlite::Bind(drop, added).exec();
    }
    SQLite::Statement rename(state_->database, kRenameRun);
    sqlite::Bind(rename, id, renamed.front()).exec();
    return true;
  });
}

Result<void> Store::MarkBatch() {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    state_->BeginIfNone();
    state_->database.exec(kForgetProvenance);
    state_->Commit();  // before the first fit, so that the next refit continues even after a crash
    return {};
  });
}

Result<std::int64_t> Store::MarkChangedFiles(const Source& source) {
  return sqlite::Guard(name(), [&]() -> Result<std::int64_t> {
    state_->BeginIfNone();
    return state_->MarkOtherFiles(source, false);
  });
}

Result<void> Store::MarkCurrent(const std::string& id) {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    ASSIGN_OR_RETURN(const auto run, state_->Find(id));
    state_->SetStale(run, {}, std::nullopt);
    return {};
  });
}

Result<void> Store::Commit() {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    state_->Commit();
    return {};
  });
}

Result<void> Store::BeginWrite() {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    state_->BeginIfNone();
    return {};
  });
}

void Store::Rollback() { state_->transaction.reset(); }

Result<std::int64_t> Store::Add(const ManifestEntry& entry) {
  return sqlite::Guard(name(), [&]() -> Result<std::int64_t> {
    state_->BeginIfNone();
    sqlite::Bind(state_->Prepared(state_->add_run, kAddRun), entry.id, entry.path, entry.rig, entry.calibration,
                 entry.from, entry.to, entry.models, entry.columns)
        .exec();
    return state_->database.getLastInsertRowid();
  });
}

Result<void> Store::Complete() {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    state_->BeginIfNone();
    state_->SetMeta("complete", "1");
    state_->SetMeta("ended", state_->now());
    state_->Commit();
    return {};
  });
}

Result<StoreMeta> Store::Meta() {
  return sqlite::Guard(name(), [&]() -> Result<StoreMeta> {
    const auto number = [&](const std::string& key) {
      const std::string text = state_->GetMeta(key);
      return text.empty() ? std::int64_t{0} : std::stoll(text);
    };
    StoreMeta meta{state_->GetMeta("version"),
                   state_->GetMeta("manifest_sha256"),
                   state_->GetMeta("options_sha256"),
                   std::nullopt,
                   number("runs"),
                   number("complete") == 1,
                   state_->GetMeta("began"),
                   state_->GetMeta("ended"),
                   state_->GetMeta("flags"),
                   state_->GetMeta("folder")};
    if (!state_->GetMeta("shard").empty()) meta.shard = Shard{number("shard"), number("shard_count")};
    return meta;
  });
}

Result<StoreCounts> Store::Count() {
  return sqlite::Guard(name(), [&]() -> Result<StoreCounts> {
    StoreCounts counts;
    SQLite::Statement runs(state_->database,
                           "SELECT count(*), count(*) - count(exit_code), count(reason), count(*) FILTER (WHERE " +
                               kIsMissing + "), count(*) FILTER (WHERE " + kIsStale + "), count(*) FILTER (WHERE " +
                               kIsUnlisted + "), count(*) FILTER (WHERE " + kIsFitted + "), count(*) FILTER (WHERE " +
                               kLacksFile + ") FROM runs");
    runs.executeStep();
    counts.runs = runs.getColumn(0).getInt64();
    counts.pending = runs.getColumn(1).getInt64();
    counts.unfitted = runs.getColumn(2).getInt64();
    counts.missing = runs.getColumn(3).getInt64();
    counts.stale = runs.getColumn(4).getInt64();
    counts.earlier = runs.getColumn(5).getInt64();
    counts.fitted = runs.getColumn(6).getInt64();
    counts.without_file = runs.getColumn(7).getInt64();
    SQLite::Statement fits(state_->database,
                           "SELECT count(*) - count(stale), count(*) FILTER (WHERE status = 'failed'), count(stale) "
                           "FROM fits");
    fits.executeStep();
    counts.fits = fits.getColumn(0).getInt64();
    counts.failed = fits.getColumn(1).getInt64();
    counts.former_fits = fits.getColumn(2).getInt64();
    return counts;
  });
}

Result<void> Store::Check() {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    const std::string found = sqlite::Texts(state_->database, "PRAGMA quick_check(1)").front();
    if (found == "ok") return {};
    return Fault(name(), "the file is damaged (" + found + "); restore it, or start with a new file");
  });
}

void Store::SetClock(std::function<std::string()> now) { state_->now = std::move(now); }

Result<void> Store::KeepCommand(const std::string& flags, const std::string& folder) {
  return sqlite::Guard(name(), [&]() -> Result<void> {
    state_->BeginIfNone();
    state_->SetMeta("flags", flags);
    state_->SetMeta("folder", folder);
    return {};
  });
}

void Store::ShortenWaitsOnStop(const std::atomic<bool>* stop) { state_->stop = stop; }

const std::string& Store::name() const { return state_->name; }

SQLite::Database& Store::database() { return state_->database; }

}  // namespace pendulum
