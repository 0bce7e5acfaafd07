// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/fit_store.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <utility>

#include <SQLiteCpp/Savepoint.h>

#include "batch/batch_agreement.h"
#include "batch/fit_store_queries.h"
#include "batch/sqlite.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/store_lock.h"

namespace pendulum {
namespace {

using fit_store::BatchOf;
using fit_store::FitOf;
using fit_store::kBatches;
using fit_store::kListedColumns;

/// Largest number of runs read for one list.
constexpr int kMaxListed = 1000;

/// Deletes answers that are older than a day. Until then repeated requests get them.
constexpr const char* kForgetAnswers =
    "DELETE FROM answers WHERE created < strftime('%Y-%m-%dT%H:%M:%SZ', 'now', '-1 day')";

tl::unexpected<Status> Unknown(const std::string& what, const std::string& id) {
  return Error(StatusCode::kNotFound, "there is no " + what + " " + id + "; it may have been deleted");
}

/// Hashes take long, so they are computed before the store is locked.
struct FileHashes {
  std::string data, rig, calibration;
};

Result<FileHashes> HashesOf(const RunFiles& files) {
  const auto hash = [](const SharedFile& file) -> Result<std::string> {
    return file ? Sha256(file->bytes) : Result<std::string>("");
  };
  ASSIGN_OR_RETURN(auto data, Sha256(files.data.bytes));
  ASSIGN_OR_RETURN(auto rig, hash(files.rig));
  ASSIGN_OR_RETURN(auto calibration, hash(files.calibration));
  return FileHashes{std::move(data), std::move(rig), std::move(calibration)};
}

}  // namespace

struct FitStore::State {
  State(StoreLock held, Store writing, Store reading)
      : lock(std::move(held)), writer(std::move(writing)), reader(std::move(reading)) {}

  /// Runs `work` in the open transaction, completely or not at all, and returns when it is on the disk.
  template <typename Work>
  Result<void> Write(const Work& work);

  /// Runs `work` without blocking writers.
  template <typename Work>
  auto Read(const Work& work) -> decltype(work(std::declval<SQLite::Database&>())) {
    const std::scoped_lock held(read_mutex);
    return sqlite::Guard(reader.name(), [&] { return work(reader.database()); });
  }

  Result<void> WaitUntilCommitted(std::unique_lock<std::mutex>& held);
  Result<void> AddRun(const FitOrder& order, const FileHashes& hashes, const std::optional<std::int64_t>& batch);
  void StoreAnswer(const std::optional<RequestKey>& key, const std::string& location, const std::string& created);

  /// Writes that share one commit.
  struct Round {
    bool has_committer = false, is_over = false;
    Result<void> done;
  };

  Result<void> TryCommit();
  void EndRound(Result<void> done, std::shared_ptr<Round> next);

  StoreLock lock;          // first member, so it is held as long as the file is open
  std::mutex write_mutex;  // for `writer`, `round` and `over`
  Store writer;
  std::shared_ptr<Round> round = std::make_shared<Round>();
  std::condition_variable over;
  std::mutex read_mutex;  // for `reader`
  Store reader;
};

template <typename Work>
Result<void> FitStore::State::Write(const Work& work) {
  std::unique_lock held(write_mutex);
  auto done = writer.BeginWrite();
  if (!done) return done;
  done = sqlite::Guard(writer.name(), [&]() -> Result<void> {
    SQLite::Savepoint savepoint(writer.database(), "request");
    RETURN_IF_ERROR(work(writer.database()));
    savepoint.release();
    return {};
  });
  if (done) return WaitUntilCommitted(held);
  // A full disk may have rolled back the writes of waiting threads, too.
  if (::sqlite3_get_autocommit(writer.database().getHandle()) != 0) EndRound(done, std::make_shared<Round>());
  return done;
}

/// The first waiting thread commits for all threads whose work is done by then.
Result<void> FitStore::State::WaitUntilCommitted(std::unique_lock<std::mutex>& held) {
  const std::shared_ptr<Round> own_round = round;
  auto next = std::make_shared<Round>();  // allocated now: an exception later would leave other threads waiting
  if (!std::exchange(own_round->has_committer, true)) {
    constexpr std::chrono::microseconds kCommitDelay{300};  // short compared with a commit and with a fit
    over.wait_for(held, kCommitDelay, [&] { return own_round->is_over; });
    if (!own_round->is_over) EndRound(TryCommit(), std::move(next));
  }
  over.wait(held, [&] { return own_round->is_over; });
  return own_round->done;
}

/// Converts an exception to an error, so that waiting threads get it.
Result<void> FitStore::State::TryCommit() {
  try {
    return writer.Commit();
  } catch (const std::exception& error) {
    return Error(StatusCode::kInternal, std::string("internal error: ") + error.what());
  }
}

void FitStore::State::EndRound(Result<void> done, std::shared_ptr<Round> next) {
  if (!done) writer.Rollback();
  round->done = std::move(done);
  round->is_over = true;
  round = std::move(next);
  over.notify_all();
}

Result<void> FitStore::State::AddRun(const FitOrder& order, const FileHashes& hashes,
                                     const std::optional<std::int64_t>& batch) {
  const auto name = [](const SharedFile& file) { return file ? file->name : std::string(); };
  ManifestEntry entry;
  entry.id = order.id;
  entry.path = order.files.data.name;
  entry.rig = name(order.files.rig);
  entry.calibration = name(order.files.calibration);
  const auto run = writer.Add(entry);
  if (!run) return tl::unexpected(run.error());
  SQLite::Database& database = writer.database();
  const auto store = [&](const SharedFile& file, const std::string& sha256) {
    return file ? std::optional(fit_store::StoreFile(database, file->bytes, sha256)) : std::nullopt;
  };
  SQLite::Statement add(database,
                        "INSERT INTO requests(run, batch, created, flags, data, rig, calibration, name) "
                        "VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  sqlite::Bind(add, *run, batch, order.created, order.flags,
               fit_store::StoreFile(database, order.files.data.bytes, hashes.data), store(order.files.rig, hashes.rig),
               store(order.files.calibration, hashes.calibration), order.name)
      .exec();
  return {};
}

void FitStore::State::StoreAnswer(const std::optional<RequestKey>& key, const std::string& location,
                                  const std::string& created) {
  if (!key) return;
  writer.database().exec(kForgetAnswers);
  SQLite::Statement add(writer.database(), "INSERT OR REPLACE INTO answers VALUES(?, ?, ?, ?)");
  sqlite::Bind(add, key->key, key->request_sha256, location, created).exec();
}

FitStore::FitStore(std::unique_ptr<State> state) : state_(std::move(state)) {}

/// Moves the write-ahead log into the file, so that this file alone can be copied. This is not possible while another
/// process reads.
FitStore::~FitStore() {
  state_->writer.Rollback();
  { const Store closing = std::move(state_->reader); }
  (void)sqlite::Guard(state_->writer.name(), [&]() -> Result<void> {
    state_->writer.database().exec("PRAGMA journal_mode = DELETE");
    return {};
  });
}

Result<std::unique_ptr<FitStore>> FitStore::Open(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(auto lock, StoreLock::Take(path));
  ASSIGN_OR_RETURN(auto writer, Store::Open(path, Store::Mode::kServe));
  ASSIGN_OR_RETURN(auto reader, Store::Open(path, Store::Mode::kRead));
  auto state = std::make_unique<State>(std::move(lock), std::move(writer), std::move(reader));
  return std::make_unique<FitStore>(std::move(state));
}

Result<void> FitStore::Add(const FitOrder& order, const RunOutcome& outcome, const std::optional<RequestKey>& key) {
  ASSIGN_OR_RETURN(const auto hashes, HashesOf(order.files));
  return state_->Write([&](SQLite::Database&) -> Result<void> {
    RETURN_IF_ERROR(state_->AddRun(order, hashes, std::nullopt));
    state_->StoreAnswer(key, "/v1/fits/" + order.id, order.created);
    return state_->writer.Put(order.id, outcome);
  });
}

Result<void> FitStore::AddBatch(const std::string& id, const std::string& created, const std::vector<FitOrder>& orders,
                                const std::optional<RequestKey>& key) {
  std::vector<FileHashes> hashes;
  hashes.reserve(orders.size());
  for (const FitOrder& order : orders) {
    ASSIGN_OR_RETURN(auto of_one, HashesOf(order.files));
    hashes.push_back(std::move(of_one));
  }
  return state_->Write([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement add(database, "INSERT INTO batches(id, created) VALUES(?, ?)");
    sqlite::Bind(add, id, created).exec();
    const std::int64_t batch = database.getLastInsertRowid();
    for (std::size_t i = 0; i < orders.size(); ++i) {
      RETURN_IF_ERROR(state_->AddRun(orders[i], hashes[i], batch));
    }
    state_->StoreAnswer(key, "/v1/batches/" + id, created);
    return {};
  });
}

Result<void> FitStore::Put(const std::string& id, const RunOutcome& outcome) {
  return state_->Write([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement find(database, "SELECT 1 FROM runs WHERE id = ?");
    if (!sqlite::Bind(find, id).executeStep()) return Unknown("fit", id);
    find.reset();
    return state_->writer.Put(id, outcome);
  });
}

Result<void> FitStore::Rename(const std::string& id, const std::string& name) {
  return state_->Write([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement rename(database, "UPDATE requests SET name = ? WHERE run = (SELECT run FROM runs WHERE id = ?)");
    if (sqlite::Bind(rename, name, id).exec() == 0) return Unknown("fit", id);
    return {};
  });
}

Result<void> FitStore::DeleteFit(const std::string& id) {
  return state_->Write([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement find(database, "SELECT run FROM requests JOIN runs USING(run) WHERE id = ?");
    if (!sqlite::Bind(find, id).executeStep()) return Unknown("fit", id);
    const std::int64_t run = find.getColumn(0).getInt64();
    find.reset();
    fit_store::DeleteRuns(database, "run = " + std::to_string(run));
    SQLite::Statement forget(database, "DELETE FROM answers WHERE location = ?");
    sqlite::Bind(forget, "/v1/fits/" + id).exec();
    return {};
  });
}

Result<void> FitStore::DeleteBatch(const std::string& id) {
  return state_->Write([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement find(database, "SELECT batch FROM batches WHERE id = ?");
    if (!sqlite::Bind(find, id).executeStep()) return Unknown("batch", id);
    const std::string batch = std::to_string(find.getColumn(0).getInt64());
    find.reset();
    fit_store::DeleteRuns(database, "batch = " + batch);
    database.exec("DELETE FROM batches WHERE batch = " + batch);
    SQLite::Statement forget(database, "DELETE FROM answers WHERE location = ?");
    sqlite::Bind(forget, "/v1/batches/" + id).exec();
    return {};
  });
}

Result<void> FitStore::DeleteWaiting(const std::string& batch) {
  return state_->Write([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement find(database, "SELECT batch FROM batches WHERE id = ?");
    if (!sqlite::Bind(find, batch).executeStep()) return Unknown("batch", batch);
    const std::string number = std::to_string(find.getColumn(0).getInt64());
    find.reset();
    fit_store::DeleteRuns(database, "batch = " + number + " AND run IN (SELECT run FROM runs WHERE exit_code IS NULL)");
    return {};
  });
}

Result<void> FitStore::CheckFit(const std::string& id) {
  return state_->Read([&](SQLite::Database& database) -> Result<void> {
    SQLite::Statement find(database, "SELECT 1 FROM runs WHERE id = ?");
    if (!sqlite::Bind(find, id).executeStep()) return Unknown("fit", id);
    return {};
  });
}

Result<KeptFit> FitStore::Find(const std::string& id) {
  return state_->Read([&](SQLite::Database& database) -> Result<KeptFit> {
    SQLite::Statement row(database, std::string(kListedColumns) + "WHERE runs.id = ?");
    if (!sqlite::Bind(row, id).executeStep()) return Unknown("fit", id);
    KeptFit kept;
    kept.fit = FitOf(row);
    SQLite::Statement more(database,
                           "SELECT flags, data, requests.rig, requests.calibration, runs.rig, runs.calibration, result "
                           "FROM requests JOIN runs USING(run) WHERE run = ?");
    sqlite::Bind(more, kept.fit.run).executeStep();
    const auto file = [&](int column, const std::string& name) {
      return NamedBytes{name, fit_store::FileBytes(database, more.getColumn(column).getInt64())};
    };
    const auto shared = [&](int column, const std::string& name) {
      return more.getColumn(column).isNull() ? nullptr : Share(file(column, name));
    };
    kept.order = {id, kept.fit.created, sqlite::Text(more, 0),
                  RunFiles{file(1, kept.fit.file), shared(2, sqlite::Text(more, 4)), shared(3, sqlite::Text(more, 5))},
                  kept.fit.name};
    if (!more.getColumn(6).isNull()) kept.result = nlohmann::ordered_json::parse(sqlite::Text(more, 6));
    return kept;
  });
}

Result<std::vector<ListedFit>> FitStore::List(const FitFilter& filter) {
  return state_->Read([&](SQLite::Database& database) -> Result<std::vector<ListedFit>> {
    SQLite::Statement rows(database,
                           kListedColumns + fit_store::ConditionsOf(filter) + " ORDER BY run DESC LIMIT :limit");
    rows.bind(":limit", std::min(filter.limit, kMaxListed));
    if (filter.before) rows.bind(":before", *filter.before);
    for (const auto& [name, value] : fit_store::TextConditions(filter)) rows.bind(name, value);
    std::vector<ListedFit> fits;
    while (rows.executeStep()) {
      fits.push_back(FitOf(rows));
      fits.back().window = fit_store::WindowOf(database, fits.back().run);
      fits.back().models = fit_store::ModelsOf(database, fits.back().run);
    }
    return fits;
  });
}

Result<ListedBatch> FitStore::FindBatch(const std::string& id) {
  return state_->Read([&](SQLite::Database& database) -> Result<ListedBatch> {
    SQLite::Statement row(database, std::string(kBatches) + "WHERE batches.id = ? GROUP BY batches.batch");
    if (!sqlite::Bind(row, id).executeStep()) return Unknown("batch", id);
    return BatchOf(row);
  });
}

Result<std::vector<ListedBatch>> FitStore::ListBatches(int limit, const std::optional<std::int64_t>& before) {
  return state_->Read([&](SQLite::Database& database) -> Result<std::vector<ListedBatch>> {
    SQLite::Statement rows(database, std::string(kBatches) +
                                         "WHERE batches.batch < coalesce(?, batches.batch + 1) "
                                         "GROUP BY batches.batch ORDER BY batches.batch DESC LIMIT ?");
    sqlite::Bind(rows, before, std::min(limit, kMaxListed));
    std::vector<ListedBatch> batches;
    while (rows.executeStep()) batches.push_back(BatchOf(rows));
    return batches;
  });
}

Result<std::vector<ListedFit>> FitStore::RunsOf(const std::string& batch) {
  return state_->Read([&](SQLite::Database& database) -> Result<std::vector<ListedFit>> {
    SQLite::Statement rows(database, std::string(kListedColumns) + "WHERE batches.id = ? ORDER BY run");
    sqlite::Bind(rows, batch);
    std::vector<ListedFit> fits;
    while (rows.executeStep()) fits.push_back(FitOf(rows));
    return fits;
  });
}

Result<BatchAgreement> FitStore::AgreementOf(const std::string& batch) {
  ASSIGN_OR_RETURN(const ListedBatch found, FindBatch(batch));
  return state_->Read(
      [&](SQLite::Database& database) -> Result<BatchAgreement> { return AgreementOfBatch(database, found.batch); });
}

Result<std::vector<FitStore::Waiting>> FitStore::WaitingRuns() {
  return state_->Read([&](SQLite::Database& database) -> Result<std::vector<Waiting>> {
    SQLite::Statement rows(database,
                           "SELECT runs.id, batches.id FROM requests JOIN runs USING(run) JOIN batches USING(batch) "
                           "WHERE exit_code IS NULL ORDER BY run");
    std::vector<Waiting> waiting;
    while (rows.executeStep()) waiting.push_back({sqlite::Text(rows, 0), sqlite::Text(rows, 1)});
    return waiting;
  });
}

Result<std::optional<KnownAnswer>> FitStore::FindAnswer(const std::string& key) {
  return state_->Read([&](SQLite::Database& database) -> Result<std::optional<KnownAnswer>> {
    SQLite::Statement row(database,
                          "SELECT request_sha256, location FROM answers WHERE key = ? AND "
                          "created >= strftime('%Y-%m-%dT%H:%M:%SZ', 'now', '-1 day')");
    if (!sqlite::Bind(row, key).executeStep()) return std::nullopt;
    return KnownAnswer{sqlite::Text(row, 0), sqlite::Text(row, 1)};
  });
}

}  // namespace pendulum
