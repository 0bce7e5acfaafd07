// SPDX-License-Identifier: Apache-2.0
// Tests of FitStore: durability, other processes, older stores and a full disk.
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "batch/store_schema.h"
#include "pendulum/batch/fit_store.h"
#include "pendulum/batch/store.h"
#include "tests/batch/example_runs.h"
#include "tests/batch/fit_orders.h"
#include "tests/batch/made_outcomes.h"

namespace pendulum::fit_store_file_test {
namespace {

namespace fs = std::filesystem;

using fit_orders::IdsOf;
using fit_orders::kCreated;
using fit_orders::OrderOf;
using fit_orders::OrdersOf;
using made_outcomes::FitOf;
using made_outcomes::OutcomeOf;
using testing::ElementsAre;
using testing::StartsWith;

const RunOutcome& Outcome() {
  static const RunOutcome outcome = OutcomeOf({FitOf("viscous", 2)});
  return outcome;
}

class FitStoreFileTest : public fit_orders::FitStoreFolder {
 protected:
  void Add(const std::string& id) {
    const auto added = Store().Add(OrderOf(id), Outcome(), std::nullopt);
    ASSERT_TRUE(added) << added.error().message();
  }

  /// The ids in a copy of the current files on disk: the worst state after a loss of power.
  std::vector<std::string> IdsInACopy() const {
    const small_batch::Folder other("fit_store_copy");
    for (const char* end : {"", "-wal"}) {
      if (fs::exists(path_ + end)) fs::copy_file(path_ + end, (other / "fits.sqlite").string() + end);
    }
    const auto store = FitStore::Open(other / "fits.sqlite");
    EXPECT_TRUE(store) << store.error().message();
    return store ? IdsOf((*store)->List({}).value()) : std::vector<std::string>();
  }
};

// ---- On the disk ---------------------------------------------------------------------------------------------------

TEST_F(FitStoreFileTest, StoresEachChangeOnTheDiskBeforeReturning) {
  Add("a");
  EXPECT_THAT(IdsInACopy(), ElementsAre("a"));
  ASSERT_TRUE(Store().AddBatch("batch", kCreated, OrdersOf({"b", "c"}), std::nullopt));
  EXPECT_THAT(IdsInACopy(), ElementsAre("c", "b", "a"));
  ASSERT_TRUE(Store().DeleteFit("b"));
  EXPECT_THAT(IdsInACopy(), ElementsAre("c", "a"));
}

TEST_F(FitStoreFileTest, LeavesOnlyOneFileWhenClosed) {
  Add("a");
  EXPECT_THAT(folder_.Names(), testing::Contains("fits.sqlite-wal"));
  Close();
  EXPECT_THAT(folder_.Names(), ElementsAre("fits.sqlite"));
  EXPECT_EQ(SQLite::Database(path_).execAndGet("PRAGMA journal_mode").getString(), "delete");
  Open();
  EXPECT_THAT(IdsOf(Store().List({}).value()), ElementsAre("a"));
}

TEST_F(FitStoreFileTest, KeepsConcurrentAdditions) {
  constexpr int kThreads = 8, kRuns = 20;
  FitStore& store = Store();
  std::atomic<int> lost = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < kRuns; ++i) {
        const std::string id = std::to_string(t) + "_" + std::to_string(i);
        const auto added = store.Add(OrderOf(id), Outcome(), std::nullopt);
        if (!added || NumberOutside("SELECT count(*) FROM results WHERE id = '" + id + "'") != 1) ++lost;
        if (!store.Find(id) || !store.List({})) ++lost;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM requests"), kThreads * kRuns);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM fits"), kThreads * kRuns);
}

TEST_F(FitStoreFileTest, RefusesOnlyTheInvalidWritesAmongConcurrentWrites) {
  constexpr int kThreads = 8, kRuns = 20;
  FitStore& store = Store();
  Add("taken");
  std::atomic<int> added = 0, refused = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < kRuns; ++i) {
        const bool is_good = (t + i) % 2 == 0;
        const std::string id = is_good ? std::to_string(t) + "_" + std::to_string(i) : "taken";
        ++(store.Add(OrderOf(id), Outcome(), std::nullopt) ? added : refused);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(added, kThreads * kRuns / 2);
  EXPECT_EQ(refused, kThreads * kRuns / 2);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM requests"), 1 + kThreads * kRuns / 2);
}

// ---- Other processes -----------------------------------------------------------------------------------------------

TEST_F(FitStoreFileTest, ExcludesOtherWriters) {
  Add("a");
  const auto other = FitStore::Open(path_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, StatusCode::kTryAgain);
  EXPECT_EQ(other.error().message(), path_ + ": another process writes to this file; try again when it is done");
  Close();
  EXPECT_TRUE(FitStore::Open(path_));
}

TEST_F(FitStoreFileTest, IsNotBlockedByReaders) {
  Add("a");
  const SQLite::Database reader(path_, SQLite::OPEN_READONLY);
  SQLite::Statement rows(reader, "SELECT id FROM runs ORDER BY run");
  ASSERT_TRUE(rows.executeStep());
  Add("b");  // while the read is in progress
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM runs"), 2);
  EXPECT_FALSE(rows.executeStep());  // the reader sees the state at the start of its query
  rows.reset();
  EXPECT_EQ(pendulum::Store::Open(path_, pendulum::Store::Mode::kRead)->Count()->runs, 2);
}

// Another process keeps the file open while the service ends and restarts.
TEST_F(FitStoreFileTest, OpensWhileAnotherProcessReads) {
  Add("a");
  const SQLite::Database reader(path_, SQLite::OPEN_READONLY);
  SQLite::Statement rows(reader, "SELECT id FROM runs");
  ASSERT_TRUE(rows.executeStep());
  Close();
  const auto again = FitStore::Open(path_);
  ASSERT_TRUE(again) << again.error().message();
  ASSERT_TRUE((*again)->Add(OrderOf("b"), Outcome(), std::nullopt));
  EXPECT_FALSE(rows.executeStep());
  EXPECT_THAT(IdsOf((*again)->List({}).value()), ElementsAre("b", "a"));
}

TEST_F(FitStoreFileTest, ReportsAPathThatCannotBeCreated) {
  const auto store = FitStore::Open(folder_ / "nowhere" / "fits.sqlite");
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(store.error().message(), StartsWith("cannot write " + (folder_ / "nowhere").string()));
}

TEST_F(FitStoreFileTest, RejectsOtherFiles) {
  folder_.Write("fits.sqlite", "path,id\na.csv,1\n");
  const auto store = FitStore::Open(path_);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(store.error().message(), path_ + ": this is not an SQLite file; name an SQLite file");
  EXPECT_THAT(folder_.Names(), ElementsAre("fits.sqlite"));
}

TEST_F(FitStoreFileTest, ReportsDamage) {
  Add("a");
  SQLite::Database(path_, SQLite::OPEN_READWRITE).exec("UPDATE runs SET result = '{'");
  const auto kept = Store().Find("a");
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(kept.error().message(), StartsWith(path_ + ": the file is damaged ("));
}

// ---- Older stores, and stores of refit_pendulums -------------------------------------------------------------------

/// A store of the first version with one refitted run.
void MakeFirstVersion(const std::string& path) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec(std::string(kStoreMigrations[0]));
  database.exec("PRAGMA application_id = " + std::to_string(kStoreId) + "; PRAGMA user_version = 1");
  database.exec(
      "INSERT INTO runs(id, position, path, rig, calibration, models, columns, exit_code, result) "
      "VALUES('old', 0, 'old.csv', '', '', '', '{}', 0, '{\"schema_version\":1,\"data\":{\"why\":\"x\"},\"fits\":[]}');"
      "INSERT INTO fits(run, model, status, reason) VALUES(1, 'coulomb', 'converged', '');"
      "INSERT INTO quantities(run, model, name, derived, unit, fixed, at_bound) "
      "VALUES(1, 'coulomb', 'edge_lag', 0, 'rad', 0, 0)");
}

TEST_F(FitStoreFileTest, UpdatesAnOlderStore) {
  MakeFirstVersion(path_);
  Add("new");
  EXPECT_EQ(NumberOutside("PRAGMA user_version"), 9);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM runs WHERE id = 'old' AND exit_code = 0"), 1);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM quantities WHERE name = 'hysteresis'"), 1);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM runs WHERE json_extract(result, '$.schema_version') = 3 AND "
                          "json_extract(result, '$.recordings[0].reason') = 'x'"),
            1);
  EXPECT_THAT(IdsOf(Store().List({}).value()), ElementsAre("new"));  // the old run was not requested from a service
  EXPECT_EQ(Store().Find("old").error().code, StatusCode::kNotFound);
  EXPECT_EQ(Store().DeleteFit("old").error().code, StatusCode::kNotFound);
}

TEST_F(FitStoreFileTest, UpdatesAStoreOfAServiceWithoutNames) {
  {
    SQLite::Database database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    for (int version = 0; version < 3; ++version) database.exec(std::string(kStoreMigrations.at(version)));
    database.exec("PRAGMA application_id = " + std::to_string(kStoreId) + "; PRAGMA user_version = 3");
    database.exec(
        "INSERT INTO runs(id, position, path, rig, calibration, models, columns, exit_code, result) "
        "VALUES('old', -1, 'old.csv', '', '', '', '{}', 0, '{\"schema_version\":2,\"data\":"
        "{\"window_s\":[1,2.5]},\"fits\":[]}');"
        "INSERT INTO files(sha256, bytes) VALUES('x', 'time_s');"
        "INSERT INTO requests VALUES(1, NULL, '2026-11-23T21:40:05Z', '{}', 1, NULL, NULL)");
  }
  const auto fits = Store().List({});
  ASSERT_TRUE(fits) << fits.error().message();
  ASSERT_THAT(IdsOf(*fits), ElementsAre("old"));
  EXPECT_EQ(fits->at(0).name, "");
  EXPECT_EQ(fits->at(0).ShownName(), "old.csv");
  EXPECT_EQ(fits->at(0).window, (std::array{1.0, 2.5}));
  ASSERT_TRUE(Store().Rename("old", "Heavy bob"));
  Add("new");
  EXPECT_EQ(Store().Find("old")->fit.name, "Heavy bob");
  EXPECT_EQ(Store().Find("new")->fit.name, "");
}

TEST_F(FitStoreFileTest, KeepsItsRunsIfAManifestIsRefittedIntoTheSameFile) {
  ASSERT_TRUE(Store().AddBatch("batch", kCreated, OrdersOf({"a", "b"}), std::nullopt));
  Close();
  {
    auto store = pendulum::Store::Open(path_, pendulum::Store::Mode::kWrite);
    ASSERT_TRUE(store) << store.error().message();
    ASSERT_TRUE(store->Begin(example_runs::SourceOfIds({"of_the_manifest"}), std::nullopt, "{}"));
  }
  Open();
  EXPECT_EQ(Store().WaitingRuns()->size(), 2);
  EXPECT_EQ(Store().FindBatch("batch")->runs, 2);
  Add("c");
  Add("d");
  EXPECT_THAT(IdsOf(Store().List({}).value()), ElementsAre("d", "c", "b", "a"));
}

// ---- Full disk -----------------------------------------------------------------------------------------------------

/// Limits each file that this process writes to `bytes` bytes. Writing fails as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(std::uintmax_t bytes) {
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

constexpr std::size_t kMegabyte = std::size_t{1} << 20U;

FitOrder LargeOrder(const std::string& id) {
  FitOrder order = OrderOf(id);
  order.files.data.bytes = std::string(kMegabyte, 'x') + id;
  return order;
}

TEST_F(FitStoreFileTest, ReportsAFullDiskAndContinuesLater) {
  Add("a");
  {
    const FullDisk full(kMegabyte / 2);
    const auto refused = Store().Add(LargeOrder("b"), Outcome(), RequestKey{"key", "sha"});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, StatusCode::kCannotWrite);
    EXPECT_THAT(refused.error().message(), StartsWith("cannot write " + path_ + ": "));
    EXPECT_THAT(IdsOf(Store().List({}).value()), ElementsAre("a"));
  }
  Add("c");
  ASSERT_TRUE(Store().Add(LargeOrder("b"), Outcome(), std::nullopt));
  EXPECT_THAT(IdsInACopy(), ElementsAre("b", "c", "a"));
}

// The disk becomes full at some statement, which differs between trials. When there is space again, the next run must
// be stored.
TEST_F(FitStoreFileTest, RecoversFromAFullDiskAtOnce) {
  Add("first");
  int refusals = 0;
  for (std::uintmax_t room = 0; room < 40; ++room) {
    const std::string id = std::to_string(room);
    const std::string log = path_ + "-wal";
    bool is_kept = false;
    {
      const FullDisk full(fs::file_size(log) + room * 1024);
      is_kept = Store().Add(LargeOrder(id), Outcome(), std::nullopt).has_value();
    }
    refusals += is_kept ? 0 : 1;
    EXPECT_EQ(NumberOutside("SELECT count(*) FROM runs WHERE id = '" + id + "'"), is_kept ? 1 : 0);
    const auto next = Store().Add(OrderOf("next_" + id), Outcome(), std::nullopt);
    ASSERT_TRUE(next) << room << ": " << next.error().message();
  }
  EXPECT_GT(refusals, 0);
}

TEST_F(FitStoreFileTest, KeepsEveryRunStoredByManyThreadsOnAFullDisk) {
  constexpr int kThreads = 6, kRuns = 6;
  FitStore& store = Store();
  Add("first");
  std::vector<std::vector<std::string>> kept(kThreads);
  {
    const FullDisk full(4 * kMegabyte);
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        for (int i = 0; i < kRuns; ++i) {
          const std::string id = std::to_string(t) + "_" + std::to_string(i);
          if (store.Add(LargeOrder(id), Outcome(), std::nullopt)) kept[t].push_back(id);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  std::size_t count = 1;
  for (const auto& ids : kept) {
    count += ids.size();
    for (const std::string& id : ids) {
      EXPECT_EQ(NumberOutside("SELECT count(*) FROM results WHERE id = '" + id + "'"), 1) << id;
    }
  }
  EXPECT_LT(count, 1 + kThreads * kRuns);  // some writes failed
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM requests"), count);
  Add("last");
}

}  // namespace
}  // namespace pendulum::fit_store_file_test
