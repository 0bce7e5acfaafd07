// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/prune.h"

#include <atomic>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/summary.h"
#include "pendulum/batch/summary_json.h"
#include "tests/batch/refit_folder.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::prune_test {
namespace {

using refit_folder::RefitTest;
using small_batch::OptionsWith;
using store_rows::Rows;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// A store in which c is no longer in the manifest, the recording of b is gone, and a has a fit not asked for.
class PruneTest : public RefitTest {
 protected:
  void SetUp() override {
    small_batch::WriteBatch(folder_, 3);
    RefitAll(OptionsWith({"viscous", "coulomb"}));
    std::filesystem::remove(folder_ / "1.csv");
    folder_.Write("runs.csv", "path,id\n0.csv,a\n1.csv,b\n");
    RefitAll(coulomb_);
  }
};

TEST_F(PruneTest, FindsWhatStatisticsLeaveOut) {
  Store store = Store::Open(store_, Store::Mode::kRead).value();
  const Prunable found = FindPrunable(store).value();
  EXPECT_THAT(found.stale_runs, ElementsAre("b"));
  EXPECT_THAT(found.unlisted_runs, ElementsAre("c"));
  EXPECT_THAT(found.models, ElementsAre(Pair("viscous", 1)));
  const auto summary = Summarize(store, {}).value();
  ASSERT_EQ(summary.overview.laws.size(), 1);
  EXPECT_EQ(summary.overview.laws[0].law, "coulomb");
  EXPECT_EQ(summary.overview.laws[0].fits, 1);
  EXPECT_THAT(summary.overview.recommendations, IsEmpty());
  for (const QuantitySummary& quantity : summary.quantities) {
    EXPECT_EQ(quantity.law, "coulomb");
    EXPECT_EQ(quantity.runs, 1);
  }
}

TEST_F(PruneTest, RemovesOnlyThat) {
  const std::string kept = "SELECT * FROM quantities WHERE model = 'coulomb' AND run = 1";
  const auto before = Rows(store_, kept);
  Store store = Store::Open(store_, Store::Mode::kWrite).value();
  const auto summary = Summarize(store, {}).value();
  ASSERT_TRUE(store.Meta()->complete);
  ASSERT_TRUE(Prune(store));
  const Prunable rest = FindPrunable(store).value();
  EXPECT_THAT(rest.stale_runs, IsEmpty());
  EXPECT_THAT(rest.unlisted_runs, IsEmpty());
  EXPECT_THAT(rest.models, IsEmpty());
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs"), ElementsAre("a"));
  EXPECT_THAT(Rows(store_, "SELECT run, model FROM fits"), ElementsAre("1|coulomb"));
  EXPECT_EQ(Rows(store_, kept), before);
  EXPECT_EQ(ValueOf("SELECT count(*) FROM quantities"), std::to_string(before.size()));
  EXPECT_EQ(ToJson(Summarize(store, {}).value())["parameters"], ToJson(summary)["parameters"]);
  EXPECT_FALSE(store.Meta()->complete);  // b has no rows
}

TEST_F(PruneTest, RefusesWhileTheLastRefitIsNotComplete) {
  const std::atomic<bool> stop = true;
  RefitOptions stopped = OptionsWith({"drag"});
  stopped.stop = &stop;
  RefitAll(stopped);
  Store store = Store::Open(store_, Store::Mode::kWrite).value();
  EXPECT_EQ(FindPrunable(store).error().code, StatusCode::kFailedPrecondition);
  const auto pruned = Prune(store);
  ASSERT_FALSE(pruned);
  EXPECT_EQ(pruned.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(pruned.error().message(), testing::HasSubstr("Finish the refit first: run refit_pendulums"));
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs ORDER BY id"), ElementsAre("a", "b", "c"));
}

}  // namespace
}  // namespace pendulum::prune_test
