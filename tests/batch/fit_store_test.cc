// SPDX-License-Identifier: Apache-2.0
// Tests of FitStore: adding, finding, listing and deleting runs; batches; answers to repeated requests.
#include "pendulum/batch/fit_store.h"

#include <array>
#include <ctime>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/batch/fit_orders.h"
#include "tests/batch/made_outcomes.h"

namespace pendulum::fit_store_test {
namespace {

using fit_orders::IdsOf;
using fit_orders::kCreated;
using fit_orders::OrderOf;
using fit_orders::OrdersOf;
using made_outcomes::FailureOf;
using made_outcomes::FitOf;
using made_outcomes::OutcomeOf;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

class FitStoreTest : public fit_orders::FitStoreFolder {
 protected:
  void Add(const FitOrder& order, const RunOutcome& outcome = OutcomeOf({FitOf("viscous", 2)})) {
    const auto added = Store().Add(order, outcome, std::nullopt);
    ASSERT_TRUE(added) << added.error().message();
  }

  void Add(const std::string& id) { Add(OrderOf(id)); }

  void AddBatch(const std::string& id, const std::vector<std::string>& runs) {
    const auto added = Store().AddBatch(id, kCreated, OrdersOf(runs), std::nullopt);
    ASSERT_TRUE(added) << added.error().message();
  }

  std::vector<std::string> Listed(const FitFilter& filter) {
    const auto fits = Store().List(filter);
    EXPECT_TRUE(fits) << fits.error().message();
    return fits ? IdsOf(*fits) : std::vector<std::string>();
  }

  std::vector<std::string> Waiting() {
    std::vector<std::string> ids;
    const auto waiting = Store().WaitingRuns();
    for (const FitStore::Waiting& run : waiting.value()) ids.push_back(run.batch + "/" + run.id);
    return ids;
  }

  std::vector<std::string> Batches(int limit, const std::optional<std::int64_t>& before = std::nullopt) {
    std::vector<std::string> ids;
    const auto batches = Store().ListBatches(limit, before);
    for (const ListedBatch& batch : batches.value()) ids.push_back(batch.id);
    return ids;
  }
};

/// Checks that a call reports an unknown id.
template <typename T>
void ExpectUnknown(const Result<T>& result, const std::string& what) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, StatusCode::kNotFound);
  EXPECT_EQ(result.error().message(), "there is no " + what + "; it may have been deleted");
}

// ---- One run -------------------------------------------------------------------------------------------------------

TEST_F(FitStoreTest, KeepsARunWithAllItsInputs) {
  FitOrder order = OrderOf("a");
  order.flags = R"({"model":"drag","name":"ünïcode"})";
  order.files.data = {"swing, the first.csv", std::string("a\0b\r\n\xFF", 6)};
  order.files.rig = Share({"rig.json", R"({"gravity_torque": {"value": 1.8}})"});
  order.files.calibration = Share({"calibration", ""});
  const RunOutcome outcome = OutcomeOf({FitOf("drag", 1.0 / 3), FitOf("viscous", 7)}, "drag");
  Add(order, outcome);
  const auto kept = Store().Find("a");
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_EQ(kept->fit.id, "a");
  EXPECT_EQ(kept->fit.file, "swing, the first.csv");
  EXPECT_EQ(kept->fit.ShownName(), "swing, the first.csv");
  EXPECT_EQ(kept->fit.created, kCreated);
  EXPECT_EQ(kept->fit.exit_code, 0);
  EXPECT_EQ(kept->fit.reason, "");
  EXPECT_EQ(kept->fit.recommended, "drag");
  EXPECT_EQ(kept->fit.batch, std::nullopt);
  EXPECT_EQ(kept->order.flags, order.flags);
  EXPECT_EQ(kept->order.files.data.name, order.files.data.name);
  EXPECT_EQ(kept->order.files.data.bytes, order.files.data.bytes);
  ASSERT_TRUE(kept->order.files.rig && kept->order.files.calibration);
  EXPECT_EQ(kept->order.files.rig->name, "rig.json");
  EXPECT_EQ(kept->order.files.rig->bytes, order.files.rig->bytes);
  EXPECT_EQ(kept->order.files.calibration->bytes, "");
  EXPECT_EQ(kept->result.dump(), outcome.result.dump());  // bit for bit, with the keys in their order
}

TEST_F(FitStoreTest, StoresNoFileThatWasNotSent) {
  Add("a");
  const auto kept = Store().Find("a");
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_FALSE(kept->order.files.rig);
  EXPECT_FALSE(kept->order.files.calibration);
}

TEST_F(FitStoreTest, ReportsUnknownIds) {
  Add("a");
  EXPECT_TRUE(Store().CheckFit("a"));
  ExpectUnknown(Store().CheckFit("b"), "fit b");
  ExpectUnknown(Store().Find("b"), "fit b");
  ExpectUnknown(Store().Find("%"), "fit %");
  ExpectUnknown(Store().Put("b", OutcomeOf({})), "fit b");
  ExpectUnknown(Store().DeleteFit("b"), "fit b");
  ExpectUnknown(Store().FindBatch("a"), "batch a");
  ExpectUnknown(Store().DeleteBatch("a"), "batch a");
  EXPECT_THAT(Store().RunsOf("a").value(), IsEmpty());
}

TEST_F(FitStoreTest, AcceptsAnIdOnlyOnce) {
  Add("a");
  const auto again = Store().Add(OrderOf("a"), OutcomeOf({}), std::nullopt);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, StatusCode::kInternal);
  EXPECT_THAT(again.error().message(), StartsWith(path_ + ": "));
  Add("b");  // the refused run does not block others
  EXPECT_THAT(Listed({}), ElementsAre("b", "a"));
}

// ---- Lists ---------------------------------------------------------------------------------------------------------

TEST_F(FitStoreTest, ListsTheLatestFirstWithTheirModels) {
  Add(OrderOf("a"), OutcomeOf({FitOf("coulomb", 0.5), FitOf("drag", 2, "not_converged")}, "coulomb"));
  Add("b");
  const auto fits = Store().List({});
  ASSERT_TRUE(fits) << fits.error().message();
  ASSERT_THAT(IdsOf(*fits), ElementsAre("b", "a"));
  const ListedFit& fit = fits->back();
  EXPECT_EQ(fit.name, "");
  EXPECT_EQ(fit.file, "a.csv");
  EXPECT_EQ(fit.recommended, "coulomb");
  ASSERT_THAT(fit.models, SizeIs(2));
  EXPECT_EQ(fit.models[0].model, "coulomb");
  EXPECT_EQ(fit.models[0].status, "converged");
  EXPECT_EQ(fit.models[0].rms_residual, 0.001);
  EXPECT_EQ(fit.models[0].residual_unit, "rad");
  EXPECT_EQ(fit.models[1].status, "not_converged");
  EXPECT_EQ(fit.models[1].reason, "after 100 iterations");
  ASSERT_THAT(fit.models[0].parameters, SizeIs(3));  // inertia, release_angle, and viscous, which is fixed
  EXPECT_EQ(fit.models[0].parameters[0].name, "inertia");
  EXPECT_EQ(fit.models[0].parameters[0].estimate, 0.5);
  EXPECT_EQ(fit.models[0].parameters[0].std_error, 1.0);
  EXPECT_EQ(fit.models[0].parameters[0].unit, "kg m^2");
  EXPECT_EQ(fit.models[0].parameters[2].std_error, std::nullopt);
  EXPECT_EQ(fit.models[0].parameters[2].total_std_error, std::nullopt);
}

TEST_F(FitStoreTest, ListsTheWindowAndTheTotalError) {
  RunOutcome outcome = OutcomeOf({FitOf("coulomb", 0.5)});
  outcome.result["recordings"][0]["window_s"] = {1.25, 46.5};
  Add(OrderOf("a"), outcome);
  Add("without a window");
  SQLite::Database(path_, SQLite::OPEN_READWRITE)
      .exec("UPDATE quantities SET std_error = 0.3, systematic_std_error = 0.4 WHERE name = 'inertia'");
  const auto fits = Store().List({});
  ASSERT_TRUE(fits) << fits.error().message();
  EXPECT_EQ(fits->at(1).window, (std::array{1.25, 46.5}));
  EXPECT_EQ(fits->at(0).window, std::nullopt);
  EXPECT_DOUBLE_EQ(fits->at(1).models.at(0).parameters.at(0).total_std_error.value(), 0.5);  // 3, 4, 5
}

// ---- Names ---------------------------------------------------------------------------------------------------------

TEST_F(FitStoreTest, KeepsTheNameOfARunBesideThatOfItsFile) {
  FitOrder order = OrderOf("a");
  order.name = "Heavy böb";
  Add(order, OutcomeOf({}));
  EXPECT_EQ(Store().Find("a")->fit.ShownName(), "Heavy böb");
  EXPECT_EQ(Store().Find("a")->order.name, "Heavy böb");
  EXPECT_EQ(Store().Find("a")->order.files.data.name, "a.csv");
  ASSERT_TRUE(Store().Rename("a", "Light bob"));
  EXPECT_EQ(Store().List({})->at(0).name, "Light bob");
  Close();
  EXPECT_EQ(Store().Find("a")->fit.name, "Light bob");  // on the disk
  ASSERT_TRUE(Store().Rename("a", ""));
  EXPECT_EQ(Store().Find("a")->fit.ShownName(), "a.csv");
  ExpectUnknown(Store().Rename("b", "x"), "fit b");
}

TEST_F(FitStoreTest, FindsARunByItsNameAndByThatOfItsFile) {
  Add("a");
  Add("b");
  ASSERT_TRUE(Store().Rename("a", "Heavy bob"));
  FitFilter filter;
  filter.name = "heavy B";
  EXPECT_THAT(Listed(filter), ElementsAre("a"));
  filter.name = "A.CSV";
  EXPECT_THAT(Listed(filter), ElementsAre("a"));
  filter.name = "b";
  EXPECT_THAT(Listed(filter), ElementsAre("b", "a"));
}

TEST_F(FitStoreTest, DeletesTheWaitingRunsOfABatch) {
  ASSERT_TRUE(Store().AddBatch("batch", kCreated, OrdersOf({"a", "b", "c"}), std::nullopt));
  ASSERT_TRUE(Store().AddBatch("other", kCreated, OrdersOf({"d"}), std::nullopt));
  ASSERT_TRUE(Store().Put("b", OutcomeOf({})));
  ASSERT_TRUE(Store().DeleteWaiting("batch"));
  EXPECT_THAT(IdsOf(Store().RunsOf("batch").value()), ElementsAre("b"));
  EXPECT_EQ(Store().RunsOf("other")->size(), 1);
  ExpectUnknown(Store().DeleteWaiting("none"), "batch none");
}

TEST_F(FitStoreTest, ListsAdjacentPages) {
  for (const char* id : {"a", "b", "c", "d", "e"}) Add(id);
  FitFilter filter;
  filter.limit = 2;
  const auto first = Store().List(filter);
  ASSERT_TRUE(first) << first.error().message();
  EXPECT_THAT(IdsOf(*first), ElementsAre("e", "d"));
  filter.before = first->back().run;
  EXPECT_THAT(Listed(filter), ElementsAre("c", "b"));
  filter.before = Store().Find("b")->fit.run;
  EXPECT_THAT(Listed(filter), ElementsAre("a"));
  filter.before = Store().Find("a")->fit.run;
  EXPECT_THAT(Listed(filter), IsEmpty());
}

TEST_F(FitStoreTest, FindsRunsByAPartOfTheirName) {
  FitOrder order = OrderOf("a");
  order.files.data.name = "Run_07 100%.csv";
  Add(order);
  Add("b");
  FitFilter filter;
  for (const char* name : {"run_07", "RUN", "100%", "Run_07 100%.csv"}) {
    filter.name = name;
    EXPECT_THAT(Listed(filter), ElementsAre("a")) << name;
  }
  for (const char* name : {"_", "%", "un_"}) {  // _ and % are not wildcards
    filter.name = name;
    EXPECT_THAT(Listed(filter), ElementsAre("a")) << name;
  }
  filter.name = "r%n";
  EXPECT_THAT(Listed(filter), IsEmpty());
}

TEST_F(FitStoreTest, FiltersByModelAndStatusOfTheSameFit) {
  Add(OrderOf("a"), OutcomeOf({FitOf("viscous", 1), FitOf("coulomb", 1, "not_converged")}));
  Add(OrderOf("b"), OutcomeOf({FitOf("drag", 1)}));
  Add(OrderOf("c"), FailureOf({"", "no swing"}, 5));
  const auto listed = [&](const std::string& model, const std::string& status) {
    FitFilter filter;
    filter.model = model;
    filter.status = status;
    return Listed(filter);
  };
  EXPECT_THAT(listed("viscous", ""), ElementsAre("c", "a"));
  EXPECT_THAT(listed("", "converged"), ElementsAre("b", "a"));
  EXPECT_THAT(listed("", "failed"), ElementsAre("c"));
  EXPECT_THAT(listed("coulomb", "not_converged"), ElementsAre("a"));
  EXPECT_THAT(listed("viscous", "not_converged"), IsEmpty());
  EXPECT_THAT(listed("linear", ""), IsEmpty());
}

TEST_F(FitStoreTest, FiltersByBatchAndTime) {
  Add(OrderOf("a", "2026-11-22T23:59:59Z"));
  Add(OrderOf("b", "2026-11-23T00:00:00Z"));
  AddBatch("night", {"c"});
  FitFilter filter;
  filter.since = "2026-11-23T00:00:00Z";
  EXPECT_THAT(Listed(filter), ElementsAre("c", "b"));
  filter.since = "2026-11-23T01:00:00+01:00";  // the same time in UTC
  EXPECT_THAT(Listed(filter), ElementsAre("c", "b"));
  filter = {};
  filter.batch = "night";
  EXPECT_THAT(Listed(filter), ElementsAre("c"));
  EXPECT_EQ(Store().List(filter)->front().batch, "night");
  EXPECT_EQ(Store().List(filter)->front().exit_code, std::nullopt);
  filter.batch = "day";
  EXPECT_THAT(Listed(filter), IsEmpty());
}

// ---- Deleting ------------------------------------------------------------------------------------------------------

TEST_F(FitStoreTest, StoresEqualFilesOnceWhileARunUsesThem) {
  FitOrder one = OrderOf("a"), other = OrderOf("b"), third = OrderOf("c");
  one.files.rig = other.files.rig = Share({"rig", "{}"});
  other.files.data.bytes = one.files.data.bytes;
  third.files.calibration = Share({"calibration", "{}"});  // the same bytes as other runs' rig
  Add(one);
  Add(other);
  Add(third);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM files"), 3);  // the recordings of a and c, and {}
  ASSERT_TRUE(Store().DeleteFit("a"));
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM files"), 3);
  EXPECT_EQ(Store().Find("b")->order.files.data.bytes, "a\n");
  ASSERT_TRUE(Store().DeleteFit("b"));
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM files"), 2);
  EXPECT_EQ(Store().Find("c")->order.files.calibration->bytes, "{}");
  ASSERT_TRUE(Store().DeleteFit("c"));
  for (const char* table : {"files", "requests", "runs", "fits", "quantities"}) {
    EXPECT_EQ(NumberOutside(std::string("SELECT count(*) FROM ") + table), 0) << table;
  }
}

TEST_F(FitStoreTest, DeletesOneRunOnly) {
  for (const char* id : {"a", "b", "c"}) Add(id);
  ASSERT_TRUE(Store().DeleteFit("b"));
  ExpectUnknown(Store().Find("b"), "fit b");
  ExpectUnknown(Store().DeleteFit("b"), "fit b");
  EXPECT_THAT(Listed({}), ElementsAre("c", "a"));
  EXPECT_THAT(Store().List({})->front().models, SizeIs(1));
  Add("b");
  EXPECT_THAT(Listed({}), ElementsAre("b", "c", "a"));
}

// ---- Batches -------------------------------------------------------------------------------------------------------

TEST_F(FitStoreTest, ProcessesABatchInOrder) {
  AddBatch("first", {"z", "a"});
  AddBatch("second", {"m"});
  EXPECT_THAT(Waiting(), ElementsAre("first/z", "first/a", "second/m"));
  ASSERT_TRUE(Store().Put("z", FailureOf({"z.csv", "no swing"}, 5)));
  ASSERT_TRUE(Store().Put("m", OutcomeOf({FitOf("viscous", 1)})));
  EXPECT_THAT(Waiting(), ElementsAre("first/a"));
  const auto runs = Store().RunsOf("first");
  ASSERT_TRUE(runs) << runs.error().message();
  EXPECT_THAT(IdsOf(*runs), ElementsAre("z", "a"));
  EXPECT_EQ(runs->front().exit_code, 5);
  EXPECT_EQ(runs->front().reason, "z.csv: no swing");
  EXPECT_EQ(runs->back().exit_code, std::nullopt);
  const auto batch = Store().FindBatch("first");
  ASSERT_TRUE(batch) << batch.error().message();
  EXPECT_EQ(batch->created, kCreated);
  EXPECT_EQ(batch->runs, 2);
  EXPECT_EQ(batch->done, 1);
  EXPECT_EQ(batch->failed, 1);
  EXPECT_EQ(Store().FindBatch("second")->failed, 0);
  EXPECT_TRUE(Store().Find("z")->result.is_null());
}

TEST_F(FitStoreTest, ListsBatchesLatestFirstInPages) {
  for (const char* id : {"a", "b", "c"}) AddBatch(id, {std::string(id) + "1", std::string(id) + "2"});
  EXPECT_THAT(Batches(10), ElementsAre("c", "b", "a"));
  EXPECT_THAT(Batches(2), ElementsAre("c", "b"));
  EXPECT_THAT(Batches(2, Store().FindBatch("b")->batch), ElementsAre("a"));
  EXPECT_EQ(Store().ListBatches(1, std::nullopt)->front().runs, 2);
}

TEST_F(FitStoreTest, DeletesABatchWithOnlyItsRuns) {
  Add("alone");
  AddBatch("first", {"a", "b"});
  AddBatch("second", {"c"});
  ASSERT_TRUE(Store().Put("a", OutcomeOf({FitOf("viscous", 1)})));
  ASSERT_TRUE(Store().DeleteBatch("first"));
  ExpectUnknown(Store().FindBatch("first"), "batch first");
  ExpectUnknown(Store().Find("a"), "fit a");
  ExpectUnknown(Store().Put("b", OutcomeOf({})), "fit b");
  EXPECT_THAT(Listed({}), ElementsAre("c", "alone"));
  EXPECT_THAT(Waiting(), ElementsAre("second/c"));
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM files"), 2);
}

TEST_F(FitStoreTest, KeepsABatchWhoseRunsWereDeletedOneByOne) {
  AddBatch("first", {"a", "b"});
  ASSERT_TRUE(Store().DeleteFit("a") && Store().DeleteFit("b"));
  EXPECT_EQ(Store().FindBatch("first")->runs, 0);
  EXPECT_THAT(Waiting(), IsEmpty());
}

TEST_F(FitStoreTest, StoresABatchCompletelyOrNotAtAll) {
  Add("b");
  EXPECT_FALSE(Store().AddBatch("batch", kCreated, OrdersOf({"a", "b"}), RequestKey{"key", "sha"}));
  ExpectUnknown(Store().FindBatch("batch"), "batch batch");
  ExpectUnknown(Store().Find("a"), "fit a");
  EXPECT_EQ(Store().FindAnswer("key").value(), std::nullopt);
  EXPECT_EQ(NumberOutside("SELECT count(*) FROM files"), 1);
}

// ---- Answers -------------------------------------------------------------------------------------------------------

std::string Now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

TEST_F(FitStoreTest, FindsTheAnswerToAKey) {
  ASSERT_TRUE(Store().Add(OrderOf("a", Now()), OutcomeOf({}), RequestKey{"fit's", "1234"}));
  ASSERT_TRUE(Store().AddBatch("b", Now(), OrdersOf({"c"}), RequestKey{"batch's", "5678"}));
  const auto fit = Store().FindAnswer("fit's"), batch = Store().FindAnswer("batch's");
  ASSERT_TRUE(fit && *fit && batch && *batch);
  EXPECT_EQ((*fit)->request_sha256, "1234");
  EXPECT_EQ((*fit)->location, "/v1/fits/a");
  EXPECT_EQ((*batch)->request_sha256, "5678");
  EXPECT_EQ((*batch)->location, "/v1/batches/b");
  EXPECT_FALSE(*Store().FindAnswer("FIT'S"));
}

TEST_F(FitStoreTest, ForgetsAnswersAfterADay) {
  ASSERT_TRUE(Store().Add(OrderOf("a", "2026-01-01T00:00:00Z"), OutcomeOf({}), RequestKey{"old", "1"}));
  ASSERT_TRUE(Store().Add(OrderOf("b", Now()), OutcomeOf({}), RequestKey{"new", "2"}));
  ASSERT_TRUE(Store().Add(OrderOf("c", Now()), OutcomeOf({}), RequestKey{"newer", "3"}));
  EXPECT_FALSE(*Store().FindAnswer("old"));
  EXPECT_TRUE(*Store().FindAnswer("new"));
  EXPECT_TRUE(Store().Find("a"));  // the run is not deleted
}

}  // namespace
}  // namespace pendulum::fit_store_test
