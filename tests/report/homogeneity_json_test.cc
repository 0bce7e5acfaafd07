// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/joint_json.h"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/json.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::joint_json_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> Keys(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

Json HomogeneityOf(const Identification& report) { return JointFitJson(report, 0)["homogeneity"]; }

// tests/tools/result_schema_test.py checks the tool's output with the schema.
TEST(ToJson, HasArraysOfRecordingsForAJointFit) {
  const Json json = ToJson(ExampleJointIdentification());
  EXPECT_THAT(Keys(json), ElementsAre("schema_version", "tool", "data", "rig", "calibration", "fits", "comparison",
                                      "closed_forms", "warnings", "reason"));
  ASSERT_EQ(json["data"].size(), 2);
  EXPECT_EQ(json["data"][0]["path"], "run.csv");
  EXPECT_EQ(json["data"][1]["path"], "b c.csv");
  EXPECT_EQ(json["data"][0]["start"], "release");
  EXPECT_EQ(json["data"][1]["start"], "moving");
  EXPECT_EQ(json["calibration"].dump(), R"([null,{"schema_version":1}])");
  ASSERT_EQ(json["closed_forms"].size(), 2);
  EXPECT_EQ(json["closed_forms"][0]["turning_points"], 5);
  EXPECT_TRUE(json["closed_forms"][1].is_null());
  EXPECT_EQ(json["fits"][0], JointFitJson(ExampleJointIdentification(), 0));
}

TEST(ToJson, NamesTheRecordingWithoutClosedForms) {
  Identification report = ExampleJointIdentification();
  EXPECT_EQ(ToJson(report)["reason"], "recording 2 (b c.csv): only 2 turning points can be located");
  report.runs[0].closed_forms.reset();
  report.runs[0].no_closed_forms = "undersampled";
  report.runs[1].data.path.clear();
  EXPECT_EQ(ToJson(report)["reason"],
            "recording 1 (run.csv): undersampled; recording 2: only 2 turning points can be located");
  report.runs = {ExampleIdentification(), ExampleIdentification()};
  EXPECT_FALSE(ToJson(report).contains("reason"));
}

TEST(ToJson, NamesTheRecordingOfAJointFitsWarning) {
  const Json warnings = ToJson(ExampleJointIdentification())["warnings"];
  ASSERT_EQ(warnings.size(), 2);
  EXPECT_EQ(warnings[0]["message"], "recording 1 (run.csv): there is a gap of 0.5 s after 7 s");
  EXPECT_EQ(warnings[1]["code"], "lack_of_fit");
  EXPECT_THAT(warnings[1]["message"].get<std::string>(), HasSubstr("recording 1 (run.csv): "));
}

TEST(JointFitJson, KeepsTheOrderOfKeys) {
  const Json fit = JointFitJson(ExampleJointIdentification(), 0);
  EXPECT_THAT(Keys(fit), ElementsAre("model", "status", "reason", "equation", "shared", "parameters", "derived",
                                     "covariance", "correlation", "systematic_covariance", "std_error_method",
                                     "interval_method", "identifiability", "statistics", "homogeneity", "rig_verdict",
                                     "ambiguities", "runs", "solver", "summary"));
  EXPECT_THAT(Keys(fit["parameters"]), ElementsAre("inertia", "viscous", "coulomb"));
  EXPECT_EQ(fit["shared"].dump(), R"(["inertia","viscous","coulomb"])");
  EXPECT_EQ(fit["correlation"].dump(), R"({"names":["inertia","viscous"],"matrix":[[1.0,0.5],[0.5,1.0]]})");
}

TEST(JointFitJson, ShowsEachRecordingAsJointlyFitted) {
  const Json runs = JointFitJson(ExampleJointIdentification(), 0)["runs"];
  ASSERT_EQ(runs.size(), 2);
  EXPECT_THAT(Keys(runs[0]), ElementsAre("path", "release", "amplitude_rad", "parameters", "covariance", "correlation",
                                         "systematic_covariance", "noise", "std_error_method", "identifiability",
                                         "statistics", "closed_form", "constancy", "separate"));
  EXPECT_EQ(runs[0]["path"], "run.csv");
  EXPECT_EQ(runs[0]["amplitude_rad"], 0.25);
  EXPECT_EQ(runs[0]["closed_form"].size(), 3);
  EXPECT_EQ(runs[0]["separate"], "converged");
  EXPECT_EQ(runs[1]["path"], "b c.csv");
  EXPECT_THAT(Keys(runs[1]["parameters"]), ElementsAre("inertia", "viscous", "coulomb", "initial_angle", "zero_angle"));
  EXPECT_EQ(runs[1]["separate"], "not_converged: too few iterations");
}

TEST(JointFitJson, ReportsALackOfFitPerRecording) {
  Identification report = ExampleJointIdentification();
  report.runs[1].data.path.clear();
  report.runs[1].data.release = 0;
  const Json run = JointFitJson(report, 0)["runs"][1];
  EXPECT_TRUE(run["path"].is_null());
  EXPECT_TRUE(run["release"].is_null());
  EXPECT_EQ(run["closed_form"], Json::array());
  EXPECT_TRUE(run["constancy"].is_null());
  EXPECT_EQ(run["constancy_reason"], "it was not tested");
}

// ExampleSharedInertia contains these numbers and their calculation.
TEST(JointFitJson, ReportsSeparateEstimates) {
  const Json inertia = HomogeneityOf(ExampleJointIdentification())["parameters"]["inertia"];
  EXPECT_EQ(
      inertia.dump(),
      R"({"unit":"kg m^2","statistic":0.16,"dof":1,"p":0.6892,"mean":0.078972,"std_error":0.00024,)"
      R"("random_effects":{"mean":0.078972,"std_error":0.00024,"interval95":[0.0759,0.082],)"
      R"("between_std_dev":0.0,"between_interval95":[0.0,0.005]},)"
      R"("runs":[{"estimate":0.0789,"std_error":0.0003,"z":-0.4},{"estimate":0.0791,"std_error":0.0004,"z":0.4}]})");
}

TEST(JointFitJson, ReportsAnUninformativeRecording) {
  Identification report = ExampleJointIdentification();
  std::vector<RunEstimate>& runs = report.joint[0].homogeneity.parameters[0].runs;
  runs[0] = {};
  runs[1].z.reset();
  const Json json = HomogeneityOf(report)["parameters"]["inertia"]["runs"];
  EXPECT_EQ(json[0].dump(),
            R"({"estimate":null,"std_error":null,"z":null,)"
            R"("reason":"the recording on its own does not determine it; no other recording determines it"})");
  EXPECT_EQ(json[1].dump(),
            R"({"estimate":0.0791,"std_error":0.0004,"z":null,"reason":"no other recording determines it"})");
}

TEST(JointFitJson, NumbersDisagreeingRecordingsFromOne) {
  Identification report = ExampleJointIdentification();
  EXPECT_EQ(HomogeneityOf(report)["agrees"], true);
  EXPECT_EQ(HomogeneityOf(report)["outliers"], Json::array());
  report.joint[0].homogeneity.p = 0.0099;  // recordings disagree below 0.01
  report.joint[0].homogeneity.disagreeing = {1};
  EXPECT_EQ(HomogeneityOf(report)["agrees"], false);
  EXPECT_EQ(HomogeneityOf(report)["outliers"].dump(), "[2]");
}

TEST(JointFitJson, HasNoStatisticWithoutATest) {
  Identification report = ExampleJointIdentification();
  Homogeneity& homogeneity = report.joint[0].homogeneity;
  homogeneity = {};
  homogeneity.amplitudes = {0.25, 0.125};
  homogeneity.reason = "all shared parameters are fixed";
  homogeneity.verdict = "not tested: all shared parameters are fixed";
  EXPECT_EQ(HomogeneityOf(report).dump(),
            R"({"statistic":null,"dof":0,"p":null,"agrees":null,"outliers":[],)"
            R"("verdict":"not tested: all shared parameters are fixed","parameters":{},"amplitude_dependence":[],)"
            R"("reason":"all shared parameters are fixed"})");
}

TEST(JointFitJson, ReportsAmplitudeDependence) {
  EXPECT_EQ(HomogeneityOf(ExampleJointIdentification())["amplitude_dependence"].dump(),
            R"([{"parameter":"inertia","slope":0.0125,"std_error":0.005,"unit":"kg m^2 / rad^2","p":0.25,)"
            R"("span":0.0078125,"p_of_remainder":0.75}])");
}

TEST(JointFitJson, HasAnRmsOnlyIfTheReadingsHaveOneUnit) {
  Identification report = ExampleJointIdentification();
  EXPECT_EQ(JointFitJson(report, 0)["statistics"].dump(),
            R"({"rms_residual_rad":0.00349,"log_likelihood":1234.5,"aic":-2457.0,"aicc":-2456.875,"bic":-2437.5,)"
            R"("effective_samples":1200.25})");
  report.data.unit = "sigma";  // readings of different units
  EXPECT_THAT(Keys(JointFitJson(report, 0)["statistics"]),
              ElementsAre("log_likelihood", "aic", "aicc", "bic", "effective_samples"));
}

TEST(ToJson, ComparesResidualsInSigmasIfUnitsDiffer) {
  Identification report = ExampleComparedJointIdentification();
  EXPECT_EQ(ToJson(report)["comparison"]["rows"][0]["rms_residual_rad"], 0.00349);
  report.data.unit = "sigma";
  const Json row = ToJson(report)["comparison"]["rows"][0];
  EXPECT_EQ(row["rms_residual_sigma"], 0.00349);
  EXPECT_EQ(row["cross_validation"]["rms_sigma"], 0.0035);
}

TEST(JointFitJson, WritesAnEquationIfAllParametersAreShared) {
  Identification report = ExampleJointIdentification();
  EXPECT_THAT(JointFitJson(report, 0)["equation"].get<std::string>(), HasSubstr("0.07900 th''"));
  report.joint[0].shared = {"inertia", "viscous"};
  EXPECT_TRUE(JointFitJson(report, 0)["equation"].is_null());
}

TEST(JointFitJson, HasNoNumbersOfAFailedFit) {
  const Json fit = JointFitJson(ExampleFailedJointIdentification(), 0);
  EXPECT_EQ(fit["status"], "failed");
  for (const char* key : {"equation", "statistics", "std_error_method", "interval_method"}) {
    EXPECT_TRUE(fit[key].is_null()) << key;
  }
  for (const char* key : {"statistics", "noise"}) EXPECT_TRUE(fit["runs"][1][key].is_null()) << key;
  EXPECT_EQ(fit["runs"][1]["parameters"]["inertia"]["reason"], "the fit failed");
}

// dump() would write null for each of these numbers, too, but without a reason.
TEST(JointFitJson, ExplainsNonFiniteNumbers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Identification report = ExampleJointIdentification();
  Homogeneity& homogeneity = report.joint[0].homogeneity;
  homogeneity.amplitude_dependence[0].span = kNan;
  homogeneity.parameters[0].scatter.between = std::numeric_limits<double>::infinity();
  homogeneity.parameters[0].statistic = kNan;
  homogeneity.amplitudes[1] = kNan;
  const Json fit = JointFitJson(report, 0);
  const Json& parameter = fit["homogeneity"]["parameters"]["inertia"];
  EXPECT_EQ(fit["homogeneity"]["amplitude_dependence"][0]["reason"], "span is not a finite number");
  EXPECT_EQ(parameter["random_effects"]["reason"], "between_std_dev is not a finite number");
  EXPECT_EQ(parameter["reason"], "statistic is not a finite number");
  EXPECT_TRUE(fit["runs"][1]["amplitude_rad"].is_null());
  EXPECT_THAT(fit.dump(), Not(HasSubstr("nan")));
}

// The page shows the warnings of each recording, and those of the whole.
TEST(ToJson, SaysWhichRecordingsAWarningIsAbout) {
  Identification report = ExampleJointIdentification();
  report.fits[0].warnings = {{"recordings_disagree", "they do not agree"}};
  report.runs[1].warnings = report.runs[0].warnings;
  const Json warnings = ToJson(report)["warnings"];
  ASSERT_EQ(warnings.size(), 3);
  EXPECT_EQ(warnings[0]["recordings"], Json::array());
  EXPECT_EQ(warnings[1]["code"], "gaps");
  EXPECT_EQ(warnings[1]["recordings"], Json::array({1, 2}));
  EXPECT_EQ(warnings[2]["code"], "lack_of_fit");
  EXPECT_EQ(warnings[2]["recordings"], Json::array({1}));
}

}  // namespace
}  // namespace pendulum::joint_json_test
