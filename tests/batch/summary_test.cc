// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/summary_json.h"
#include "tests/batch/made_outcomes.h"
#include "tests/batch/made_store.h"

namespace pendulum::summary_test {
namespace {

using made_outcomes::FailureOf;
using made_outcomes::FitOf;
using made_outcomes::FitWithCovariance;
using made_outcomes::OutcomeOf;
using made_store::ManifestOf;
using made_store::PlainManifest;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

namespace fs = std::filesystem;

class SummaryTest : public made_store::MadeStoreTest {
 protected:
  static Json SummaryOf(Store& store, const SummaryOptions& options = {}) {
    auto summary = Summarize(store, options);
    if (summary) return ToJson(*summary);
    ADD_FAILURE() << summary.error().message();
    return nullptr;
  }
};

const Json& ParameterOf(const Json& summary, const std::string& model, const std::string& name) {
  static const Json nothing;
  for (const Json& parameter : summary["parameters"]) {
    if (parameter["model"] == model && parameter["name"] == name) return parameter;
  }
  ADD_FAILURE() << model << " " << name;
  return nothing;
}

// ---- Counts --------------------------------------------------------------------------------------------------------

TEST_F(SummaryTest, CountsFitsByModelStatusAndRecommendation) {
  Store store = StoreOf(PlainManifest(5), [](std::size_t i) -> std::optional<RunOutcome> {
    if (i == 4) return std::nullopt;
    if (i == 3) return FailureOf({"run3.csv", "no swing"}, 5);
    const std::vector<Json> fits = {FitOf("viscous", 10, i == 0 ? "not_converged" : "converged"),
                                    FitOf("coulomb", 10, i == 1 ? "not_identifiable" : "converged")};
    return OutcomeOf(fits, i == 2 ? nullptr : "viscous");
  });
  const Json summary = SummaryOf(store);
  EXPECT_EQ(summary["schema_version"], 2);
  EXPECT_EQ(summary["tool"]["name"], "refit_pendulums");
  EXPECT_EQ(summary["store"]["path"], (folder_ / "store.sqlite").string());
  EXPECT_EQ(summary["store"]["runs"], 5);
  EXPECT_EQ(summary["store"]["refitted"], 4);
  EXPECT_EQ(summary["store"]["pending"], 1);
  EXPECT_EQ(summary["store"]["fits"], 7);
  EXPECT_THAT(summary["store"]["versions"], ElementsAre("1.2.3"));
  EXPECT_THAT(summary["store"]["cpus"], ElementsAre("processor time"));
  EXPECT_THAT(summary["models"], ElementsAre(Json({{"model", "coulomb"},
                                                   {"fits", 3},
                                                   {"converged", 2},
                                                   {"not_converged", 0},
                                                   {"not_identifiable", 1},
                                                   {"failed", 0}}),
                                             Json({{"model", "viscous"},
                                                   {"fits", 4},
                                                   {"converged", 2},
                                                   {"not_converged", 1},
                                                   {"not_identifiable", 0},
                                                   {"failed", 1}})));
  EXPECT_THAT(summary["recommendations"],
              ElementsAre(Json({{"model", "viscous"}, {"runs", 2}}), Json({{"model", nullptr}, {"runs", 1}})));
  EXPECT_EQ(ParameterOf(summary, "viscous", "inertia")["runs"], 2);  // only converged fits
  EXPECT_THAT(summary["warnings"], SizeIs(testing::Ge(1U)));         // one run is pending
}

TEST_F(SummaryTest, CountsUnconvergedFitsAsFailures) {
  Store store = StoreOf(PlainManifest(3), [](std::size_t) {
    RunOutcome outcome = OutcomeOf({FitOf("viscous", 10, "not_converged")});
    outcome.exit_code = 1;
    return outcome;
  });
  const Json summary = SummaryOf(store);
  ASSERT_THAT(summary["failures"], SizeIs(1));
  EXPECT_EQ(summary["failures"][0]["status"], "not_converged");
  EXPECT_EQ(summary["failures"][0]["exit_code"], 1);
  EXPECT_EQ(summary["failures"][0]["reason"], "after 100 iterations");
  EXPECT_THAT(summary["parameters"], IsEmpty());
}

// ---- Parameters ----------------------------------------------------------------------------------------------------

// 10, 12, 14: expected values by hand; np.percentile(x, [25, 75]) is 11, 13.
TEST_F(SummaryTest, DescribesEachFittedParameter) {
  const std::vector<double> values = {10, 12, 14};
  Store store = StoreOf(PlainManifest(3), [&](std::size_t i) { return OutcomeOf({FitOf("viscous", values[i])}); });
  const Json summary = SummaryOf(store);
  ASSERT_THAT(summary["parameters"], SizeIs(2));  // without fixed parameters
  const Json& inertia = ParameterOf(summary, "viscous", "inertia");
  EXPECT_EQ(inertia["unit"], "kg m^2");
  EXPECT_EQ(inertia["runs"], 3);
  EXPECT_EQ(inertia["median"], 12);
  EXPECT_EQ(inertia["mean"], 12);
  EXPECT_EQ(inertia["std_dev"], 2);
  EXPECT_EQ(inertia["minimum"], 10);
  EXPECT_EQ(inertia["maximum"], 14);
  EXPECT_EQ(inertia["lower_quartile"], 11);
  EXPECT_EQ(inertia["upper_quartile"], 13);
  EXPECT_EQ(inertia["median_std_error"], 1);
  EXPECT_EQ(inertia["histogram"]["from"], 10);
  EXPECT_EQ(inertia["histogram"]["to"], 14);
  const Json& repeatability = inertia["repeatability"];  // errors of 1: chi2 = 4 + 0 + 4, p = exp(-8 / 2)
  EXPECT_EQ(repeatability["groups"], 1);
  EXPECT_EQ(repeatability["runs"], 3);
  EXPECT_EQ(repeatability["dof"], 2);
  EXPECT_NEAR(repeatability["chi2"].get<double>(), 8, 1e-12);
  EXPECT_NEAR(repeatability["scatter_ratio"].get<double>(), 2, 1e-12);
  EXPECT_NEAR(repeatability["p"].get<double>(), std::exp(-4), 1e-9);
  EXPECT_NEAR(repeatability["between_std_dev"].get<double>(), std::sqrt(3), 1e-6);
  EXPECT_EQ(repeatability["verdict"], "agrees");
  EXPECT_THAT(repeatability["text"], StartsWith("3 runs scatter 2 times as much as their errors predict (p "));
  ASSERT_THAT(repeatability["rows"], SizeIs(1));
  EXPECT_EQ(repeatability["rows"][0]["group"], "all runs");
  EXPECT_NEAR(repeatability["rows"][0]["weighted_mean"].get<double>(), 12, 1e-12);
  EXPECT_NEAR(repeatability["rows"][0]["std_error"].get<double>(), 1 / std::sqrt(3), 1e-12);
  EXPECT_EQ(inertia["repeatability_reason"], nullptr);
  EXPECT_THAT(inertia["outliers"], IsEmpty());
}

TEST_F(SummaryTest, ExcludesStartParametersFromRepeatability) {
  Store store =
      StoreOf(PlainManifest(6), [](std::size_t i) { return OutcomeOf({FitOf("viscous", i == 5 ? 1e6 : 10)}); });
  const Json angle = ParameterOf(SummaryOf(store), "viscous", "release_angle");
  EXPECT_EQ(angle["repeatability"], nullptr);
  EXPECT_THAT(angle["repeatability_reason"], HasSubstr("not a constant of the rig"));
  EXPECT_EQ(angle["outliers_total"], 0);
}

// The trend is over the position: y = 10 + 0.5 i with an outlier, which is left out.
TEST_F(SummaryTest, ExcludesOutliersFromTheTrend) {
  Store store = StoreOf(PlainManifest(20), [](std::size_t i) {
    const double scatter = i % 2 == 0 ? 0.01 : -0.01;
    return OutcomeOf({FitOf("viscous", i == 7 ? 1000 : 10 + 0.5 * static_cast<double>(i) + scatter)});
  });
  const Json summary = SummaryOf(store);
  EXPECT_EQ(summary["group_by"], nullptr);
  EXPECT_EQ(summary["trend_by"], nullptr);
  const Json& inertia = ParameterOf(summary, "viscous", "inertia");
  EXPECT_EQ(inertia["outliers_total"], 1);
  ASSERT_THAT(inertia["outliers"], SizeIs(1));
  EXPECT_EQ(inertia["outliers"][0]["id"], "run7.csv");
  EXPECT_EQ(inertia["outliers"][0]["estimate"], 1000);
  EXPECT_EQ(inertia["outliers"][0]["std_error"], 1);
  EXPECT_EQ(inertia["outliers"][0]["group"], nullptr);
  EXPECT_THAT(inertia["repeatability"]["text"], HasSubstr("; 1 outlier left out"));
  const Json& trend = inertia["trend"];
  EXPECT_EQ(trend["column"], "position");
  EXPECT_EQ(trend["unit"], nullptr);
  EXPECT_NEAR(trend["slope"].get<double>(), 0.5, 0.001);
  EXPECT_LT(trend["p"].get<double>(), 1e-12);
  EXPECT_THAT(trend["text"], AllOf(StartsWith("it changes by 0."), HasSubstr(" kg m^2 per run (p ")));
  EXPECT_THAT(trend["points"], SizeIs(20));
  EXPECT_EQ(trend["points_total"], 20);
  EXPECT_EQ(trend["points"][3]["x"], 3);
  EXPECT_EQ(trend["points"][3]["id"], "run3.csv");
}

TEST_F(SummaryTest, GroupsRunsByAColumnOfTheManifest) {
  const std::string manifest = ManifestOf(20, ",rig no", [](std::size_t i) { return i % 2 == 0 ? ",A" : ",B"; });
  Store store = StoreOf(manifest, [](std::size_t i) {  // rigs with means 10 and 90, runs ± 1
    return OutcomeOf({FitOf("viscous", (i % 2 == 0 ? 10 : 90) + (i % 4 < 2 ? 1 : -1))});
  });
  EXPECT_EQ(ParameterOf(SummaryOf(store, {"all", ""}), "viscous", "inertia")["repeatability"]["verdict"],
            "scatter_larger");
  const Json summary = SummaryOf(store, {"rig no", ""});
  EXPECT_EQ(summary["group_by"], "rig no");
  const Json& repeatability = ParameterOf(summary, "viscous", "inertia")["repeatability"];
  EXPECT_EQ(repeatability["groups"], 2);
  EXPECT_EQ(repeatability["dof"], 18);
  EXPECT_EQ(repeatability["verdict"], "agrees");
  ASSERT_THAT(repeatability["rows"], SizeIs(2));
  EXPECT_EQ(repeatability["rows"][0]["group"], "A");
  EXPECT_NEAR(repeatability["rows"][0]["weighted_mean"].get<double>(), 10, 1e-9);
  EXPECT_EQ(repeatability["rows"][1]["group"], "B");
  EXPECT_NEAR(repeatability["rows"][1]["weighted_mean"].get<double>(), 90, 1e-9);
}

TEST_F(SummaryTest, AcceptsAnyColumnName) {
  for (const std::string name : {"a.b", "$", "günther", "[0]", "it's", "a b"}) {
    const std::string manifest = ManifestOf(6, "," + name, [](std::size_t i) { return i < 3 ? ",A" : ",B"; });
    Store store = StoreOf(manifest, [](std::size_t i) { return OutcomeOf({FitOf("viscous", i < 3 ? 10 : 90)}); });
    const Json summary = SummaryOf(store, {name, ""});
    EXPECT_EQ(ParameterOf(summary, "viscous", "inertia")["repeatability"]["groups"], 2) << name;
    fs::remove(folder_ / "store.sqlite");
  }
}

TEST_F(SummaryTest, FindsTrendsOverDates) {
  const std::string manifest = ManifestOf(
      10, ",date", [](std::size_t i) { return ",2026-03-" + std::string(i < 9 ? "0" : "") + std::to_string(i + 1); });
  Store store = StoreOf(manifest, [](std::size_t i) {
    return OutcomeOf({FitOf("viscous", 10 - 0.25 * static_cast<double>(i) + (i % 3 == 0 ? 0.01 : 0))});
  });
  const Json trend = ParameterOf(SummaryOf(store, {"", "date"}), "viscous", "inertia")["trend"];
  EXPECT_EQ(trend["column"], "date");
  EXPECT_EQ(trend["unit"], "days since 1970-01-01");
  EXPECT_NEAR(trend["slope"].get<double>(), -0.25, 0.002);
  EXPECT_THAT(trend["text"], HasSubstr(" kg m^2 per day (p "));
  EXPECT_EQ(trend["points"][0]["x"], 20513);  // 2026-03-01
}

TEST_F(SummaryTest, FindsTrendsOverNumbers) {
  const std::string manifest =
      ManifestOf(10, ",temperature", [](std::size_t i) { return "," + std::to_string(20 + 2 * i); });
  Store store = StoreOf(manifest, [](std::size_t i) {
    return OutcomeOf({FitOf("viscous", 10 + static_cast<double>(i) + (i % 3 == 0 ? 0.01 : 0))});
  });
  const Json trend = ParameterOf(SummaryOf(store, {"", "temperature"}), "viscous", "inertia")["trend"];
  EXPECT_EQ(trend["unit"], nullptr);
  EXPECT_NEAR(trend["slope"].get<double>(), 0.5, 0.002);
  EXPECT_THAT(trend["text"], HasSubstr(" per unit of temperature (p "));
}

TEST_F(SummaryTest, RecognizesDatesIfTheLastRunHasNoDate) {
  const std::string manifest =
      ManifestOf(10, ",date", [](std::size_t i) { return i == 9 ? "," : ",2026-03-0" + std::to_string(i + 1); });
  Store store =
      StoreOf(manifest, [](std::size_t i) { return OutcomeOf({FitOf("viscous", 10 + static_cast<double>(i % 3))}); });
  const Json trend = ParameterOf(SummaryOf(store, {"", "date"}), "viscous", "inertia")["trend"];
  EXPECT_THAT(trend["points"], SizeIs(9));
  EXPECT_EQ(trend["unit"], "days since 1970-01-01");
  EXPECT_THAT(trend["text"], HasSubstr(" per day (p "));
}

TEST_F(SummaryTest, ThinsThePointsOfManyRuns) {
  Store store = StoreOf(PlainManifest(4500),
                        [](std::size_t i) { return OutcomeOf({FitOf("viscous", 10 + static_cast<double>(i % 3))}); });
  const Json trend = ParameterOf(SummaryOf(store), "viscous", "inertia")["trend"];
  EXPECT_THAT(trend["points"], SizeIs(1500));
  EXPECT_EQ(trend["points_total"], 4500);
}

TEST_F(SummaryTest, SeparatesTheRigsOfTheManifest) {
  const auto make = [](std::size_t i) { return OutcomeOf({FitOf("viscous", i % 2 == 0 ? 10 : 90)}); };
  Store several =
      StoreOf(ManifestOf(8, ",rig", [](std::size_t i) { return i % 2 == 0 ? ",a.json" : ",b.json"; }), make);
  EXPECT_EQ(SummaryOf(several)["group_by"], "rig");
  EXPECT_EQ(ParameterOf(SummaryOf(several), "viscous", "inertia")["repeatability"]["groups"], 2);
  EXPECT_EQ(SummaryOf(several, {"path", ""})["group_by"], "path");
  Store one = StoreOf(ManifestOf(8, ",rig", [](std::size_t) { return ",a.json"; }), make);
  EXPECT_EQ(SummaryOf(one)["group_by"], nullptr);
}

std::vector<std::string> WarningsOf(const Json& summary) {
  std::vector<std::string> codes;
  for (const Json& warning : summary["warnings"]) codes.push_back(warning["code"]);
  return codes;
}

TEST_F(SummaryTest, WarnsOfAColumnWithoutAnOrder) {
  const char* const dates[] = {"2026-03-01", "2026-03-02T12:00Z", "03.03.2026", ""};
  Store store = StoreOf(ManifestOf(4, ",date", [&](std::size_t i) { return std::string(",") + dates[i]; }),
                        [](std::size_t) { return OutcomeOf({FitOf("viscous", 10)}); });
  const Json summary = SummaryOf(store, {"", "date"});
  const Json& warnings = summary["warnings"];
  const auto found = std::ranges::find(warnings, "no_order", [](const Json& warning) { return warning["code"]; });
  ASSERT_NE(found, warnings.end());
  EXPECT_EQ((*found)["message"],
            "the column date of 2 runs is neither a number nor a date such as 2026-03-01, for example \"03.03.2026\"; "
            "trends leave these runs out");
  EXPECT_THAT(WarningsOf(SummaryOf(store)), testing::Not(testing::Contains("no_order")));
}

TEST_F(SummaryTest, WarnsOfEarlierManifestsAndDuplicateSwings) {
  const auto make = [](std::size_t i) {
    RunOutcome outcome = OutcomeOf({FitOf("viscous", 10)});
    outcome.provenance.data_sha256 = i < 2 ? "same" : "other " + std::to_string(i);
    return outcome;
  };
  Store store = StoreOf(PlainManifest(4), make);
  EXPECT_THAT(WarningsOf(SummaryOf(store)), ElementsAre("same_data"));
  Store shorter = StoreOf(PlainManifest(3), make);  // the same file with fewer runs
  const Json summary = SummaryOf(shorter);
  EXPECT_THAT(WarningsOf(summary), ElementsAre("not_in_the_manifest", "same_data"));
  EXPECT_EQ(summary["headline"]["text"],
            "3 of 3 recordings fitted; 1 more left out, not among the recordings of the last refit");
  EXPECT_EQ(summary["parameters"][0]["runs"], 3);
}

TEST_F(SummaryTest, LeavesFormerResultsOut) {
  Store store =
      StoreOf(PlainManifest(4), [](std::size_t i) { return OutcomeOf({FitOf("viscous", i == 0 ? 100 : 10)}); });
  RunOutcome failure = FailureOf({"run0.csv", "there is no such file; check the path"}, 3);
  ASSERT_EQ(store.PutUnlessWorse("run0.csv", failure, "inputs", nullptr).value(), failure.reason.text());
  const Json summary = SummaryOf(store);
  EXPECT_EQ(summary["headline"]["text"], "3 of 4 recordings fitted; 1 with a former result only");
  EXPECT_EQ(summary["headline"]["stale_runs"][0]["reason"], "there is no such file; check the path");
  EXPECT_EQ(summary["parameters"][0]["runs"], 3);
  EXPECT_EQ(summary["parameters"][0]["median"], 10);
  EXPECT_THAT(WarningsOf(summary), testing::Contains("stale"));
}

// ---- What is taken for one pendulum --------------------------------------------------------------------------------

TEST_F(SummaryTest, CountsMissingAndRefusedRecordingsFirst) {
  Store store = StoreOf(PlainManifest(6), [](std::size_t i) -> std::optional<RunOutcome> {
    if (i == 0) return FailureOf({"run0.csv", "there is no such file; check the path"}, 3);
    if (i == 1) return FailureOf({"rig.json", "there is no such file; check the path"}, 3);  // the recording exists
    if (i == 2) return FailureOf({"run2.csv", "no swing"}, 5);
    if (i == 3) return std::nullopt;
    RunOutcome outcome = OutcomeOf({FitOf("viscous", 10, i == 4 ? "not_converged" : "converged")});
    outcome.exit_code = i == 4 ? 1 : 0;
    return outcome;
  });
  const Json headline = SummaryOf(store)["headline"];
  EXPECT_EQ(headline["text"],
            "1 of 6 recordings fitted; 1 missing, 1 with a missing rig or calibration, 1 refused, 1 not "
            "converged, 1 not fitted yet; the last refit is not complete");
  EXPECT_EQ(headline["missing_runs"][0]["id"], "run0.csv");
  EXPECT_EQ(headline["refused_runs"][1]["reason"], "no swing");
}

TEST_F(SummaryTest, DoesNotCompareSimulatedPendulumsWithDifferentTruth) {
  const std::string manifest = ManifestOf(200, ",true_inertia,true_release_angle",
                                          [](std::size_t i) { return "," + std::to_string(10 + i) + ",0.4"; });
  Store store =
      StoreOf(manifest, [](std::size_t i) { return OutcomeOf({FitOf("viscous", 10 + static_cast<double>(i))}); });
  const Json summary = SummaryOf(store);
  EXPECT_EQ(summary["grouping"]["text"],
            "200 different pendulums (each has its own true values); repeatability needs several recordings of one.");
  EXPECT_EQ(summary["grouping"]["is_compared"], false);
  EXPECT_EQ(summary["verdicts"][0]["verdict"], "not_compared");
  EXPECT_EQ(ParameterOf(summary, "viscous", "inertia")["repeatability"], nullptr);
  EXPECT_EQ(ParameterOf(summary, "viscous", "inertia")["repeatability_reason"], "no pendulum has two recordings");
  EXPECT_EQ(SummaryOf(store, {"all", ""})["verdicts"][0]["verdict"], "too_small");  // the user says so
}

TEST_F(SummaryTest, EqualTruthIsOnePendulum) {
  Store store = StoreOf(ManifestOf(6, ",true_inertia", [](std::size_t) { return ",10"; }),
                        [](std::size_t i) { return OutcomeOf({FitOf("viscous", 10 + static_cast<double>(i % 2))}); });
  EXPECT_EQ(SummaryOf(store)["grouping"]["by"], "all");
}

// Inertias of 1, 2, 3, 4, 5 with errors of 0.001: median distance 1, so 1.48 / 3 = 49 %.
TEST_F(SummaryTest, ConcludesNothingIfRecordingsDifferGrosslyAndNothingSaysThatTheyAreOfOneRig) {
  const auto fit = [](std::size_t i) {
    return OutcomeOf({FitWithCovariance(static_cast<double>(i + 1), 0.001, 0.5, 0.1)});
  };
  Store store = StoreOf(PlainManifest(5), fit);
  const Json summary = SummaryOf(store);
  EXPECT_EQ(
      summary["grouping"]["text"],
      "The 5 recordings are not taken for one pendulum: their inertia scatters by 49 %, but between repeats of one "
      "pendulum by at most 2 %. So they are not compared, and nothing is concluded about their errors.");
  EXPECT_THAT(summary["grouping"]["otherwise"].get<std::string>(), HasSubstr("--group_by all"));
  EXPECT_EQ(summary["verdicts"][0]["verdict"], "not_compared");
  EXPECT_EQ(ParameterOf(summary, "viscous", "inertia")["repeatability"], nullptr);
  EXPECT_EQ(SummaryOf(store, {"all", ""})["verdicts"][0]["verdict"], "too_small");
}

TEST_F(SummaryTest, GroupsByColumnsThatNamePendulumsAndByFolders) {
  const auto fit = [](std::size_t i) { return OutcomeOf({FitOf("viscous", i % 2 == 0 ? 10 : 90)}); };
  Store named = StoreOf(ManifestOf(8, ",pendulum", [](std::size_t i) { return i % 2 == 0 ? ",A" : ",B"; }), fit);
  EXPECT_EQ(
      SummaryOf(named)["grouping"]["text"],
      "Recordings with the same value in the column pendulum are taken for repeats of one pendulum: 2 pendulums, 4 "
      "recordings each.");
  EXPECT_EQ(SummaryOf(named, {"all", ""})["grouping"]["pendulums"], 1);
  fs::remove(folder_ / "store.sqlite");
  std::string text = "path\n";
  for (std::size_t i = 0; i < 8; ++i) text += std::string(i % 2 == 0 ? "a" : "b") + "/" + std::to_string(i) + ".csv\n";
  Store folders = StoreOf(text, fit);
  EXPECT_EQ(SummaryOf(folders)["grouping"]["by"], "folder");
  EXPECT_EQ(SummaryOf(folders)["grouping"]["pendulums"], 2);
}

// Without a rig, the inertia is in units of the restoring torque.
TEST_F(SummaryTest, NeverComparesARecordingWithoutARigWithThoseThatHaveOne) {
  const auto fit = [](std::size_t i) {
    Json fit = FitWithCovariance(i == 0 ? 0.5 : 10 + 0.1 * static_cast<double>(i), 1, 5, 0.1);
    if (i == 0) fit["parameters"]["inertia"]["unit"] = "s^2";
    RunOutcome outcome = OutcomeOf({fit});
    outcome.provenance.rig_sha256 = i == 0 ? "" : "1234";
    return outcome;
  };
  Store store = StoreOf(ManifestOf(5, ",rig", [](std::size_t i) { return i == 0 ? "," : ",rig.json"; }), fit);
  for (const char* group_by : {"", "all"}) {
    const Json summary = SummaryOf(store, {group_by, ""});
    const auto text = summary["grouping"]["text"].get<std::string>();
    EXPECT_THAT(text, HasSubstr(" One recording has no rig, so its values have other units; it is not compared with"));
    EXPECT_THAT(text, testing::Not(HasSubstr("they have the same rig file")));
    EXPECT_EQ(summary["grouping"]["unlike"], 0);
    EXPECT_EQ(summary["agreement"]["rows"][0]["runs"], 4);
    EXPECT_THAT(summary["agreement"]["rows"][0]["outliers"], IsEmpty());
  }
  EXPECT_THAT(
      SummaryOf(store)["grouping"]["text"].get<std::string>(),
      StartsWith("Recordings with the same rig file are taken for repeats of one pendulum: 2 pendulums, 1 to 4 "));
}

/// Two runs of inertia 10 and 10 + `distance` with standard errors of 1.
std::vector<Json> TwoFits(double distance) {
  return {FitWithCovariance(10, 1, 5, 0.1), FitWithCovariance(10 + distance, 1, 5, 0.1)};
}

// An interval of ± 4 standard errors, from few effective samples, is 4 / 1.96 times as wide as a normal one.
TEST_F(SummaryTest, ComparesRepeatsWithTheErrorsThatCanMakeThemDiffer) {
  std::vector<Json> fits = TwoFits(6);
  const double wide = 4 / 1.959963984540054, inconstancy = 3;
  for (Json& fit : fits) {
    Json& inertia = fit["parameters"]["inertia"];
    const double estimate = inertia["estimate"].get<double>();
    inertia["interval95"] = {estimate - 4, estimate + 4};
    inertia["systematic_std_error"] = 5;
    inertia["error_budget"] = {{"noise", 1}, {"rig", 4}, {"inconstancy", inconstancy}};  // the rig is common
    fit["systematic_covariance"] = {{"names", {"inertia"}}, {"matrix", {{25}}}};
  }
  Store store = StoreOf(PlainManifest(2), [&](std::size_t i) { return OutcomeOf({fits[i]}); });
  const Json summary = SummaryOf(store);
  const Json& inertia = ParameterOf(summary, "viscous", "inertia");
  const double variance = wide * wide + inconstancy * inconstancy;
  EXPECT_NEAR(inertia["repeatability"]["chi2"].get<double>(), 2 * 9 / variance, 1e-9);
  EXPECT_NEAR(summary["agreement"]["rows"][0]["statistic"].get<double>(), 2 * 9 / variance, 1e-9);
  EXPECT_EQ(inertia["median_std_error"], 1);
  EXPECT_NEAR(inertia["median_repeat_error"].get<double>(), std::sqrt(variance), 1e-12);
}

TEST_F(SummaryTest, AddsTheErrorsOfClocksThatDiffer) {
  for (const double other_clock : {1.0, 1.5}) {
    std::vector<Json> fits = TwoFits(6);
    for (Json& fit : fits) {
      fit["parameters"]["inertia"]["error_budget"] = {{"noise", 1}, {"clock", 2}};
      fit["systematic_covariance"] = {{"names", {"inertia"}}, {"matrix", {{4}}}};
    }
    fs::remove(folder_ / "store.sqlite");
    Store store = StoreOf(PlainManifest(2), [&](std::size_t i) {
      RunOutcome outcome = OutcomeOf({fits[i]});
      outcome.result["recordings"][0]["clock_scale"] = i == 0 ? 1 : other_clock;
      return outcome;
    });
    const Json summary = SummaryOf(store);
    const double chi2 = 2 * 9 / (other_clock == 1 ? 1.0 : 5.0);
    EXPECT_NEAR(ParameterOf(summary, "viscous", "inertia")["repeatability"]["chi2"].get<double>(), chi2, 1e-9);
    EXPECT_NEAR(summary["agreement"]["rows"][0]["statistic"].get<double>(), chi2, 1e-9);
  }
}

// Four different pendulums recommend viscous; the only repeats recommend coulomb.
TEST_F(SummaryTest, ConcludesFromTheLawOfTheRepeats) {
  const std::string manifest =
      ManifestOf(7, ",pendulum", [](std::size_t i) { return i < 4 ? "," + std::to_string(i) : std::string(",same"); });
  Store store = StoreOf(manifest, [](std::size_t i) {
    return OutcomeOf({FitOf("viscous", 10), FitOf("coulomb", 10)}, i < 4 ? "viscous" : "coulomb");
  });
  EXPECT_EQ(SummaryOf(store)["main_model"], "coulomb");
}

TEST_F(SummaryTest, SaysInHowManyParametersRepeatsDiffer) {
  Store store = StoreOf(PlainManifest(10), [](std::size_t i) {
    return OutcomeOf({FitWithCovariance(10 + (i % 2 == 0 ? 1 : -1), 0.3, 5, 0.1)});
  });
  EXPECT_EQ(
      SummaryOf(store, {"all", ""})["verdicts"][0]["text"],  // √(10 / 9) / 0.3
      "Under the law viscous, repeats differ by more than their errors in 1 of 2 parameters: inertia scatters 3.51 "
      "times as much as its errors predict. Either the pendulum changed or the errors are too small.");
}

TEST_F(SummaryTest, DoesNotTestTheAgreementIfNobodyAsks) {
  Store store = StoreOf(PlainManifest(4),
                        [](std::size_t i) { return OutcomeOf({FitWithCovariance(i == 3 ? 10.3 : 10, 0.05, 5, 0.1)}); });
  SummaryOptions options;
  options.without_agreement = true;
  EXPECT_TRUE(SummaryOf(store, options)["agreement"].is_null());
}

// χ² by hand: inertia 10, 10, 10, 10.3: the mean is 10.075. The friction is equal, so its χ² is 0.
TEST_F(SummaryTest, NamesTheRecordingThatAJointFitNames) {
  Store store = StoreOf(PlainManifest(4),
                        [](std::size_t i) { return OutcomeOf({FitWithCovariance(i == 3 ? 10.3 : 10, 0.05, 5, 0.1)}); });
  const Json agreement = SummaryOf(store)["agreement"];
  ASSERT_TRUE(agreement.is_object());
  const Json& row = agreement["rows"][0];
  EXPECT_EQ(row["dof"], 6);
  EXPECT_NEAR(row["statistic"].get<double>(), (3 * 0.075 * 0.075 + 0.225 * 0.225) / (0.05 * 0.05), 1e-6);
  ASSERT_THAT(row["outliers"], SizeIs(1));
  EXPECT_EQ(row["outliers"][0]["id"], "run3.csv");
  EXPECT_EQ(row["outliers"][0]["parameter"], "inertia");
  // The median is 10, and three of four runs are at it, so the run's own error is the scale.
  EXPECT_NEAR(row["outliers"][0]["z"].get<double>(), 0.3 / 0.05, 1e-9);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

TEST_F(SummaryTest, RefusesAnUnknownColumn) {
  Store store = StoreOf(ManifestOf(2, ",rig,place,date", [](std::size_t) { return ",,here,2026-01-01"; }),
                        [](std::size_t) { return OutcomeOf({FitOf("viscous", 10)}); });
  for (const auto& [options, flag] :
       {std::pair{SummaryOptions{"room", ""}, "--group_by"}, std::pair{SummaryOptions{"", "room"}, "--trend_by"}}) {
    const auto summary = Summarize(store, options);
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, StatusCode::kInvalidArgument);
    EXPECT_EQ(summary.error().message(), std::string(flag) + ": the manifest has no column 'room'; it has date, place");
  }
}

TEST_F(SummaryTest, RefusesAStoreWithoutResults) {
  Store store = StoreOf(PlainManifest(2), [](std::size_t) { return std::nullopt; });
  const auto summary = Summarize(store, {});
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(summary.error().message(), (folder_ / "store.sqlite").string() + ": no run has a fit; refit some first");
}

}  // namespace
}  // namespace pendulum::summary_test
