// SPDX-License-Identifier: Apache-2.0
// Tests of Store: durability, several processes, damaged files, and files that are not stores.
#include <array>
#include <atomic>
#include <barrier>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "batch/store_schema.h"
#include "pendulum/batch/store.h"
#include "tests/batch/example_runs.h"

namespace pendulum::store_file_test {
namespace {

namespace fs = std::filesystem;

using example_runs::RefittedOutcome;
using example_runs::SourceOfIds;
using example_runs::StoreOf;
using example_runs::UnfittedOutcome;
using testing::StartsWith;

class StoreFileTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Store Make(const std::vector<std::string>& ids) const { return StoreOf(path_, SourceOfIds(ids)); }

  Store Reopen(Store::Mode mode = Store::Mode::kRead) const { return Store::Open(path_, mode).value(); }

  Status FaultOf(Store::Mode mode) const {
    const auto store = Store::Open(path_, mode);
    EXPECT_FALSE(store);
    return store ? Status{StatusCode::kInternal, ""} : store.error();
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("store_file_test_" + std::to_string(getpid()));
  const std::string path_ = folder_ / "results.sqlite";
};

// ---- Durability and other processes --------------------------------------------------------------------------------

TEST_F(StoreFileTest, KeepsExactlyTheCommittedData) {
  {
    Store store = Make({"a", "b"});
    ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Commit());
    ASSERT_TRUE(store.Put("a", UnfittedOutcome()) && store.Put("b", UnfittedOutcome()));
  }
  Store store = Reopen();
  EXPECT_EQ(store.Count()->pending, 1);
  EXPECT_EQ(store.Count()->unfitted, 0);
  EXPECT_EQ(store.Count()->fits, 2);
}

TEST_F(StoreFileTest, ShowsCommittedDataToReaders) {
  Store store = Make({"a"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  Store reader = Reopen();
  EXPECT_EQ(reader.Count()->pending, 1);
  ASSERT_TRUE(store.Commit());
  EXPECT_EQ(reader.Count()->pending, 0);
}

TEST_F(StoreFileTest, AllowsOneWriter) {
  Store store = Make({"a"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  Store other = Reopen(Store::Mode::kWrite);
  const std::atomic<bool> stop = true;  // otherwise it would wait for ten minutes
  other.ShortenWaitsOnStop(&stop);
  const auto put = other.Put("a", UnfittedOutcome());
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, StatusCode::kTryAgain);
  EXPECT_EQ(put.error().message(), path_ + ": another process uses it; try again when that process is done");
  ASSERT_TRUE(store.Commit());
  ASSERT_TRUE(other.Put("a", UnfittedOutcome()) && other.Commit());  // the same data later
  EXPECT_EQ(Reopen().Count()->unfitted, 1);
}

// A commit needs the file exclusively; it waits for a reader in progress.
TEST_F(StoreFileTest, WaitsForAReader) {
  Store store = Make({"a", "b"});
  ASSERT_TRUE(store.Commit());
  Store reader = Reopen();
  SQLite::Statement rows(reader.database(), "SELECT id FROM runs");
  ASSERT_TRUE(rows.executeStep());
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  std::atomic<bool> stop = true;
  store.ShortenWaitsOnStop(&stop);
  EXPECT_EQ(store.Commit().error().code, StatusCode::kTryAgain);
  stop = false;
  std::atomic<bool> ended = false;
  std::thread end([&] {
    std::this_thread::sleep_for(std::chrono::seconds(3));  // longer than the limit of a stopped writer
    ended = true;
    rows.reset();
  });
  const auto committed = store.Commit();  // commits the earlier Put
  EXPECT_TRUE(ended);
  end.join();
  ASSERT_TRUE(committed) << committed.error().message();
  EXPECT_EQ(Reopen().Count()->pending, 1);
}

// The last pages are overwritten with invalid data. The first ones, which Open reads, are unchanged.
TEST_F(StoreFileTest, ChecksAllPages) {
  constexpr std::size_t kPage = 4096;
  Store store = Make({"a", "b"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", RefittedOutcome()) && store.Commit());
  EXPECT_TRUE(Reopen().Check());
  {
    const std::size_t late = fs::file_size(path_) / kPage * 3 / 4 * kPage;  // the schema is before it
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(late));
    file << std::string(fs::file_size(path_) - late, '\x5a');
  }
  const auto checked = Reopen().Check();
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(checked.error().message(), StartsWith(path_ + ": the file is damaged ("));
}

TEST_F(StoreFileTest, KeepsRunsMissingFromTheLastManifest) {
  Store store = Make({"a", "b"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", RefittedOutcome()) && store.Commit());
  ASSERT_TRUE(store.Begin(SourceOfIds({"b", "c"}), std::nullopt, "{}"));
  EXPECT_EQ(store.Count()->earlier, 1);
  EXPECT_EQ(store.database().execAndGet("SELECT position FROM runs WHERE id = 'a'").getInt(), -1);
  ASSERT_TRUE(store.Begin(SourceOfIds({"b", "a"}), std::nullopt, "{}"));
  EXPECT_EQ(store.Count()->earlier, 0);
}

TEST_F(StoreFileTest, ReportsAnUnreadableStore) {
  Make({"a"});
  fs::permissions(folder_, fs::perms::all);
  fs::permissions(path_, fs::perms::none);
  const uid_t self = ::geteuid();
  constexpr uid_t kNobody = 65534;  // root can read every file
  if (self == 0) {
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  const Status fault = FaultOf(Store::Mode::kRead);
  if (self == 0) {
    ASSERT_EQ(::seteuid(self), 0);
  }
  EXPECT_EQ(fault.code, StatusCode::kDataLoss);
  EXPECT_EQ(fault.message(), path_ + ": the file cannot be read; check its permissions");
}

// ---- Open ----------------------------------------------------------------------------------------------------------

TEST_F(StoreFileTest, ReportsAMissingStore) {
  EXPECT_EQ(FaultOf(Store::Mode::kRead).code, StatusCode::kNotFound);
  EXPECT_EQ(FaultOf(Store::Mode::kRead).message(), path_ + ": there is no such store; check the path");
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(StoreFileTest, StartsInAFileWithoutTables) {
  std::ofstream file(path_);
  file.close();
  EXPECT_EQ(FaultOf(Store::Mode::kRead).code, StatusCode::kDataLoss);
  Store store = Make({"a"});
  EXPECT_EQ(store.database().execAndGet("PRAGMA user_version").getInt(), 9);
  EXPECT_EQ(Reopen().Count()->runs, 1);
}

/// Makes a store of an earlier version.
void MakeFormer(const std::string& path, std::size_t version) {
  SQLite::Database former(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  for (std::size_t step = 0; step < version; ++step) former.exec(std::string(kStoreMigrations.at(step)));
  former.exec(
      "INSERT INTO runs(id, position, path, rig, calibration, models, columns) VALUES('a', 0, 'a', '', '', '', '{}');"
      "PRAGMA application_id = " +
      std::to_string(kStoreId) + "; PRAGMA user_version = " + std::to_string(version));
}

TEST_F(StoreFileTest, ReadsAnOlderStoreThatCannotBeChanged) {
  const uid_t self = ::geteuid();
  constexpr uid_t kNobody = 65534;  // root can write every file
  for (std::size_t version = 1; version < kStoreMigrations.size(); ++version) {
    fs::remove(path_);
    MakeFormer(path_, version);
    fs::permissions(path_, fs::perms(0444));
    fs::permissions(folder_, fs::perms(0555));
    if (self == 0) {
      ASSERT_EQ(::seteuid(kNobody), 0);
    }
    const auto counts = Store::Open(path_, Store::Mode::kRead).and_then([](Store store) { return store.Count(); });
    const Status fault = FaultOf(Store::Mode::kWrite);
    if (self == 0) {
      ASSERT_EQ(::seteuid(self), 0);
    }
    fs::permissions(folder_, fs::perms::all);
    ASSERT_TRUE(counts) << version << ": " << counts.error().message();
    EXPECT_EQ(counts->pending, 1);
    EXPECT_EQ(fault.code, StatusCode::kCannotWrite) << fault.message();
    EXPECT_EQ(SQLite::Database(path_).execAndGet("PRAGMA user_version").getInt(), version);
  }
}

// A program that reads the version before it has the lock would repeat the other's update.
TEST_F(StoreFileTest, IsUpdatedByTwoProgramsAtOnce) {
  constexpr int kPrograms = 4;
  for (std::size_t version = 1; version < kStoreMigrations.size(); ++version) {
    fs::remove(path_);
    MakeFormer(path_, version);
    std::barrier ready(kPrograms);
    std::array<std::string, kPrograms> faults;
    {
      std::vector<std::jthread> programs;
      for (std::string& fault : faults) {
        programs.emplace_back([&] {
          ready.arrive_and_wait();
          const auto store = Store::Open(path_, Store::Mode::kRead);
          if (!store) fault = store.error().message();
        });
      }
    }
    EXPECT_THAT(faults, testing::Each("")) << "version " << version;
    EXPECT_EQ(SQLite::Database(path_).execAndGet("PRAGMA user_version").getInt(), kStoreMigrations.size());
  }
}

TEST_F(StoreFileTest, RefusesFoldersAndTexts) {
  const auto folder = Store::Open(folder_, Store::Mode::kWrite);
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(folder.error().message(), folder_.string() + ": this is a directory; name a store in it");
  std::ofstream(path_) << "path,id\na.csv,1\n";
  for (const auto mode : {Store::Mode::kRead, Store::Mode::kWrite}) {
    EXPECT_EQ(FaultOf(mode).code, StatusCode::kDataLoss);
    EXPECT_EQ(FaultOf(mode).message(), path_ + ": this is not an SQLite file; name an SQLite file");
  }
  EXPECT_EQ(fs::file_size(path_), 16);
}

TEST_F(StoreFileTest, RefusesOtherSqliteFiles) {
  SQLite::Database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE runs(x)");
  for (const auto mode : {Store::Mode::kRead, Store::Mode::kWrite}) {
    EXPECT_EQ(FaultOf(mode).code, StatusCode::kDataLoss);
    EXPECT_EQ(FaultOf(mode).message(),
              path_ + ": this is not a result store of refit_pendulums; name a result store or a new file");
  }
}

TEST_F(StoreFileTest, RefusesAStoreOfANewerVersion) {
  Make({"a"}).database().exec("PRAGMA user_version = 99");
  for (const auto mode : {Store::Mode::kRead, Store::Mode::kWrite}) {
    EXPECT_EQ(FaultOf(mode).code, StatusCode::kDataLoss);
    EXPECT_EQ(FaultOf(mode).message(), path_ +
                                           ": the store has version 99 of a newer program, but this program reads "
                                           "versions up to 9; use the newer program");
  }
}

TEST_F(StoreFileTest, ReportsDamage) {
  {
    Store store = Make({"a"});
    ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Commit());
  }
  fs::resize_file(path_, fs::file_size(path_) / 2);
  EXPECT_EQ(FaultOf(Store::Mode::kRead).code, StatusCode::kDataLoss);
  EXPECT_THAT(FaultOf(Store::Mode::kRead).message(), StartsWith(path_ + ": the file is damaged ("));
}

TEST_F(StoreFileTest, ReportsDamagedContent) {
  Store store = Make({"a"});
  store.database().exec("UPDATE meta SET value = 'many' WHERE key = 'runs'");
  const auto meta = store.Meta();
  ASSERT_FALSE(meta);
  EXPECT_EQ(meta.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(meta.error().message(), StartsWith(path_ + ": the file is damaged ("));
}

TEST_F(StoreFileTest, ReportsAPathThatCannotBeCreated) {
  const auto store = Store::Open(folder_ / "nowhere" / "results.sqlite", Store::Mode::kWrite);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(store.error().message(), StartsWith("cannot write " + (folder_ / "nowhere").string()));
}

}  // namespace
}  // namespace pendulum::store_file_test
