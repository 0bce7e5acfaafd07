// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/compare_stores.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/batch/example_runs.h"
#include "tests/batch/made_outcomes.h"

namespace pendulum::compare_stores_test {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
using example_runs::RefittedOutcome;
using example_runs::SourceOfIds;
using example_runs::StoreOf;
using example_runs::UnfittedOutcome;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

/// A fit of model coulomb with or without a parameter.
struct Fit {
  std::string id;
  Json estimate, std_error;
  std::string status = "converged";
  std::string unit = "kg m^2";
  std::string data = "data", cpu = "cpu";
};

/// A result with one parameter in the form of result.schema.json.
RunOutcome OutcomeOf(const Fit& fit) {
  RunOutcome outcome;
  outcome.provenance = {fit.data, "", "", "options", "0.1.0", fit.cpu};
  const Json parameter = {{"estimate", fit.estimate}, {"std_error", fit.std_error},
                          {"interval95", nullptr},    {"systematic_std_error", nullptr},
                          {"unit", fit.unit},         {"fixed", false},
                          {"at_bound", false}};
  const Json parameters = fit.estimate.is_null() ? Json::object() : Json{{"inertia", parameter}};
  outcome.result = made_outcomes::ResultOf({{{"model", "coulomb"},
                                             {"status", fit.status},
                                             {"reason", "a reason"},
                                             {"parameters", parameters},
                                             {"derived", Json{{"natural_frequency", parameter}}},
                                             {"noise", nullptr},
                                             {"statistics", nullptr},
                                             {"solver", Json::object()}}});
  return outcome;
}

class CompareStoresTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Store Make(const std::string& name, const std::vector<Fit>& fits) const {
    fs::remove(folder_ / name);
    std::vector<std::string> ids;
    for (const Fit& fit : fits) ids.push_back(fit.id);
    Store store = StoreOf(folder_ / name, SourceOfIds(ids));
    for (const Fit& fit : fits) EXPECT_TRUE(store.Put(fit.id, OutcomeOf(fit)));
    EXPECT_TRUE(store.Commit());
    return store;
  }

  StoreComparison Compare(const std::vector<Fit>& before, const std::vector<Fit>& after) const {
    Store first = Make("before.sqlite", before), second = Make("after.sqlite", after);
    const auto comparison = CompareStores(first, second);
    EXPECT_TRUE(comparison) << comparison.error().message();
    return comparison.value_or(StoreComparison());
  }

  /// Comparison of two stores with one run whose parameter changes.
  StoreComparison Move(const Json& estimate, const Json& std_error, const Json& estimate_after,
                       const Json& std_error_after) const {
    return Compare({{"a", estimate, std_error}}, {{"a", estimate_after, std_error_after}});
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("compare_stores_test_" + std::to_string(getpid()));
};

TEST_F(CompareStoresTest, FindsAResultIdenticalToItself) {
  const fs::path path = folder_ / "real.sqlite";
  Store store = StoreOf(path, SourceOfIds({"a", "b", "c"}));
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", UnfittedOutcome()) && store.Commit());
  fs::copy_file(path, folder_ / "copy.sqlite");
  Store copy = Store::Open(folder_ / "copy.sqlite", Store::Mode::kRead).value();
  for (int again = 0; again < 2; ++again) {
    const StoreComparison comparison = CompareStores(store, copy).value();
    std::int64_t parameters = 0;
    const auto& result = RefittedOutcome().result;
    for (const auto& fit : result["fits"]) parameters += std::ssize(fit["parameters"]);
    for (const auto& own : result["recordings"][0]["fits"]) parameters += std::ssize(own["parameters"]);
    EXPECT_EQ(comparison.identical, parameters);
    EXPECT_EQ(comparison.fits, 4);
    EXPECT_EQ(comparison.only_before + comparison.only_after + comparison.other_data + comparison.changed_status, 0);
    EXPECT_EQ(comparison.rounding + comparison.within_errors + comparison.moved + comparison.without_error, 0);
    EXPECT_EQ(comparison.cpus_before.size(), 2);
  }
}

TEST_F(CompareStoresTest, DistinguishesRoundingFromChangesWithinErrors) {
  EXPECT_EQ(Move(1.0, 0.1, 1.0, 0.1).identical, 1);
  EXPECT_EQ(Move(1.0, 0.1, 1.0000000000000002, 0.1).rounding, 1);  // the next double
  EXPECT_EQ(Move(1.0, 0.1, 1.0, 0.10000000000000002).rounding, 1);
  EXPECT_EQ(Move(1.0, 0.1, 1 + 0.9e-10, 0.1).rounding, 1);  // 0.9e-9 standard errors
  EXPECT_EQ(Move(1.0, 0.1, 1 + 1.1e-10, 0.1).within_errors, 1);
  EXPECT_EQ(Move(1.0, 0.1, 0.901, 0.1).within_errors, 1);
  EXPECT_EQ(Move(1.0, 0.1, 0.901, 0.1).moved, 0);
  EXPECT_EQ(Move(0.0, 0.1, 0.0, 0.15).within_errors, 1);
}

TEST_F(CompareStoresTest, ReportsHowFarAParameterMoved) {
  const StoreComparison comparison = Move(1.0, 0.5, 2.5, 0.25);
  EXPECT_EQ(comparison.moved, 1);
  EXPECT_EQ(comparison.identical + comparison.rounding + comparison.within_errors + comparison.without_error, 0);
  ASSERT_EQ(comparison.most_moved.size(), 1);
  const MovedParameter& moved = comparison.most_moved[0];
  EXPECT_EQ(moved.id + "/" + moved.model + "/" + moved.name + "/" + moved.unit, "a/coulomb/inertia/kg m^2");
  EXPECT_EQ(moved.before, 1);
  EXPECT_EQ(moved.after, 2.5);
  EXPECT_EQ(moved.errors, 6);  // 1.5 over the smaller error, 0.25
}

TEST_F(CompareStoresTest, SkipsValuesWithoutErrors) {
  EXPECT_EQ(Move(1.0, nullptr, 1.0, nullptr).identical, 1);
  EXPECT_EQ(Move(1.0, nullptr, 1.1, nullptr).without_error, 1);
  EXPECT_EQ(Move(1.0, 0.1, 1.0, nullptr).without_error, 1);
  EXPECT_EQ(Move(1.0, nullptr, 1.0, 0.1).without_error, 1);
  EXPECT_EQ(Move(1.0, 0.0, 1.1, 0.0).without_error, 1);
  EXPECT_EQ(Move(1.0, nullptr, 1.1, nullptr).moved, 0);
}

TEST_F(CompareStoresTest, SkipsValuesOfDifferentUnits) {
  const StoreComparison comparison =
      Compare({{"a", 1.0, 0.1, "converged", "kg m^2"}}, {{"a", 5.0, 0.1, "converged", "s^2"}});
  EXPECT_EQ(comparison.moved, 0);
  EXPECT_THAT(comparison.most_moved, IsEmpty());
}

TEST_F(CompareStoresTest, ListsTheLargestChangesInOrder) {
  std::vector<Fit> before, after;
  for (int i = 1; i <= 130; ++i) {
    before.push_back({"run " + std::to_string(i), 0.0, 1.0});
    after.push_back({"run " + std::to_string(i), 37 * i % 131 + 1.0, 1.0});  // 2 to 131, each once: 131 is prime
  }
  const StoreComparison comparison = Compare(before, after);
  EXPECT_EQ(comparison.moved, 130);
  ASSERT_EQ(comparison.most_moved.size(), StoreComparison::kMaxListed);
  for (int i = 0; i < StoreComparison::kMaxListed; ++i)
    EXPECT_EQ(comparison.most_moved[static_cast<std::size_t>(i)].errors, 131 - i);
}

TEST_F(CompareStoresTest, ListsFitsWithAnotherStatus) {
  std::vector<Fit> before = {{"a", 1.0, 0.1}, {"b", 1.0, 0.1}},
                   after = {{"a", 1.0, 0.1}, {"b", 1.0, nullptr, "failed"}};
  StoreComparison comparison = Compare(before, after);
  EXPECT_EQ(comparison.changed_status, 1);
  ASSERT_EQ(comparison.status_changes.size(), 1);
  const ChangedStatus& status = comparison.status_changes[0];
  EXPECT_EQ(status.id + " " + status.model + " " + status.before + " " + status.after, "b coulomb converged failed");
  for (int i = 0; i < 120; ++i) {
    before.push_back({std::to_string(i), 1.0, 0.1});
    after.push_back({std::to_string(i), 1.0, 0.1, "not_converged"});
  }
  comparison = Compare(before, after);
  EXPECT_EQ(comparison.changed_status, 121);
  EXPECT_EQ(comparison.status_changes.size(), StoreComparison::kMaxListed);
  EXPECT_EQ(comparison.status_changes[0].id, "b");
}

TEST_F(CompareStoresTest, CountsFitsInOnlyOneOfTheStores) {
  const auto fit = [](const std::string& id) { return Fit{id, 1.0, 0.1, "converged", "rad", "data of " + id}; };
  const StoreComparison comparison = Compare({fit("a"), fit("b")}, {fit("b"), fit("c"), fit("d")});
  EXPECT_EQ(comparison.fits, 1);
  EXPECT_EQ(comparison.only_before, 1);
  EXPECT_EQ(comparison.only_after, 2);
  ASSERT_EQ(comparison.removed.size(), 1);
  EXPECT_EQ(comparison.removed[0].id + " " + comparison.removed[0].model, "a coulomb");
  EXPECT_EQ(comparison.identical, 1);
}

TEST_F(CompareStoresTest, LeavesOutFitsThatStatisticsLeaveOut) {
  const std::vector<Fit> fits = {{"a", 1.0, 0.1}, {"b", 1.0, 0.1}, {"c", 1.0, 0.1}, {"d", 1.0, 0.1}};
  Store before = Make("before.sqlite", fits), after = Make("after.sqlite", fits);
  before.database().exec("UPDATE runs SET stale = 'gone' WHERE id = 'd'");
  after.database().exec(
      "UPDATE runs SET stale = 'gone' WHERE id IN ('a', 'd'); UPDATE runs SET position = -1 WHERE id = 'b';"
      "UPDATE fits SET stale = 'not asked for' WHERE run IN (SELECT run FROM runs WHERE id = 'c')");
  const StoreComparison comparison = CompareStores(before, after).value();
  EXPECT_EQ(comparison.fits, 0);
  EXPECT_EQ(comparison.only_before, 3);
  EXPECT_EQ(comparison.stale_before, 1);
  EXPECT_EQ(comparison.stale_after, 4);
  ASSERT_EQ(comparison.removed.size(), 3);
  EXPECT_EQ(comparison.removed[0].id + comparison.removed[1].id + comparison.removed[2].id, "abc");
  const StoreComparison back = CompareStores(after, before).value();
  EXPECT_EQ(back.only_before, 0);
  EXPECT_EQ(back.only_after, 3);
}

TEST_F(CompareStoresTest, RecognizesRenamedRecordings) {
  const auto fit = [](const std::string& id, const std::string& data) {
    return Fit{id, 1.0, 0.1, "converged", "rad", data};
  };
  const StoreComparison comparison = Compare({fit("a", "1"), fit("b", "2"), fit("c", "3"), fit("d", "3")},
                                             {fit("new", "1"), fit("b", "2"), fit("e", "3"), fit("f", "3")});
  EXPECT_EQ(comparison.renamed, 3);
  EXPECT_EQ(comparison.identical, 4);
  EXPECT_EQ(comparison.only_before, 0);
  EXPECT_EQ(comparison.only_after, 0);
  EXPECT_THAT(comparison.removed, IsEmpty());
}

TEST_F(CompareStoresTest, RecognizesARenamedRecordingWhoseFormerRunIsStillInTheStore) {
  Store before = Make("before.sqlite", {{"a", 1.0, 0.1}});
  Store after = Make("after.sqlite", {{"a", 1.0, 0.1}, {"new", 1.0, 0.1}});
  after.database().exec("UPDATE runs SET position = -1 WHERE id = 'a'");
  const StoreComparison comparison = CompareStores(before, after).value();
  EXPECT_EQ(comparison.renamed, 1);
  EXPECT_EQ(comparison.only_before, 0);
}

TEST_F(CompareStoresTest, DetectsOtherDataAndProcessors) {
  const StoreComparison comparison =
      Compare({{"a", 1.0, 0.1, "converged", "rad", "one", "new"}, {"b", 1.0, 0.1, "converged", "rad", "two", "old"}},
              {{"a", 1.0, 0.1, "converged", "rad", "other", "old"}, {"b", 1.0, 0.1, "converged", "rad", "two", "old"}});
  EXPECT_EQ(comparison.other_data, 1);
  EXPECT_THAT(comparison.cpus_before, ElementsAre("new", "old"));
  EXPECT_THAT(comparison.cpus_after, ElementsAre("old"));
}

TEST_F(CompareStoresTest, ComparesNoDerivedQuantities) {
  const StoreComparison comparison = Compare({{"a", nullptr, nullptr}}, {{"a", nullptr, nullptr}});
  EXPECT_EQ(comparison.fits, 1);
  EXPECT_EQ(comparison.identical, 0);
}

}  // namespace
}  // namespace pendulum::compare_stores_test
