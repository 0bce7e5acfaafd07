// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/shards.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "pendulum/batch/store_lock.h"
#include "tests/batch/shards_folder.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::shards_test {
namespace {

using shards_folder::ShardsTest;
using small_batch::Folder;
using small_batch::OptionsWith;
using small_batch::RecordingText;
using small_batch::RefitInto;
using small_batch::WriteBatch;
using store_rows::AllRows;
using store_rows::Rows;
using store_rows::Value;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

namespace fs = std::filesystem;

// ---- Shards of a batch ---------------------------------------------------------------------------------------------

TEST(ShardPath, IsThePathOfAShardsStore) {
  EXPECT_EQ(ShardPath("out", 3), fs::path("out/shard-3.sqlite"));
  EXPECT_EQ(ShardList({3, 17}), "3,17");
  EXPECT_EQ(ShardList({}), "");
}

// ---- Merging -------------------------------------------------------------------------------------------------------

TEST_F(ShardsTest, GiveTheSameStoreAsOneRefit) {
  const std::vector<std::string> at_once = RowsAtOnce();
  for (const std::int64_t count : {1, 2, 3, 9}) {  // with nine shards two are empty
    fs::remove_all(out_);
    fs::create_directory(out_);
    fs::remove(store_);
    AllShards(count);
    const auto runs = Merge(count);
    ASSERT_TRUE(runs) << runs.error().message();
    EXPECT_EQ(*runs, kRuns + 1);
    EXPECT_EQ(AllRows(store_), at_once) << count;
    auto store = Store::Open(store_, Store::Mode::kRead);
    ASSERT_TRUE(store);
    const auto meta = store->Meta();
    ASSERT_TRUE(meta);
    EXPECT_TRUE(meta->complete);
    EXPECT_FALSE(meta->shard);
    EXPECT_EQ(meta->runs, kRuns + 1);
  }
}

TEST_F(ShardsTest, NeedNoRefitOfTheBatchAfterMerging) {
  AllShards(3);
  ASSERT_TRUE(Merge(3));
  const RefitCounts counts = RefitInto(store_, folder_ / "runs.csv", options_);
  EXPECT_EQ(counts.current, kRuns + 1);
  EXPECT_EQ(counts.refitted, 0);
}

TEST_F(ShardsTest, MayBeMergedTwice) {
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  const std::vector<std::string> rows = AllRows(store_);
  const auto again = Merge(2);
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(*again, kRuns + 1);
  EXPECT_EQ(AllRows(store_), rows);
}

TEST_F(ShardsTest, AreNoNewsWhenTheyAreMergedAgain) {
  const std::string news = "SELECT DISTINCT coalesce(news, 'as before') FROM runs";
  AllShards(3);
  ASSERT_TRUE(Merge(3));
  EXPECT_EQ(Value(store_, news), "new");
  ASSERT_TRUE(Merge(3));
  EXPECT_EQ(Value(store_, news), "as before");
}

TEST_F(ShardsTest, ReplaceOnlyTheirOwnRuns) {
  folder_.Write("other.csv", "path,id\n0.csv,other\n1.csv,b\n");  // b is 1.csv in this batch, too
  RefitInto(store_, folder_ / "other.csv", OptionsWith({"drag"}));
  const std::string others = "SELECT result FROM runs WHERE id = 'other'";
  const std::string before = Value(store_, others);
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  EXPECT_EQ(Value(store_, others), before);
  EXPECT_EQ(Value(store_, "SELECT count(*) FROM runs"), "8");
  EXPECT_THAT(Rows(store_, "SELECT model FROM fits JOIN runs USING(run) WHERE id = 'b' AND fits.stale IS NULL"),
              ElementsAre("viscous"));
  EXPECT_THAT(Rows(store_, "SELECT model FROM fits JOIN runs USING(run) WHERE id = 'other'"), ElementsAre("drag"));
  EXPECT_EQ(Value(store_, "SELECT count(*) FROM options"), "2");
  EXPECT_THAT(Rows(store_, "PRAGMA foreign_key_check"), IsEmpty());
  EXPECT_EQ(Value(store_, "PRAGMA integrity_check"), "ok");
}

TEST_F(ShardsTest, LeaveAResultThatTheyCouldNotRepeat) {
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  const std::string result = "SELECT result FROM runs WHERE id = 'b'", count = "SELECT count(*) FROM quantities";
  const std::string before = Value(store_, result), quantities = Value(store_, count);
  std::filesystem::remove(folder_ / "1.csv");
  for (int k = 0; k < 2; ++k) std::filesystem::remove(ShardPath(out_, k));  // an array of jobs on empty disks
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  EXPECT_EQ(Value(store_, result), before);
  EXPECT_EQ(Value(store_, count), quantities);
  EXPECT_THAT(Rows(store_, "SELECT id, stale FROM runs WHERE stale IS NOT NULL"),
              ElementsAre(testing::StartsWith("b|1.csv: there is no such file")));
}

TEST_F(ShardsTest, LeaveTheResultOfALongerRecording) {
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  const std::string result = "SELECT result FROM runs WHERE id = 'b'";
  const std::string before = Value(store_, result), text = folder_.Read("1.csv");
  folder_.Write("1.csv", text.substr(0, text.rfind('\n', text.size() * 9 / 10) + 1));
  for (int k = 0; k < 2; ++k) std::filesystem::remove(ShardPath(out_, k));
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  EXPECT_EQ(Value(store_, result), before);
  EXPECT_THAT(Rows(store_, "SELECT id, stale FROM runs WHERE stale IS NOT NULL"),
              ElementsAre(testing::StartsWith("b|1.csv: the recording has become shorter")));
}

TEST_F(ShardsTest, LeaveFitsOfOtherModels) {
  small_batch::RefitInto(store_, folder_ / "runs.csv", small_batch::OptionsWith({"viscous", "coulomb"}));
  const std::string of_others = "SELECT * FROM quantities WHERE model = 'coulomb'";
  const auto before = Rows(store_, of_others);
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  EXPECT_EQ(Rows(store_, of_others), before);
  EXPECT_THAT(Rows(store_,
                   "SELECT model, status, stale IS NULL, json IS NULL, count(*) FROM fits "
                   "GROUP BY 1, 2, 3, 4 ORDER BY 1, 2"),
              testing::ElementsAre("coulomb|converged|0|0|6", "viscous|converged|1|1|6", "viscous|failed|1|1|1"));
}

TEST_F(ShardsTest, AreCurrentAgainWhenARecordingComesBack) {
  AllShards(2);
  const std::string text = folder_.Read("1.csv");
  std::filesystem::remove(folder_ / "1.csv");
  AllShards(2);
  folder_.Write("1.csv", text);
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs WHERE stale IS NOT NULL"), IsEmpty());
}

TEST_F(ShardsTest, AreNotMergedIfARigChangedBetweenThem) {
  folder_.Write("rig.json", small_batch::kRigText);
  folder_.Write("runs.csv", "path,id,rig\n0.csv,a,rig.json\n1.csv,b,rig.json\n");
  RefitOne(0, 2, options_);
  folder_.Write("rig.json", std::string(small_batch::kRigText) + "\n");
  RefitOne(1, 2, options_);
  const auto merged = Merge(2);
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().message(), ShardPath(out_, 1).string() +
                                          ": rig.json changed between the refits of this shard and of " +
                                          ShardPath(out_, 0).string() + "; run the shards again");
  RefitOne(0, 2, options_);
  EXPECT_TRUE(Merge(2));
}

TEST_F(ShardsTest, AreNotMergedIntoTheStoreOfAShard) {
  AllShards(2);
  const auto merged = MergeShards(out_, 2, ShardPath(out_, 1));
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(merged.error().message(),
            ShardPath(out_, 1).string() + ": this is one of the shards; name another store to merge them into");
  EXPECT_EQ(MissingShards(out_, 2).value().size(), 0);
}

TEST_F(ShardsTest, LeaveNoOtherFilesAfterMerging) {
  AllShards(2);
  for (const char* name : {".pendulum.4.0.tmp", "shard-0.sqlite.part", "shard-1.sqlite.attempt-9-0-node-4",
                           "shard-1.sqlite.attempt-9-0-node-4-journal"}) {
    folder_.Write(std::string("out/") + name, "of a crashed attempt");
  }
  folder_.Write("out/notes.txt", "mine");
  ASSERT_TRUE(Merge(2));
  EXPECT_THAT(NamesInOut(), ElementsAre("notes.txt", "shard-0.sqlite", "shard-1.sqlite"));
  EXPECT_THAT(folder_.Names("store.sqlite"), ElementsAre("store.sqlite"));
}

// A killed merge leaves its file and journal. SQLite would corrupt a new file by applying that journal to it.
TEST_F(ShardsTest, AreMergedAfterAKilledMerge) {
  const std::vector<std::string> at_once = RowsAtOnce();
  AllShards(2);
  ASSERT_TRUE(Merge(2));
  LeaveAsKilled(store_, folder_ / "store.sqlite.merging");
  const auto merged = Merge(2);
  ASSERT_TRUE(merged) << merged.error().message();
  EXPECT_EQ(Value(store_, "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(Value(store_, "SELECT count(*) FROM options"), "1");
  EXPECT_EQ(AllRows(store_), at_once);
}

// ---- Missing and wrong shards --------------------------------------------------------------------------------------

TEST_F(ShardsTest, AreListedAndNotMergedWhileMissing) {
  RefitOne(1, 4, options_);
  std::atomic<bool> stop = false;
  RefitOne(3, 4, StoppingAfter(1, stop));
  const auto missing = MissingShards(out_, 4);
  ASSERT_TRUE(missing) << missing.error().message();
  EXPECT_THAT(*missing, ElementsAre(0, 2, 3));
  const auto merged = Merge(4);
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().code, StatusCode::kNotFound);
  EXPECT_EQ(merged.error().message(),
            out_.string() + ": of 4 shards these are missing: 0,2,3; run them and merge again");
  EXPECT_FALSE(fs::exists(store_));
  EXPECT_TRUE(fs::exists(out_ / "shard-3.sqlite.part"));  // finished work is kept
}

TEST_F(ShardsTest, AreNotMissingIfComplete) {
  AllShards(2);
  const auto missing = MissingShards(out_, 2);
  ASSERT_TRUE(missing);
  EXPECT_THAT(*missing, IsEmpty());
}

TEST_F(ShardsTest, AreNotSearchedInAMissingFolder) {
  const auto missing = MissingShards(folder_ / "nowhere", 2);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, StatusCode::kNotFound);
  EXPECT_THAT(missing.error().message(), StartsWith((folder_ / "nowhere").string() + ": there is no such folder"));
}

/// The error message for a refused merge of two shards.
std::string Refusal(const Result<std::int64_t>& merged) {
  if (merged) return "merged";
  EXPECT_EQ(merged.error().code, StatusCode::kDataLoss) << merged.error().message();
  return merged.error().message();
}

TEST_F(ShardsTest, AreRefusedForAnotherManifest) {
  AllShards(2);
  folder_.Write("runs.csv", folder_.Read("runs.csv") + "0.csv,more\n");
  RefitOne(1, 2, options_);
  EXPECT_THAT(Refusal(Merge(2)), AllOf(HasSubstr("shard-1.sqlite"), HasSubstr("shard of another batch")));
  EXPECT_FALSE(fs::exists(store_));
}

TEST_F(ShardsTest, AreRefusedForOtherOptions) {
  AllShards(2);
  RefitOne(1, 2, OptionsWith({"coulomb"}));
  EXPECT_THAT(Refusal(Merge(2)), HasSubstr("shard of another batch"));
}

TEST_F(ShardsTest, AreRefusedForAnotherVersion) {
  AllShards(2);
  SQLite::Database(ShardPath(out_, 1).string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE meta SET value = '0.0.1' WHERE key = 'version'");
  EXPECT_THAT(Refusal(Merge(2)), HasSubstr("shard of another batch"));
}

TEST_F(ShardsTest, AreRefusedForAnotherNumberOfShards) {
  AllShards(3);
  EXPECT_THAT(Refusal(Merge(2)), AllOf(HasSubstr("shard-0.sqlite"), HasSubstr("0/3")));
  fs::rename(ShardPath(out_, 0), ShardPath(out_, 2));
  EXPECT_THAT(Refusal(MergeShards(out_, 3, store_)),
              AllOf(HasSubstr("shard-2.sqlite"), HasSubstr("the store of shard 0/3, not of shard 2/3")));
}

TEST_F(ShardsTest, AreRefusedIfInvalid) {
  AllShards(2);
  fs::remove(ShardPath(out_, 1));
  RefitInto(ShardPath(out_, 1), folder_ / "runs.csv", options_);
  EXPECT_THAT(Refusal(Merge(2)), AllOf(HasSubstr("shard-1.sqlite"), HasSubstr("a whole batch")));
  folder_.Write("out/shard-1.sqlite", "this is text");
  EXPECT_THAT(Refusal(Merge(2)), HasSubstr("shard-1.sqlite"));
}

TEST_F(ShardsTest, AreNotMergedIntoAFileThatIsNotAStore) {
  AllShards(2);
  folder_.Write("store.sqlite", "this is text");
  EXPECT_THAT(Refusal(Merge(2)), HasSubstr("store.sqlite"));
  EXPECT_EQ(folder_.Read("store.sqlite"), "this is text");
}

TEST_F(ShardsTest, AreNotMergedIntoAStoreThatIsInUse) {
  AllShards(2);
  const auto lock = StoreLock::Take(store_);
  ASSERT_TRUE(lock);
  const auto merged = Merge(2);
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().code, StatusCode::kTryAgain);
  EXPECT_THAT(merged.error().message(), HasSubstr("another process"));
}

}  // namespace
}  // namespace pendulum::shards_test
