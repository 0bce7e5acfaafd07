// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/homogeneity_json.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/identify/example_joint_identification.h"

namespace pendulum::homogeneity_json_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

Json HomogeneityOf(const Identification& report) { return HomogeneityJson(*report.across[0].homogeneity); }

// ExampleSharedInertia contains these numbers and their calculation.
TEST(HomogeneityJson, ReportsSeparateEstimates) {
  const Json inertia = HomogeneityOf(ExampleJointIdentification())["parameters"]["inertia"];
  EXPECT_EQ(
      inertia.dump(),
      R"({"unit":"kg m^2","statistic":0.16,"dof":1,"p":0.6892,"agrees":true,"mean":0.078972,"std_error":0.00024,)"
      R"("random_effects":{"mean":0.078972,"std_error":0.00024,"text":"0.07897 ± 0.00024","interval95":[0.0759,0.082],)"
      R"("between_std_dev":0.0,"between_interval95":[0.0,0.005]},)"
      R"("recordings":[{"estimate":0.0789,"std_error":0.0003,"text":"0.07890 ± 0.00030","z":-0.4},)"
      R"({"estimate":0.0791,"std_error":0.0004,"text":"0.0791 ± 0.0004","z":0.4}]})");
}

TEST(HomogeneityJson, ReportsAnUninformativeRecording) {
  Identification report = ExampleJointIdentification();
  std::vector<RunEstimate>& runs = report.across[0].homogeneity->parameters[0].runs;
  runs[0] = {};
  runs[1].z.reset();
  const Json json = HomogeneityOf(report)["parameters"]["inertia"]["recordings"];
  EXPECT_EQ(json[0].dump(),
            R"({"estimate":null,"std_error":null,"text":null,"z":null,)"
            R"("reason":"the recording on its own does not determine it; no other recording determines it"})");
  EXPECT_EQ(json[1].dump(), R"({"estimate":0.0791,"std_error":0.0004,"text":"0.0791 ± 0.0004","z":null,)"
                            R"("reason":"no other recording determines it"})");
}

TEST(HomogeneityJson, NumbersDisagreeingRecordingsFromOne) {
  Identification report = ExampleJointIdentification();
  EXPECT_EQ(HomogeneityOf(report)["agrees"], true);
  EXPECT_EQ(HomogeneityOf(report)["outliers"], Json::array());
  report.across[0].homogeneity->p = 0.0099;  // recordings disagree below 0.01
  report.across[0].homogeneity->disagreeing = {1};
  EXPECT_EQ(HomogeneityOf(report)["agrees"], false);
  EXPECT_EQ(HomogeneityOf(report)["outliers"].dump(), "[2]");
}

TEST(HomogeneityJson, HasNoStatisticWithoutATest) {
  Identification report = ExampleJointIdentification();
  Homogeneity& homogeneity = *report.across[0].homogeneity;
  homogeneity = {};
  homogeneity.amplitudes = {0.25, 0.125};
  homogeneity.reason = "all shared parameters are fixed";
  homogeneity.verdict = "not tested: all shared parameters are fixed";
  EXPECT_EQ(HomogeneityOf(report).dump(),
            R"({"statistic":null,"dof":0,"p":null,"agrees":null,"outliers":[],)"
            R"("verdict":"not tested: all shared parameters are fixed","parameters":{},"amplitude_dependence":[],)"
            R"("reason":"all shared parameters are fixed"})");
}

TEST(HomogeneityJson, ReportsAmplitudeDependence) {
  EXPECT_EQ(HomogeneityOf(ExampleJointIdentification())["amplitude_dependence"].dump(),
            R"([{"parameter":"inertia","slope":0.0125,"std_error":0.005,"unit":"kg m^2 / rad^2","p":0.25,)"
            R"("span":0.0078125,"p_of_remainder":0.75}])");
}

// dump() would write null for each of these numbers, too, but without a reason.
TEST(HomogeneityJson, ExplainsNonFiniteNumbers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Identification report = ExampleJointIdentification();
  Homogeneity& homogeneity = *report.across[0].homogeneity;
  homogeneity.amplitude_dependence[0].span = kNan;
  homogeneity.parameters[0].scatter.between = std::numeric_limits<double>::infinity();
  homogeneity.parameters[0].statistic = kNan;
  const Json json = HomogeneityOf(report);
  const Json& parameter = json["parameters"]["inertia"];
  EXPECT_EQ(json["amplitude_dependence"][0]["reason"], "span is not a finite number");
  EXPECT_EQ(parameter["random_effects"]["reason"], "between_std_dev is not a finite number");
  EXPECT_EQ(parameter["reason"], "statistic is not a finite number");
  EXPECT_THAT(json.dump(), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace pendulum::homogeneity_json_test
