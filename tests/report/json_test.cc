// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json.h"

#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/version.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::json_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> Keys(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

std::string FileText(const char* path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The example was written by hand from the design and the schema; tests/tools/result_schema_test.py validates it.
TEST(ToJsonText, MatchesTheExampleByteForByte) {
  EXPECT_EQ(ToJsonText(ExampleComparedIdentification()), FileText("tests/report/result_example.json"));
}

// The page shows the warnings of each law below its name.
TEST(ToJson, NamesTheLawOfAWarningThatHoldsForOneAlone) {
  Identification identification = ExampleComparedIdentification();
  identification.fits[0].warnings.clear();
  identification.fits[1].warnings = {{.code = "at_bound",
                                      .finding = "drag is at its bound 0",
                                      .advice = "widen --bounds",
                                      .flags = {"bounds"},
                                      .about = {.parameters = {"drag"}}}};
  const Json warning = ToJson(identification)["warnings"].back();
  EXPECT_EQ(warning["law"], "drag");
  EXPECT_EQ(warning["message"], "drag: drag is at its bound 0; widen --bounds");
  EXPECT_EQ(warning["text"], "drag is at its bound 0; widen --bounds");
  EXPECT_EQ(warning["flags"], Json::array({"bounds"}));
  EXPECT_EQ(warning["parameters"], Json::array({"drag"}));
}

// tests/tools/result_schema_test.py checks the tool's output with the schema.
TEST(ToJson, KeepsTheOrderOfKeysForOneRecordingAndForSeveral) {
  for (const Identification& report : {ExampleIdentification(), ExampleJointIdentification()}) {
    const Json json = ToJson(report);
    EXPECT_THAT(Keys(json),
                ElementsAre("schema_version", "tool", "rig", "recordings", "fits", "comparison", "warnings"));
    EXPECT_EQ(json["tool"]["version"], kVersion);
    EXPECT_THAT(
        Keys(json["recordings"][0]),
        ElementsAre("path", "sha256", "samples", "used_samples", "duration_s", "sample_rate_hz", "resolution_rad",
                    "resolution_source", "clock_scale", "clock_scale_std_dev", "sensor", "window_s", "window_reason",
                    "left_out", "releases", "release", "start", "sampling", "calibration", "closed_forms", "fits"));
    EXPECT_THAT(Keys(json["recordings"][0]["fits"][0]),
                ElementsAre("model", "amplitude_rad", "parameters", "covariance", "correlation",
                            "systematic_covariance", "std_error_method", "identifiability", "noise", "statistics",
                            "closed_form", "constancy", "suspicions", "separate"));
    EXPECT_THAT(
        Keys(json["fits"][0]),
        ElementsAre("model", "status", "reason", "equation", "shared", "parameters", "derived", "covariance",
                    "correlation", "systematic_covariance", "budget", "std_error_method", "interval_method",
                    "identifiability", "statistics", "homogeneity", "rig_verdict", "ambiguities", "solver", "summary"));
  }
}

TEST(ToJson, SeparatesWhatIsSharedFromWhatARecordingHasForItself) {
  for (const Identification& report : {ExampleIdentification(), ExampleJointIdentification()}) {
    const Json json = ToJson(report);
    const Json& fit = json["fits"][0];
    const Json& own = json["recordings"][0]["fits"][0];
    EXPECT_EQ(fit["shared"].dump(), R"(["inertia","viscous","coulomb"])");
    EXPECT_THAT(Keys(fit["parameters"]), ElementsAre("inertia", "viscous", "coulomb"));
    EXPECT_EQ(fit["correlation"].dump(), R"({"names":["inertia","viscous"],"matrix":[[1.0,0.5],[0.5,1.0]]})");
    EXPECT_EQ(fit["identifiability"].size(), 3);
    EXPECT_THAT(Keys(own["parameters"]), ElementsAre("release_angle", "zero_angle"));
    EXPECT_EQ(own["covariance"]["names"].dump(), R"(["inertia","viscous","release_angle"])");
    EXPECT_EQ(own["identifiability"].size(), 1);
    EXPECT_EQ(own["amplitude_rad"], 0.25);
    EXPECT_EQ(own["separate"], "converged");
  }
}

TEST(ToJson, ListsTheRecordingsInTheirOrder) {
  const Json recordings = ToJson(ExampleJointIdentification())["recordings"];
  ASSERT_EQ(recordings.size(), 2);
  EXPECT_EQ(recordings[0]["path"], "run.csv");
  EXPECT_EQ(recordings[1]["path"], "b c.csv");
  EXPECT_EQ(recordings[0]["start"], "release");
  EXPECT_EQ(recordings[1]["start"], "moving");
  EXPECT_TRUE(recordings[0]["calibration"].is_null());
  EXPECT_EQ(recordings[1]["calibration"].dump(), R"({"schema_version":1})");
  EXPECT_EQ(recordings[0]["closed_forms"]["turning_points"], 5);
  EXPECT_EQ(recordings[0]["fits"][0]["closed_form"].size(), 3);
  EXPECT_THAT(Keys(recordings[1]["fits"][0]["parameters"]), ElementsAre("initial_angle", "zero_angle"));
  EXPECT_EQ(recordings[1]["fits"][0]["amplitude_rad"], 0.125);
  EXPECT_EQ(recordings[1]["fits"][0]["closed_form"], Json::array());
  EXPECT_EQ(recordings[1]["fits"][0]["separate"], "not_converged: too few iterations");
}

TEST(ToJson, HasHomogeneityForSeveralRecordingsOnly) {
  EXPECT_TRUE(ToJson(ExampleIdentification())["fits"][0]["homogeneity"].is_null());
  EXPECT_EQ(ToJson(ExampleJointIdentification())["fits"][0]["homogeneity"]["dof"], 2);
}

TEST(ToJson, HasNullForAnUnknownAmplitude) {
  Identification report = ExampleIdentification();
  report.across[0].amplitudes[0] = kNan;
  EXPECT_TRUE(ToJson(report)["recordings"][0]["fits"][0]["amplitude_rad"].is_null());
}

TEST(ToJson, WorksWithoutAFit) {
  Identification report = ExampleIdentification();
  report.fits.clear();
  report.across.clear();
  report.recordings.front().checks.clear();
  const Json json = ToJson(report);
  EXPECT_EQ(json["fits"], Json::array());
  EXPECT_EQ(json["recordings"][0]["fits"], Json::array());
  EXPECT_TRUE(json["recordings"][0]["start"].is_null());
  EXPECT_EQ(json["recordings"][0]["closed_forms"]["turning_points"], 5);
}

TEST(ToJson, HasNullForTheReleaseOfAGivenWindow) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.release = 2;
  EXPECT_EQ(ToJson(report)["recordings"][0]["release"], 2);
  report.recordings.front().data.release = 0;
  EXPECT_TRUE(ToJson(report)["recordings"][0]["release"].is_null());
}

TEST(ToJson, SaysWhatTheWindowLeavesOut) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.left_out = LeftOut{12, 47, true, 1.8};
  EXPECT_EQ(ToJson(report)["recordings"][0]["left_out"],
            Json({{"half_swings", 12}, {"of", 47}, {"includes_largest", true}, {"larger_errors", 1.8}}));
}

TEST(ToJson, ExplainsMissingClosedForms) {
  const Json recording = ToJson(ExampleRateIdentification())["recordings"][0];
  EXPECT_TRUE(recording["closed_forms"].is_null());
  EXPECT_EQ(recording["reason"], "only 2 turning points can be located");
  EXPECT_EQ(recording["fits"][0]["closed_form"], Json::array());
  EXPECT_TRUE(recording["sampling"].is_null());
  const Json recordings = ToJson(ExampleJointIdentification())["recordings"];
  EXPECT_FALSE(recordings[0].contains("reason"));
  EXPECT_EQ(recordings[1]["reason"], "only 2 turning points can be located");
}

TEST(ToJson, ExplainsAMissingConstancyTest) {
  const Json own = ToJson(ExampleRateIdentification())["recordings"][0]["fits"][0];
  EXPECT_TRUE(own["constancy"].is_null());
  EXPECT_EQ(own["constancy_reason"], "the fit is not_converged");
  EXPECT_EQ(ToJson(ExampleJointIdentification())["recordings"][1]["fits"][0]["constancy_reason"], "it was not tested");
}

TEST(ToJson, HasNoComparisonForOneFit) {
  EXPECT_TRUE(ToJson(ExampleIdentification())["comparison"].is_null());
  EXPECT_EQ(ToJson(ExampleComparedIdentification())["comparison"]["recommended"], "coulomb");
}

TEST(ToJson, ExplainsAMissingStandardError) {
  const Json json = ToJson(ExampleIdentification());
  const Json parameters = json["fits"][0]["parameters"], own = json["recordings"][0]["fits"][0]["parameters"];
  EXPECT_FALSE(parameters["inertia"].contains("reason"));
  EXPECT_TRUE(parameters["coulomb"]["std_error"].is_null());
  EXPECT_EQ(parameters["coulomb"]["reason"], "the estimate is at its lower bound 0");
  EXPECT_EQ(parameters["coulomb"]["interval95"], Json::array({0.0, 0.000125}));
  EXPECT_EQ(own["zero_angle"]["fixed"], true);
  EXPECT_TRUE(own["zero_angle"]["interval95"].is_null());
}

TEST(ToJson, HasNoSystematicErrorWithoutAnUncertainRig) {
  const Json parameters = ToJson(ExampleIdentification())["fits"][0]["parameters"];
  EXPECT_EQ(parameters["inertia"]["systematic_std_error"], 0.001);
  EXPECT_TRUE(parameters["viscous"]["systematic_std_error"].is_null());
}

TEST(ToJson, ExplainsAnOpenInterval) {
  Identification report = ExampleIdentification();
  ParameterEstimate& viscous = report.fits[0].parameters[1];
  viscous.lower95.reset();
  viscous.open_interval = OpenInterval::kNothingExcluded;
  const Json json = ToJson(report)["fits"][0]["parameters"]["viscous"];
  EXPECT_EQ(json["interval95"], Json::array({nullptr, 0.004}));
  EXPECT_EQ(json["reason"], "the interval is open: the data exclude none of its possible values");
}

TEST(ToJson, GivesEachEndOfDerivedIntervals) {
  Identification report = ExampleIdentification();
  report.fits[0].derived[1].upper95 = 0.005;
  const Json derived = ToJson(report)["fits"][0]["derived"];
  EXPECT_EQ(derived["natural_frequency"]["interval95"], Json::array({4.763, 4.793}));
  EXPECT_EQ(derived["damping_ratio"]["interval95"], Json::array({nullptr, 0.005}));
}

TEST(ToJson, NamesTheNoiseFamily) {
  Identification report = ExampleIdentification();
  const std::pair<NoiseFamily, const char*> named[] = {
      {NoiseFamily::kGaussian, "gaussian"}, {NoiseFamily::kQuantized, "quantized"},
      {NoiseFamily::kHuber, "huber"},       {NoiseFamily::kStudent, "student"},
      {NoiseFamily::kEdges, "edges"},       {NoiseFamily::kAveraged, "averaged"}};
  for (const auto& [family, name] : named) {
    report.fits[0].noise.family = family;
    EXPECT_EQ(ToJson(report)["recordings"][0]["fits"][0]["noise"]["model"], name);
  }
  EXPECT_TRUE(ToJson(ExampleRateIdentification())["recordings"][0]["fits"][0]["noise"]["sigma_std_error"].is_null());
}

TEST(ToJson, ReportsTheSourceOfTheResolution) {
  EXPECT_EQ(ToJson(ExampleIdentification())["recordings"][0]["resolution_source"], "found");
  EXPECT_TRUE(ToJson(ExampleRateIdentification())["recordings"][0]["resolution_source"].is_null());
}

TEST(ToJson, UsesRateUnitsForARate) {
  const Json json = ToJson(ExampleRateIdentification());
  EXPECT_TRUE(json["rig"].is_null());
  EXPECT_TRUE(json["recordings"][0].contains("resolution_rad_s"));
  EXPECT_FALSE(json["recordings"][0].contains("resolution_rad"));
  EXPECT_EQ(json["recordings"][0]["fits"][0]["noise"]["sigma_rad_s"], 0.0035);
  EXPECT_EQ(json["fits"][0]["statistics"]["rms_residual_rad_s"], 0.00349);
  EXPECT_EQ(json["fits"][0]["parameters"]["inertia"]["unit"], "s^2");
}

TEST(ToJson, GivesEstimatesWithoutErrorsWhenNotConverged) {
  const Json fit = ToJson(ExampleRateIdentification())["fits"][0];
  EXPECT_EQ(fit["status"], "not_converged");
  EXPECT_EQ(fit["parameters"]["inertia"]["estimate"], 0.0439);
  EXPECT_EQ(fit["parameters"]["inertia"]["reason"], "the fit did not converge");
  EXPECT_EQ(fit["covariance"]["matrix"], Json::array());
  EXPECT_TRUE(fit["std_error_method"].is_null());
  EXPECT_TRUE(fit["interval_method"].is_null());
  EXPECT_EQ(fit["identifiability"], Json::array());
}

TEST(ToJson, OmitsNoiseAndStatisticsOfAFailedFit) {
  Identification report = ExampleRateIdentification();
  report.fits[0].termination = Termination::kFailed;
  const Json json = ToJson(report);
  EXPECT_TRUE(json["fits"][0]["statistics"].is_null());
  EXPECT_TRUE(json["recordings"][0]["fits"][0]["noise"].is_null());
  EXPECT_TRUE(json["recordings"][0]["fits"][0]["statistics"].is_null());
}

TEST(ToJson, WritesNonFiniteNumbersAsNullWithAReason) {
  Identification report = ExampleIdentification();
  FitReport& fit = report.fits[0];
  fit.statistics.aicc = std::numeric_limits<double>::infinity();
  fit.parameters[0].estimate = kNan;
  fit.parameters[1].upper95 = kNan;
  fit.covariance(0, 0) = kNan;
  const Json json = ToJson(report)["fits"][0];
  EXPECT_TRUE(json["statistics"]["aicc"].is_null());
  EXPECT_EQ(json["statistics"]["reason"], "aicc is not a finite number");
  EXPECT_TRUE(json["parameters"]["inertia"]["estimate"].is_null());
  EXPECT_EQ(json["parameters"]["inertia"]["reason"], "estimate is not a finite number");
  EXPECT_TRUE(json["parameters"]["viscous"]["interval95"][1].is_null());
  EXPECT_TRUE(json["covariance"]["matrix"][0][0].is_null());
  EXPECT_TRUE(json["correlation"]["matrix"][0][1].is_null());
}

TEST(ToJson, ReportsAMissingErrorOfADerivedQuantity) {
  const Json derived = ToJson(ExampleIdentification())["fits"][0]["derived"];
  EXPECT_EQ(derived["natural_frequency"]["std_error"], 0.0075);
  EXPECT_TRUE(derived["damping_ratio"]["std_error"].is_null());
  EXPECT_THAT(derived["damping_ratio"]["reason"], HasSubstr("no standard error"));
}

TEST(ToJson, OmitsFileDataForARecordingInMemory) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.path.clear();
  report.recordings.front().data.sha256.clear();
  const Json recording = ToJson(report)["recordings"][0];
  EXPECT_TRUE(recording["path"].is_null());
  EXPECT_TRUE(recording["sha256"].is_null());
}

TEST(ToJsonText, ReplacesInvalidUtf8) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.path = "w\xFCrfel.csv";
  const std::string text = ToJsonText(report);
  EXPECT_THAT(text, HasSubstr("w\xEF\xBF\xBDrfel.csv"));
  EXPECT_TRUE(Json::accept(text));
}

TEST(ToJson, NamesTheRecordingOfAJointFitsWarning) {
  const Json warnings = ToJson(ExampleJointIdentification())["warnings"];
  ASSERT_EQ(warnings.size(), 2);
  EXPECT_EQ(warnings[0]["message"], "recording 1 (run.csv): there is a gap of 0.5 s after 7 s");
  EXPECT_EQ(warnings[1]["code"], "lack_of_fit");
  EXPECT_THAT(warnings[1]["message"].get<std::string>(), HasSubstr("recording 1 (run.csv): "));
}

// The page shows the warnings of each recording, and those of the whole.
TEST(ToJson, SaysWhichRecordingsAWarningIsAbout) {
  Identification report = ExampleJointIdentification();
  report.fits[0].warnings = {{"recordings_disagree", "they do not agree"}};
  report.recordings[1].warnings = report.recordings[0].warnings;
  const Json warnings = ToJson(report)["warnings"];
  ASSERT_EQ(warnings.size(), 3);
  EXPECT_EQ(warnings[0]["recordings"], Json::array());
  EXPECT_EQ(warnings[1]["code"], "gaps");
  EXPECT_EQ(warnings[1]["recordings"], Json::array({1, 2}));
  EXPECT_EQ(warnings[2]["code"], "lack_of_fit");
  EXPECT_EQ(warnings[2]["recordings"], Json::array({1}));
}

TEST(ToJson, HasAnRmsOnlyIfTheReadingsHaveOneUnit) {
  Identification report = ExampleJointIdentification();
  EXPECT_EQ(ToJson(report)["fits"][0]["statistics"].dump(),
            R"({"rms_residual_rad":0.00349,"log_likelihood":1234.5,"aic":-2457.0,"aicc":-2456.875,"bic":-2437.5,)"
            R"("effective_samples":1200.25})");
  report.unit = "sigma";  // readings of different units
  EXPECT_THAT(Keys(ToJson(report)["fits"][0]["statistics"]),
              ElementsAre("log_likelihood", "aic", "aicc", "bic", "effective_samples"));
}

TEST(ToJson, ComparesResidualsInSigmasIfUnitsDiffer) {
  Identification report = ExampleComparedJointIdentification();
  EXPECT_EQ(ToJson(report)["comparison"]["rows"][0]["rms_residual_rad"], 0.00349);
  report.unit = "sigma";
  const Json row = ToJson(report)["comparison"]["rows"][0];
  EXPECT_EQ(row["rms_residual_sigma"], 0.00349);
  EXPECT_EQ(row["cross_validation"]["rms_sigma"], 0.0035);
}

TEST(ToJson, WritesAnEquationIfAllParametersAreShared) {
  Identification report = ExampleJointIdentification();
  EXPECT_THAT(ToJson(report)["fits"][0]["equation"].get<std::string>(), HasSubstr("0.07900 th''"));
  report.across[0].shared = {"inertia", "viscous"};
  EXPECT_TRUE(ToJson(report)["fits"][0]["equation"].is_null());
}

TEST(ToJson, HasNoNumbersOfAFailedFit) {
  const Json json = ToJson(ExampleFailedJointIdentification());
  const Json& fit = json["fits"][0];
  const Json& own = json["recordings"][1]["fits"][0];
  EXPECT_EQ(fit["status"], "failed");
  for (const char* key : {"equation", "statistics", "std_error_method", "interval_method"}) {
    EXPECT_TRUE(fit[key].is_null()) << key;
  }
  for (const char* key : {"statistics", "noise"}) EXPECT_TRUE(own[key].is_null()) << key;
  EXPECT_EQ(fit["parameters"]["inertia"]["reason"], "the fit failed");
  EXPECT_EQ(own["parameters"]["initial_angle"]["reason"], "the fit failed");
}

}  // namespace
}  // namespace pendulum::json_test
