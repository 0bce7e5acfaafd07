// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "pendulum/batch/shards.h"
#include "pendulum/batch/store_lock.h"
#include "tests/batch/shards_folder.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::shards_attempts_test {
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

/// Attributes that are equal as long as a file is not replaced.
std::vector<std::int64_t> IdentityOf(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {static_cast<std::int64_t>(status.st_ino), status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

// ---- Attempts ------------------------------------------------------------------------------------------------------

TEST_F(ShardsTest, ResumeFromTheCheckpointOfAStoppedAttempt) {
  std::atomic<bool> stop = false;
  const RefitCounts first = RefitOne(0, 1, StoppingAfter(3, stop));
  EXPECT_TRUE(first.stopped);
  EXPECT_EQ(first.refitted, 3);
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite.part"));
  const auto second = TryShard(At(0, "2"), {0, 1}, options_);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->current, 3);
  EXPECT_EQ(second->refitted, kRuns + 1 - 3);
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite"));
  EXPECT_EQ(AllRows(ShardPath(out_, 0)), RowsAtOnce());
}

// The earlier store is complete, but all its rows are outdated.
TEST_F(ShardsTest, ResumeFromTheCheckpointDespiteAnotherStore) {
  RefitOne(0, 1, OptionsWith({"drag"}));
  std::atomic<bool> stop = false;
  RefitOne(0, 1, StoppingAfter(3, stop));
  const RefitCounts second = RefitOne(0, 1, options_);
  EXPECT_EQ(second.current, 3);
  EXPECT_EQ(second.refitted, kRuns + 1 - 3);
  EXPECT_EQ(AllRows(ShardPath(out_, 0)), RowsAtOnce());
}

TEST_F(ShardsTest, KeepTheOldStoreUntilTheNewOneIsComplete) {
  RefitOne(0, 1, OptionsWith({"drag"}));
  const auto before = IdentityOf(ShardPath(out_, 0));
  std::atomic<bool> stop = false;
  EXPECT_TRUE(RefitOne(0, 1, StoppingAfter(3, stop)).stopped);
  EXPECT_EQ(IdentityOf(ShardPath(out_, 0)), before);
}

TEST_F(ShardsTest, RestartFromADamagedCheckpoint) {
  folder_.Write("out/shard-0.sqlite.part", "this is no store");
  EXPECT_EQ(RefitOne(0, 1, options_).refitted, kRuns + 1);
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite"));
}

/// Overwrites the last quarter of a store, which Open does not read.
void Damage(const fs::path& store) {
  constexpr std::size_t kPage = 4096;
  const std::size_t end = 3 * fs::file_size(store) / kPage / 4 * kPage;
  std::fstream file(store, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(end));
  file << std::string(fs::file_size(store) - end, '\x5a');
}

TEST_F(ShardsTest, RestartFromACheckpointDamagedAfterItsFirstPages) {
  std::atomic<bool> stop = false;
  RefitOne(0, 1, StoppingAfter(3, stop));
  Damage(out_ / "shard-0.sqlite.part");
  EXPECT_EQ(RefitOne(0, 1, options_).refitted, kRuns + 1);
  EXPECT_EQ(AllRows(ShardPath(out_, 0)), RowsAtOnce());
}

TEST_F(ShardsTest, AreMissingAndRefittedIfDamaged) {
  AllShards(2);
  Damage(ShardPath(out_, 1));
  EXPECT_THAT(MissingShards(out_, 2).value(), ElementsAre(1));
  RefitOne(1, 2, options_);
  ASSERT_TRUE(Merge(2));
  EXPECT_EQ(AllRows(store_), RowsAtOnce());
}

TEST_F(ShardsTest, AreNotRewrittenIfComplete) {
  AllShards(2);
  const auto before = IdentityOf(ShardPath(out_, 1));
  const RefitCounts again = RefitOne(1, 2, options_);
  EXPECT_EQ(again.refitted, 0);
  EXPECT_GT(again.current, 0);
  EXPECT_EQ(IdentityOf(ShardPath(out_, 1)), before);
  folder_.Write("5.csv", RecordingText(77));
  EXPECT_EQ(RefitOne(1, 2, options_).refitted, 1);
  EXPECT_NE(IdentityOf(ShardPath(out_, 1)), before);
}

TEST_F(ShardsTest, KeepNoRunsOfAnotherShard) {
  RefitOne(0, 2, options_);
  fs::rename(ShardPath(out_, 0), ShardPath(out_, 1));
  AllShards(2);
  const auto merged = Merge(2);
  ASSERT_TRUE(merged) << merged.error().message();
  EXPECT_EQ(*merged, kRuns + 1);
  EXPECT_EQ(AllRows(store_), RowsAtOnce());
}

// A user may give --store results.sqlite instead of out/shard-0.sqlite by mistake. Days of work must not be lost.
TEST_F(ShardsTest, DoNotReplaceTheStoreOfAWholeBatch) {
  RefitInto(store_, folder_ / "runs.csv", options_);
  const std::vector<std::string> rows = AllRows(store_);
  ShardOptions at = At(0);
  at.store = store_;
  EXPECT_FALSE(TryShard(at, {0, 2}, options_));
  EXPECT_EQ(AllRows(store_), rows);
}

TEST_F(ShardsTest, AreTheSameForTwoConcurrentAttempts) {
  const std::vector<std::string> at_once = RowsAtOnce();
  std::vector<Result<RefitCounts>> counts(2);
  {
    std::vector<std::jthread> attempts;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      attempts.emplace_back([&, k] { counts[k] = TryShard(At(0, std::to_string(k)), {0, 1}, options_); });
    }
  }
  for (const auto& count : counts) {
    ASSERT_TRUE(count) << count.error().message();
    EXPECT_EQ(count->done(), kRuns + 1);
  }
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite"));
  EXPECT_EQ(AllRows(ShardPath(out_, 0)), at_once);
}

TEST_F(ShardsTest, AreTheSameIfOneOfTwoAttemptsIsStopped) {
  const std::vector<std::string> at_once = RowsAtOnce();
  std::atomic<bool> stop = false;
  const RefitOptions stopping = StoppingAfter(2, stop);
  {
    const std::jthread other([&] { EXPECT_TRUE(TryShard(At(0, "stopped"), {0, 1}, stopping)); });
    EXPECT_TRUE(TryShard(At(0, "whole"), {0, 1}, options_));
  }
  EXPECT_TRUE(TryShard(At(0, "last"), {0, 1}, options_));
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite"));
  EXPECT_EQ(AllRows(ShardPath(out_, 0)), at_once);
}

// Commits are a second apart, so with an interval of 0.1 s each commit is followed by a checkpoint.
TEST_F(ShardsTest, PublishCheckpointsWhileWorking) {
  auto source = OpenSource(folder_ / "runs.csv");
  ASSERT_TRUE(source);
  const auto read = source->read;
  bool has_checkpoint = false;
  source->read = [&](const std::string& path) {
    if (path == "nowhere.csv") has_checkpoint = fs::exists(out_ / "shard-0.sqlite.part");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return read(path);
  };
  ShardOptions at = At(0);
  at.checkpoint = 0.1;
  RefitOptions options = options_;
  options.shard = Shard{0, 1};
  ASSERT_TRUE(RefitShard(*source, at, options));
  EXPECT_TRUE(has_checkpoint);
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite"));
}

TEST_F(ShardsTest, AreWrittenInTheScratchFolder) {
  const fs::path scratch = folder_ / "scratch";
  fs::create_directory(scratch);
  ShardOptions at = At(0);
  at.scratch = scratch;
  bool is_in_scratch = false;
  RefitOptions options = options_;
  options.progress = [&](const RefitCounts&) { is_in_scratch = fs::exists(scratch / "shard-0.sqlite.attempt-1"); };
  ASSERT_TRUE(TryShard(at, {0, 1}, options));
  EXPECT_TRUE(is_in_scratch);
  EXPECT_TRUE(fs::is_empty(scratch));
  EXPECT_THAT(NamesInOut(), ElementsAre("shard-0.sqlite"));
}

// A killed attempt left its file and journal, and a new attempt has the same name, as in containers where every process
// has the same number.
TEST_F(ShardsTest, AreTheSameAfterAKilledAttempt) {
  RefitOne(0, 1, options_);
  LeaveAsKilled(ShardPath(out_, 0), out_ / "shard-0.sqlite.attempt-1");
  folder_.Write("0.csv", RecordingText(50));
  EXPECT_EQ(RefitOne(0, 1, options_).refitted, 1);
  EXPECT_EQ(Value(ShardPath(out_, 0), "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(AllRows(ShardPath(out_, 0)), RowsAtOnce());
}

TEST_F(ShardsTest, ReportAnUnwritableFolder) {
  ShardOptions at = At(0);
  at.store = folder_ / "nowhere" / "shard-0.sqlite";
  const auto counts = TryShard(at, {0, 1}, options_);
  ASSERT_FALSE(counts);
  EXPECT_EQ(counts.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(counts.error().message(), AllOf(StartsWith("cannot write "), HasSubstr("nowhere/shard-0.sqlite")));
}

}  // namespace
}  // namespace pendulum::shards_attempts_test
