// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/store.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pendulum/base/file.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/version.h"
#include "tests/batch/example_runs.h"

namespace pendulum::store_test {
namespace {

namespace fs = std::filesystem;

using example_runs::RefittedOutcome;
using example_runs::SourceOf;
using example_runs::SourceOfIds;
using example_runs::StoreOf;
using example_runs::UnfittedOutcome;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;
using testing::StartsWith;

// ---- Shard ---------------------------------------------------------------------------------------------------------

TEST(Shard, CutsABatchIntoPartsThatDifferByOneAtMost) {
  for (const std::int64_t runs : {0, 1, 2, 3, 7, 100, 101, 12345}) {
    for (const std::int64_t count : {1, 2, 3, 7, 64, 100, 20000}) {
      std::int64_t end = 0;
      for (std::int64_t k = 0; k < count; ++k) {
        const Shard shard{k, count};
        ASSERT_EQ(shard.Begin(runs), end) << runs << " runs, shard " << k << " of " << count;
        end = shard.End(runs);
        ASSERT_GE(end - shard.Begin(runs), runs / count);
        ASSERT_LE(end - shard.Begin(runs), (runs + count - 1) / count);
      }
      ASSERT_EQ(end, runs);
    }
  }
}

// Expected values from Python's unlimited integers.
TEST(Shard, IsExactIfTheProductOverflows) {
  constexpr std::int64_t kRuns = 9000000000000000001, kCount = 999999999;
  EXPECT_EQ((Shard{0, kCount}.Begin(kRuns)), 0);
  EXPECT_EQ((Shard{1, kCount}.Begin(kRuns)), 9000000009);
  EXPECT_EQ((Shard{123456789, kCount}.Begin(kRuns)), 1111111102111111102);
  EXPECT_EQ((Shard{kCount - 1, kCount}.Begin(kRuns)), 8999999990999999991);
  EXPECT_EQ((Shard{kCount - 1, kCount}.End(kRuns)), kRuns);
}

// ---- Store ---------------------------------------------------------------------------------------------------------

class StoreTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Store Make(const std::vector<std::string>& ids) const { return StoreOf(path_, SourceOfIds(ids)); }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("store_test_" + std::to_string(getpid()));
  const std::string path_ = folder_ / "results.sqlite";
};

std::vector<std::string> TextsOf(Store& store, const std::string& query) {
  SQLite::Statement rows(store.database(), query);
  std::vector<std::string> texts;
  while (rows.executeStep()) texts.push_back(rows.getColumn(0).getString());
  return texts;
}

std::int64_t NumberOf(Store& store, const std::string& query) { return store.database().execAndGet(query).getInt64(); }

TEST_F(StoreTest, HasTheTablesOfItsSchema) {
  Store store = Make({"a"});
  EXPECT_EQ(NumberOf(store, "PRAGMA user_version"), 9);
  EXPECT_EQ(NumberOf(store, "PRAGMA application_id"), 0x50656e64);  // "Pend"
  EXPECT_THAT(TextsOf(store, "SELECT name FROM sqlite_schema WHERE sql LIKE '%--%' ORDER BY name"),
              ElementsAre("all_fits", "answers", "batches", "files", "fits", "meta", "options", "quantities",
                          "requests", "results", "runs"));
  EXPECT_THAT(TextsOf(store, "PRAGMA integrity_check"), ElementsAre("ok"));
}

TEST_F(StoreTest, StoresTheManifestsData) {
  ManifestEntry entry;
  entry.id = "a";
  entry.path = "runs/a.csv";
  entry.rig = "rig.json";
  entry.calibration = "cal.json";
  entry.from = -0.5;
  entry.models = "all";
  entry.columns = R"({"Öl":"1"})";
  Store store = StoreOf(path_, SourceOf({entry}));
  const auto runs = store.Next(0, 10).value();
  ASSERT_EQ(runs.size(), 1);
  const ManifestEntry& stored = runs[0].entry;
  EXPECT_EQ(stored.id + stored.path + stored.rig + stored.calibration, "aruns/a.csvrig.jsoncal.json");
  EXPECT_THAT(stored.from, Optional(-0.5));
  EXPECT_FALSE(stored.to);
  EXPECT_EQ(stored.models, "all");
  EXPECT_EQ(stored.columns, R"({"Öl":"1"})");
  EXPECT_EQ(stored.place, "");
  EXPECT_FALSE(runs[0].exit_code);
}

TEST_F(StoreTest, ListsTheRunsOfTheBatchInPages) {
  Store store = Make({"c", "a", "b"});
  const auto page = store.Next(0, 2).value(), rest = store.Next(2, 2).value();
  ASSERT_EQ(page.size(), 2);
  EXPECT_EQ(page[0].entry.id + page[1].entry.id, "ca");
  ASSERT_EQ(rest.size(), 1);
  EXPECT_EQ(rest[0].entry.id, "b");
  EXPECT_THAT(store.Next(3, 2).value(), IsEmpty());
}

TEST_F(StoreTest, UsesOnlyTheRunsOfItsShard) {
  const Source source = SourceOfIds({"a", "b", "c", "d", "e"});
  Store store = Store::Open(path_, Store::Mode::kWrite).value();
  const StoreMeta meta = store.Begin(source, Shard{1, 2}, "{}").value();
  EXPECT_EQ(meta.runs, 5);
  EXPECT_THAT(TextsOf(store, "SELECT id FROM runs ORDER BY position"), ElementsAre("c", "d", "e"));  // [5/2, 5)
  EXPECT_EQ(store.Next(0, 10).value().size(), 3);
  ASSERT_TRUE(store.Put("c", RefittedOutcome()) && store.Commit());
  ASSERT_TRUE(store.Begin(source, Shard{0, 2}, "{}"));  // the store of one shard may become the store of another
  EXPECT_THAT(TextsOf(store, "SELECT id FROM runs ORDER BY position"), ElementsAre("a", "b"));
  EXPECT_EQ(NumberOf(store, "SELECT count(*) FROM fits") + NumberOf(store, "SELECT count(*) FROM quantities"), 0);
  EXPECT_EQ(store.Meta()->shard->index, 0);
  EXPECT_EQ(store.Meta()->shard->count, 2);
}

TEST_F(StoreTest, ReplacesEntriesWithTheSameIdAndKeepsOthers) {
  {
    Store store = Make({"a", "b"});
    ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", RefittedOutcome()) && store.Commit());
  }
  ManifestEntry entry;
  entry.id = "b";
  entry.path = "b.csv";
  entry.columns = R"({"rig_no":"7"})";
  ManifestEntry added;
  added.id = "c";
  added.path = "c.csv";
  Store store = StoreOf(path_, SourceOf({entry, added}));
  EXPECT_THAT(TextsOf(store, "SELECT id || ' ' || position || ' ' || columns FROM runs ORDER BY id"),
              ElementsAre("a -1 {}", R"(b 0 {"rig_no":"7"})", "c 1 {}"));
  const auto runs = store.Next(0, 10).value();  // only runs of the batch
  ASSERT_EQ(runs.size(), 2);
  EXPECT_THAT(runs[0].exit_code, Optional(0));
  EXPECT_FALSE(runs[1].exit_code);
  EXPECT_TRUE(runs[0].provenance.Agrees(RefittedOutcome().provenance));
  EXPECT_EQ(NumberOf(store, "SELECT count(*) FROM fits"), 4);
}

TEST_F(StoreTest, RefusesARepeatedIdWithoutAChange) {
  Store store = Make({"x"});
  const auto before = TextsOf(store, "SELECT key || value FROM meta");
  const auto begun = store.Begin(SourceOfIds({"a", "b", "a"}), std::nullopt, R"({"other":1})");
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(begun.error().message(), "runs.csv:4: the id \"a\" is also at runs.csv:2; give each run its own id");
  EXPECT_THAT(TextsOf(store, "SELECT id FROM runs"), ElementsAre("x"));
  EXPECT_EQ(TextsOf(store, "SELECT key || value FROM meta"), before);
  EXPECT_EQ(NumberOf(store, "SELECT count(*) FROM options"), 1);
  EXPECT_EQ(store.Next(0, 10).value().size(), 1);
}

TEST_F(StoreTest, RefusesAnEmptyBatch) {
  Store store = Store::Open(path_, Store::Mode::kWrite).value();
  const auto begun = store.Begin(SourceOf({}), std::nullopt, "{}");
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(begun.error().message(), "runs.csv: it names no recording; give one per row");
}

TEST_F(StoreTest, ReturnsTheErrorOfTheSource) {
  Store store = Make({"x"});
  Source source = SourceOfIds({"a"});
  source.for_each = [](const EntrySink&) -> Result<void> { return Error(StatusCode::kNotFound, "gone"); };
  const auto begun = store.Begin(source, std::nullopt, "{}");
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().code, StatusCode::kNotFound);
  EXPECT_EQ(begun.error().message(), "gone");
}

// ---- Rows ----------------------------------------------------------------------------------------------------------

TEST_F(StoreTest, StoresARowForEachQuantity) {
  Store store = Make({"a"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  std::int64_t quantities = 0;
  const auto& result = RefittedOutcome().result;
  std::vector<nlohmann::ordered_json> parts = result["fits"];
  std::ranges::copy(result["recordings"][0]["fits"], std::back_inserter(parts));
  for (auto& fit : parts) {
    for (const char* kind : {"parameters", "derived"}) {
      for (const auto& [name, value] : fit[kind].items()) {
        SQLite::Statement row(store.database(),
                              "SELECT estimate, std_error, lower95, unit, derived FROM quantities WHERE model = ? AND "
                              "name = ?");
        row.bind(1, fit["model"].get<std::string>());
        row.bind(2, name);
        ASSERT_TRUE(row.executeStep()) << name;
        EXPECT_EQ(row.getColumn(0).getDouble(), value["estimate"].get<double>()) << name;
        EXPECT_EQ(row.getColumn(1).isNull(), value["std_error"].is_null()) << name;
        if (value["std_error"].is_number()) {
          EXPECT_EQ(row.getColumn(1).getDouble(), value["std_error"].get<double>()) << name;
        }
        if (value["interval95"].is_array() && value["interval95"][0].is_number()) {
          EXPECT_EQ(row.getColumn(2).getDouble(), value["interval95"][0].get<double>()) << name;
        }
        EXPECT_EQ(row.getColumn(3).getString(), value["unit"].get<std::string>()) << name;
        EXPECT_EQ(row.getColumn(4).getInt() == 1, std::string(kind) == "derived") << name;
        ++quantities;
      }
    }
  }
  EXPECT_GT(quantities, 10);
  EXPECT_EQ(NumberOf(store, "SELECT count(*) FROM quantities"), quantities);
}

TEST_F(StoreTest, StoresEachFitAndTheResult) {
  Store store = Make({"a"});
  const RunOutcome& outcome = RefittedOutcome();
  ASSERT_TRUE(store.Put("a", outcome));
  const auto& fit = outcome.result["fits"][1];
  const auto& recording = outcome.result["recordings"][0];
  const auto& own = recording["fits"][1];
  SQLite::Statement row(store.database(),
                        "SELECT status, residual_unit, rms_residual, sigma, aicc, used_samples, evaluations, "
                        "recommended FROM all_fits WHERE model = 'coulomb'");
  ASSERT_TRUE(row.executeStep());
  EXPECT_EQ(fit["status"], row.getColumn(0).getString());
  EXPECT_EQ(row.getColumn(1).getString(), "rad");
  EXPECT_EQ(row.getColumn(2).getDouble(), own["statistics"]["rms_residual_rad"].get<double>());
  EXPECT_EQ(row.getColumn(3).getDouble(), own["noise"]["sigma_rad"].get<double>());
  EXPECT_EQ(row.getColumn(4).getDouble(), own["statistics"]["aicc"].get<double>());
  EXPECT_EQ(row.getColumn(5).getInt64(), recording["used_samples"].get<std::int64_t>());
  EXPECT_EQ(row.getColumn(6).getInt64(), fit["solver"]["evaluations"].get<std::int64_t>());
  EXPECT_EQ(row.getColumn(7).getInt() == 1, outcome.result["comparison"]["recommended"] == "coulomb");
  EXPECT_THAT(TextsOf(store, "SELECT result FROM runs"), ElementsAre(outcome.result.dump()));
}

TEST_F(StoreTest, ReplacesAllRowsOfARun) {
  Store store = Make({"a", "b"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", RefittedOutcome()));
  RunOutcome unfitted = UnfittedOutcome();
  unfitted.models = {"drag"};
  ASSERT_TRUE(store.Put("a", unfitted) && store.Commit());
  EXPECT_THAT(
      TextsOf(store, "SELECT model || ' ' || status || ' ' || reason FROM all_fits WHERE id = 'a' AND stale IS NULL"),
      ElementsAre("drag failed " + unfitted.reason.text()));
  EXPECT_EQ(NumberOf(store, "SELECT count(*) FROM quantities WHERE model = 'drag'"), 0);
  EXPECT_EQ(NumberOf(store, "SELECT count(*) FROM runs WHERE id = 'a' AND result IS NULL AND exit_code = 3"), 1);
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Commit());
  EXPECT_EQ(NumberOf(store, "SELECT count(DISTINCT result) FROM runs WHERE reason IS NULL"), 1);
  EXPECT_THAT(TextsOf(store, "SELECT model FROM all_fits WHERE id = 'a' ORDER BY model"),
              ElementsAre("coulomb", "viscous"));
  EXPECT_EQ(2 * NumberOf(store, "SELECT count(*) FROM quantities JOIN runs USING(run) WHERE id = 'a'"),
            NumberOf(store, "SELECT count(*) FROM quantities"));
}

TEST_F(StoreTest, CountsItsRunsAndFits) {
  Store store = Make({"a", "b", "c", "d"});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", UnfittedOutcome()));
  const StoreCounts counts = store.Count().value();
  EXPECT_EQ(counts.runs, 4);
  EXPECT_EQ(counts.pending, 2);
  EXPECT_EQ(counts.unfitted, 1);
  EXPECT_EQ(counts.fits, 4);
  EXPECT_EQ(counts.failed, 2);
}

TEST_F(StoreTest, StoresTheMetaDataOfItsBatch) {
  const std::string options = R"({"models":["coulomb"]})";
  Store store = Store::Open(path_, Store::Mode::kWrite).value();
  const StoreMeta begun = store.Begin(SourceOfIds({"a"}), std::nullopt, options).value();
  const StoreMeta meta = store.Meta().value();
  EXPECT_EQ(meta.version, kVersion);
  EXPECT_EQ(meta.options_sha256, Sha256(options).value());
  EXPECT_EQ(meta.manifest_sha256, begun.manifest_sha256);
  EXPECT_EQ(meta.manifest_sha256.size(), 64);
  EXPECT_FALSE(meta.shard);
  EXPECT_EQ(meta.runs, 1);
  EXPECT_FALSE(meta.complete);
  EXPECT_THAT(TextsOf(store, "SELECT json FROM options"), ElementsAre(options));
  ASSERT_TRUE(store.Complete());
  EXPECT_TRUE(Store::Open(path_, Store::Mode::kRead)->Meta()->complete);
  EXPECT_NE(store.Begin(SourceOfIds({"b"}), std::nullopt, options)->manifest_sha256, meta.manifest_sha256);
  EXPECT_FALSE(store.Meta()->complete);
  EXPECT_EQ(store.Begin(SourceOfIds({"a"}), Shard{0, 1}, options)->manifest_sha256, meta.manifest_sha256);
}

// The reason of a failure names the file, so it is not valid for a file with another name.
TEST_F(StoreTest, UpdatesAFailureIfThePathChanged) {
  RefitOptions options;
  options.run.models = {"coulomb"};
  Store store = Store::Open(path_, Store::Mode::kWrite).value();
  for (const std::string file : {"one.csv", "two.csv"}) {
    ManifestEntry entry;
    entry.id = "a";
    entry.path = file;
    ASSERT_TRUE(Refit(SourceOf({entry}), store, options));
    EXPECT_THAT(TextsOf(store, "SELECT reason FROM runs"), ElementsAre(HasSubstr(file)));
  }
}

// The stored result names the recording's file. If the file is not a recording, the stored reason names it.
TEST_F(StoreTest, GivesPathsInResultsAsTheManifestDoes) {
  RefitOptions options;
  options.run.models = {"coulomb"};
  Store store = Store::Open(path_, Store::Mode::kWrite).value();
  for (const std::string file : {"one.csv", "two.csv"}) {
    ManifestEntry good;
    good.id = "good";
    good.path = file;
    ManifestEntry bad;
    bad.id = "bad";
    bad.path = "bad_" + file;
    Source source = SourceOf({good, bad});
    source.read = [](const std::string& path) {
      return path.starts_with("bad") ? Result<std::string>("time_s\n")
                                     : ReadFile("datasets/runs_1.csv", "CSV", 1 << 20);
    };
    ASSERT_TRUE(Refit(source, store, options));
    EXPECT_THAT(TextsOf(store, "SELECT json_extract(result, '$.recordings[0].path') FROM runs WHERE id = 'good'"),
                ElementsAre(file));
    EXPECT_THAT(TextsOf(store, "SELECT reason FROM runs WHERE id = 'bad'"), ElementsAre(StartsWith("bad_" + file)));
  }
}

TEST_F(StoreTest, RefusesAnOutcomeOfAnUnknownRun) {
  Store store = Make({"a"});
  const auto put = store.Put("z", RefittedOutcome());
  ASSERT_FALSE(put);
  EXPECT_EQ(put.error().code, StatusCode::kInternal);
  EXPECT_EQ(put.error().message(), "no run z");
}

}  // namespace
}  // namespace pendulum::store_test
