// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/source.h"
#include "pendulum/batch/summary.h"
#include "pendulum/batch/summary_json.h"
#include "tests/batch/made_outcomes.h"
#include "tests/batch/made_store.h"

namespace pendulum::run_list_test {
namespace {

using made_outcomes::FailureOf;
using made_outcomes::FitOf;
using made_outcomes::FitWithCovariance;
using made_outcomes::OutcomeOf;
using made_store::PlainManifest;
using testing::ElementsAre;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// The list of runs of a store that is refitted at times which the test says.
class RunListTest : public made_store::MadeStoreTest {
 protected:
  /// Refits the runs of the manifest at these positions, at this time.
  void Refit(const std::string& manifest, const std::string& time, const std::vector<std::size_t>& positions) {
    folder_.Write("runs.csv", manifest);
    const auto source = OpenSource(folder_ / "runs.csv");
    auto store = Open();
    store.SetClock([&] { return time; });
    ASSERT_TRUE(store.Begin(*source, std::nullopt, "{}"));
    ASSERT_TRUE(store.KeepCommand(R"({"model":"viscous","rig":"my rig.json","closed_form_only":true})", "lab/today"));
    const auto runs = store.Next(0, 100);
    for (const std::size_t i : positions)
      ASSERT_TRUE(store.Put(runs->at(i).entry.id, OutcomeOf({FitOf("viscous", 10)})));
    ASSERT_TRUE(store.Complete());
  }

  Store Open() const { return *Store::Open(folder_ / "store.sqlite", Store::Mode::kWrite); }

  static Json JsonOf(Store& store) { return ToJson(*Summarize(store, {})); }

  static std::vector<std::string> ValuesOf(const Json& summary, const char* key) {
    std::vector<std::string> values;
    for (const Json& run : summary["runs"]) values.push_back(run[key].is_null() ? "-" : run[key].get<std::string>());
    return values;
  }
};

TEST_F(RunListTest, SaysWhatIsNewInTheLastRefit) {
  Refit(PlainManifest(2), "2026-11-30T06:00:00Z", {0, 1});
  Refit(PlainManifest(3), "2026-12-01T06:00:00Z", {1, 2});
  Store store = Open();
  const Json summary = JsonOf(store);
  EXPECT_EQ(
      summary["refit"],
      Json({{"began", "2026-12-01T06:00:00Z"},
            {"ended", "2026-12-01T06:00:00Z"},
            {"new", 1},
            {"again", 1},
            {"text", "Since the refit before: of 3 recordings, 1 is new, 1 was fitted again and 1 is as before."}}));
  EXPECT_THAT(ValuesOf(summary, "id"), ElementsAre("run1.csv", "run2.csv", "run0.csv"));
  EXPECT_THAT(ValuesOf(summary, "news"), ElementsAre("again", "new", "-"));
  EXPECT_THAT(ValuesOf(summary, "fitted"),
              ElementsAre("2026-12-01T06:00:00Z", "2026-12-01T06:00:00Z", "2026-11-30T06:00:00Z"));
}

TEST_F(RunListTest, SaysThatNothingIsNew) {
  Refit(PlainManifest(2), "2026-11-30T06:00:00Z", {0, 1});
  Refit(PlainManifest(2), "2026-12-01T06:00:00Z", {});
  Store store = Open();
  EXPECT_EQ(JsonOf(store)["refit"]["text"], "Nothing is new: the last refit fitted no recording.");
}

TEST_F(RunListTest, GoesOnWithAnInterruptedRefit) {
  folder_.Write("runs.csv", PlainManifest(2));
  const auto source = OpenSource(folder_ / "runs.csv");
  auto store = Open();
  std::string time = "2026-11-30T06:00:00Z";
  store.SetClock([&] { return time; });
  ASSERT_TRUE(store.Begin(*source, std::nullopt, "{}"));
  ASSERT_TRUE(store.Put("run0.csv", OutcomeOf({FitOf("viscous", 10)})));
  ASSERT_TRUE(store.Commit());
  EXPECT_TRUE(JsonOf(store)["refit"]["ended"].is_null());
  time = "2026-11-30T07:00:00Z";
  ASSERT_TRUE(store.Begin(*source, std::nullopt, "{}"));
  ASSERT_TRUE(store.Put("run1.csv", OutcomeOf({FitOf("viscous", 10)})));
  ASSERT_TRUE(store.Complete());
  const Json refit = JsonOf(store)["refit"];
  EXPECT_EQ(refit["began"], "2026-11-30T06:00:00Z");
  EXPECT_EQ(refit["ended"], "2026-11-30T07:00:00Z");
  EXPECT_EQ(refit["new"], 2);
}

TEST_F(RunListTest, HasTheCommandOfEachRun) {
  Refit("path,rig,from_s,models\nx/it's.csv,b.json,1.5,coulomb\n../y.csv,,,\n", "2026-12-01T06:00:00Z", {0, 1});
  Store store = Open();
  EXPECT_THAT(ValuesOf(JsonOf(store), "command"),
              ElementsAre("fit_pendulum 'lab/today/x/it'\\''s.csv' --model coulomb --rig lab/today/b.json "
                          "--closed_form_only --from 1.5 --report 'it'\\''s.html'",
                          "fit_pendulum lab/y.csv --model viscous --rig 'my rig.json' --closed_form_only "
                          "--report y.html"));
}

TEST_F(RunListTest, HasWhatNeedsALookFirst) {
  Store store = StoreOf(PlainManifest(9), [](std::size_t i) -> std::optional<RunOutcome> {
    if (i == 8) return std::nullopt;
    if (i == 7) return FailureOf({"run7.csv", "no swing"}, 5);
    if (i == 6) return FailureOf({"run6.csv", "there is no such file"}, 3);
    Json fit = FitWithCovariance(i == 5 ? 10.3 : 10, 0.05, 5, 0.1);
    if (i == 4) fit["summary"] = {{"level", "caution"}, {"verdict", "The law does not describe all readings."}};
    return OutcomeOf({fit});
  });
  const Json summary = JsonOf(store);
  EXPECT_THAT(ValuesOf(summary, "id"), ElementsAre("run6.csv", "run7.csv", "run4.csv", "run5.csv", "run8.csv",
                                                   "run0.csv", "run1.csv", "run2.csv", "run3.csv"));
  EXPECT_THAT(ValuesOf(summary, "state"),
              ElementsAre("missing", "refused", "fitted, with doubts", "disagrees with the others", "not fitted yet",
                          "fitted", "fitted", "fitted", "fitted"));
  EXPECT_THAT(ValuesOf(summary, "level"),
              ElementsAre("bad", "bad", "caution", "caution", "waiting", "good", "good", "good", "good"));
  EXPECT_EQ(summary["runs"][1]["text"], "no swing");
  EXPECT_EQ(summary["runs"][2]["text"], "The law does not describe all readings.");
  // 0.3 of 10 is 3 %; the others are equal, so the scale is the error of the run, and z is 0.3 / 0.05.
  const std::string difference = "inertia 10.3, the others 10: 3 % more, z 6";
  EXPECT_EQ(summary["runs"][3]["text"], difference);
  EXPECT_THAT(summary["disagreement"].get<std::string>(), HasSubstr("run5.csv (" + difference + ")"));
  const auto inertia = std::ranges::find(summary["parameters"], "inertia", [](const Json& one) { return one["name"]; });
  ASSERT_NE(inertia, summary["parameters"].end());
  EXPECT_EQ((*inertia)["outliers"][0]["z_text"], "6");
}

}  // namespace
}  // namespace pendulum::run_list_test
