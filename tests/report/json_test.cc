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
#include "tests/identify/example_identification.h"

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

TEST(ToJson, KeepsTheOrderOfKeys) {
  const Json json = ToJson(ExampleIdentification());
  EXPECT_THAT(Keys(json), ElementsAre("schema_version", "tool", "data", "rig", "calibration", "fits", "comparison",
                                      "closed_forms", "warnings"));
  EXPECT_THAT(Keys(json["fits"][0]),
              ElementsAre("model", "status", "reason", "equation", "parameters", "derived", "covariance", "correlation",
                          "noise", "systematic_covariance", "std_error_method", "interval_method", "identifiability",
                          "statistics", "closed_form", "constancy", "rig_verdict", "ambiguities", "suspicions",
                          "solver", "summary"));
  EXPECT_THAT(Keys(json["fits"][0]["parameters"]),
              ElementsAre("inertia", "viscous", "coulomb", "release_angle", "zero_angle"));
  EXPECT_EQ(json["tool"]["version"], kVersion);
}

TEST(ToJson, WorksWithoutAFit) {
  Identification report = ExampleIdentification();
  report.fits.clear();
  report.checks.clear();
  const Json json = ToJson(report);
  EXPECT_EQ(json["fits"], Json::array());
  EXPECT_TRUE(json["data"]["start"].is_null());
  EXPECT_EQ(json["closed_forms"]["turning_points"], 5);
}

TEST(ToJson, ExplainsMissingClosedForms) {
  const Json json = ToJson(ExampleRateIdentification());
  EXPECT_TRUE(json["closed_forms"].is_null());
  EXPECT_EQ(json["reason"], "only 2 turning points can be located");
  EXPECT_EQ(json["fits"][0]["closed_form"], Json::array());
  EXPECT_TRUE(json["data"]["sampling"].is_null());
  EXPECT_FALSE(ToJson(ExampleIdentification()).contains("reason"));
}

TEST(ToJson, ExplainsAMissingConstancyTest) {
  const Json fit = ToJson(ExampleRateIdentification())["fits"][0];
  EXPECT_TRUE(fit["constancy"].is_null());
  EXPECT_EQ(fit["constancy_reason"], "the fit is not_converged");
  EXPECT_FALSE(ToJson(ExampleIdentification())["fits"][0].contains("constancy_reason"));
}

TEST(ToJson, HasNoComparisonForOneFit) {
  EXPECT_TRUE(ToJson(ExampleIdentification())["comparison"].is_null());
  EXPECT_EQ(ToJson(ExampleComparedIdentification())["comparison"]["recommended"], "coulomb");
}

TEST(ToJson, ExplainsAMissingStandardError) {
  const Json parameters = ToJson(ExampleIdentification())["fits"][0]["parameters"];
  EXPECT_FALSE(parameters["inertia"].contains("reason"));
  EXPECT_TRUE(parameters["coulomb"]["std_error"].is_null());
  EXPECT_EQ(parameters["coulomb"]["reason"], "the estimate is at its lower bound 0");
  EXPECT_EQ(parameters["coulomb"]["interval95"], Json::array({0.0, 0.000125}));
  EXPECT_EQ(parameters["zero_angle"]["fixed"], true);
  EXPECT_TRUE(parameters["zero_angle"]["interval95"].is_null());
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
    EXPECT_EQ(ToJson(report)["fits"][0]["noise"]["model"], name);
  }
  EXPECT_TRUE(ToJson(ExampleRateIdentification())["fits"][0]["noise"]["sigma_std_error"].is_null());
}

TEST(ToJson, ReportsTheSourceOfTheResolution) {
  EXPECT_EQ(ToJson(ExampleIdentification())["data"]["resolution_source"], "found");
  EXPECT_TRUE(ToJson(ExampleRateIdentification())["data"]["resolution_source"].is_null());
}

TEST(ToJson, UsesRateUnitsForARate) {
  const Json json = ToJson(ExampleRateIdentification());
  EXPECT_TRUE(json["rig"].is_null());
  EXPECT_TRUE(json["data"].contains("resolution_rad_s"));
  EXPECT_FALSE(json["data"].contains("resolution_rad"));
  EXPECT_EQ(json["fits"][0]["noise"]["sigma_rad_s"], 0.0035);
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
  const Json fit = ToJson(report)["fits"][0];
  EXPECT_TRUE(fit["noise"].is_null());
  EXPECT_TRUE(fit["statistics"].is_null());
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
  report.data.path.clear();
  report.data.sha256.clear();
  const Json data = ToJson(report)["data"];
  EXPECT_TRUE(data["path"].is_null());
  EXPECT_TRUE(data["sha256"].is_null());
}

TEST(ToJsonText, ReplacesInvalidUtf8) {
  Identification report = ExampleIdentification();
  report.data.path = "w\xFCrfel.csv";
  const std::string text = ToJsonText(report);
  EXPECT_THAT(text, HasSubstr("w\xEF\xBF\xBDrfel.csv"));
  EXPECT_TRUE(Json::accept(text));
}

}  // namespace
}  // namespace pendulum::json_test
