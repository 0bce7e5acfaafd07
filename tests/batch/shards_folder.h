// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/batch/shards.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::shards_folder {

/// A folder with a batch that has one missing file, and a folder for its shards.
class ShardsTest : public testing::Test {
 protected:
  void SetUp() override {
    small_batch::WriteBatch(folder_, kRuns);
    folder_.Write("runs.csv", folder_.Read("runs.csv") + "nowhere.csv,z\n");
    std::filesystem::create_directory(out_);
  }

  ShardOptions At(std::int64_t index, const std::string& attempt = "1") const {
    return {ShardPath(out_, index), {}, attempt, 60};
  }

  Result<RefitCounts> TryShard(const ShardOptions& at, Shard shard, RefitOptions options) const {
    const auto source = OpenSource(folder_ / "runs.csv");
    if (!source) return tl::unexpected(source.error());
    options.shard = shard;
    return RefitShard(*source, at, options);
  }

  /// Refits shard `index` of `count`; fails the test on an error.
  RefitCounts RefitOne(std::int64_t index, std::int64_t count, const RefitOptions& options) const {
    const auto counts = TryShard(At(index), {index, count}, options);
    if (counts) return *counts;
    ADD_FAILURE() << counts.error().message();
    return {};
  }

  void AllShards(std::int64_t count) const {
    for (std::int64_t k = 0; k < count; ++k) RefitOne(k, count, options_);
  }

  Result<std::int64_t> Merge(std::int64_t count) const { return MergeShards(out_, count, store_); }

  /// Options that stop after `runs` runs.
  RefitOptions StoppingAfter(std::int64_t runs, std::atomic<bool>& stop) const {
    stop = false;
    RefitOptions options = options_;
    options.stop = &stop;
    options.progress = [&stop, runs](const RefitCounts& counts) { stop = counts.refitted >= runs; };
    return options;
  }

  /// The rows of a refit without shards.
  std::vector<std::string> RowsAtOnce() const {
    const std::filesystem::path whole = folder_ / "whole.sqlite";
    std::filesystem::remove(whole);
    small_batch::RefitInto(whole, folder_ / "runs.csv", options_);
    return store_rows::AllRows(whole);
  }

  std::vector<std::string> NamesInOut() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out_))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  /// Creates the file and the journal that a process leaves when it is killed while writing to a copy of a store.
  void LeaveAsKilled(const std::filesystem::path& store, const std::filesystem::path& file) const {
    const std::string dying = folder_ / "dying.sqlite";
    std::filesystem::copy(store, dying);
    SQLite::Database database(dying, SQLite::OPEN_READWRITE);
    database.exec("PRAGMA synchronous = OFF; PRAGMA cache_size = 5; DELETE FROM quantities; DELETE FROM fits");
    database.exec("UPDATE runs SET result = NULL; VACUUM; BEGIN IMMEDIATE");
    database.exec("UPDATE runs SET result = 'half'; DELETE FROM options; DELETE FROM meta");
    std::filesystem::copy(dying, file);
    std::filesystem::copy(dying + "-journal", file.string() + "-journal");
    database.exec("ROLLBACK");
  }

  static constexpr int kRuns = 6;  // and one missing file

  small_batch::Folder folder_{"shards_test"};
  const std::filesystem::path out_ = folder_ / "out";
  const std::filesystem::path store_ = folder_ / "store.sqlite";
  const RefitOptions options_ = small_batch::OptionsWith({"viscous"});
};

}  // namespace pendulum::shards_folder
