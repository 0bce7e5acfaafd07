// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_json.h"

#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "tests/identify/example_identification.h"

namespace pendulum::fit_json_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(ResolutionJson, IsNullWithoutLevels) {
  DataSummary data;
  EXPECT_TRUE(ResolutionJson(data).is_null());
  data.resolution = 0.25;
  EXPECT_EQ(ResolutionJson(data), 0.25);
}

TEST(ParametersJson, HasNumbersUnitsAndFlagsByName) {
  const Json parameters = ParametersJson(ExampleFit());
  EXPECT_EQ(parameters.size(), 5);
  EXPECT_EQ(
      parameters["inertia"].dump(),
      R"({"estimate":0.079,"std_error":0.00025,"interval95":[0.0785,0.0795],"systematic_std_error":0.001,)"
      R"("total_std_error":0.001030776406404415,"total_interval95":[0.07697726452033536,0.08102273547966464],"error_budget":{"noise":0.00025,"rig":0.001},)"
      R"("unit":"kg m^2","fixed":false,"at_bound":false,"text":"0.0790 ± 0.0010"})");
  EXPECT_TRUE(parameters["viscous"]["systematic_std_error"].is_null());
}

TEST(ParametersJson, ExplainsAMissingError) {
  FitReport fit = ExampleFit();
  fit.parameters[3].upper95.reset();
  fit.parameters[3].open_interval = OpenInterval::kFlatLikelihood;
  const Json parameters = ParametersJson(fit);
  EXPECT_TRUE(parameters["coulomb"]["std_error"].is_null());
  EXPECT_EQ(parameters["coulomb"]["at_bound"], true);
  EXPECT_EQ(parameters["coulomb"]["reason"], "the estimate is at its lower bound 0");
  EXPECT_TRUE(parameters["zero_angle"]["interval95"].is_null());
  EXPECT_EQ(parameters["zero_angle"]["reason"], "fixed");
  EXPECT_TRUE(parameters["release_angle"]["interval95"][1].is_null());
  EXPECT_EQ(parameters["release_angle"]["reason"],
            "the interval is open: the likelihood does not fall far enough on that side, at any distance");
  EXPECT_FALSE(parameters["inertia"].contains("reason"));
}

TEST(DerivedJson, ExplainsAMissingError) {
  const Json derived = DerivedJson(ExampleFit());
  EXPECT_EQ(derived["natural_frequency"]["interval95"].dump(), "[4.763,4.793]");
  EXPECT_TRUE(derived["damping_ratio"]["std_error"].is_null());
  EXPECT_EQ(derived["damping_ratio"]["reason"], "a parameter on which it depends has no standard error");
}

TEST(CovarianceJson, IsSquareInTheFreeParameters) {
  const Json covariance = CovarianceJson(ExampleFit());
  EXPECT_EQ(covariance["names"].dump(), R"(["inertia","viscous","release_angle"])");
  ASSERT_EQ(covariance["matrix"].size(), 3);
  for (const Json& row : covariance["matrix"]) EXPECT_EQ(row.size(), 3);
  EXPECT_EQ(covariance["matrix"][0][1], 6.25e-8);
  EXPECT_EQ(covariance["matrix"][2][2], 4e-8);
}

// 6.25e-8 / (0.00025 · 0.0005) = 0.5
TEST(CorrelationJson, IsTheCovarianceOverTheStandardErrors) {
  const Json matrix = CorrelationJson(ExampleFit())["matrix"];
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(matrix[i][i].get<double>(), 1);
  EXPECT_DOUBLE_EQ(matrix[0][1].get<double>(), 0.5);
  EXPECT_DOUBLE_EQ(matrix[1][2].get<double>(), 0);
}

TEST(SystematicJson, ListsParametersWithSystematicErrorsOnly) {
  EXPECT_EQ(SystematicJson(ExampleFit()).dump(), R"({"names":["inertia"],"matrix":[[1e-06]]})");
  FitReport none;
  EXPECT_EQ(SystematicJson(none).dump(), R"({"names":[],"matrix":[]})");
}

TEST(NoiseJson, CarriesTheUnitInItsKeys) {
  FitReport fit = ExampleFit();
  const Json noise = NoiseJson(fit, DataSummary());
  EXPECT_EQ(noise["model"], "quantized");
  EXPECT_EQ(noise["sigma_rad"], 0.0035);
  EXPECT_TRUE(noise["resolution_rad"].is_null());
  EXPECT_EQ(noise["saturated_samples"], 12);
  EXPECT_EQ(noise["correlation"], "AR(2)");
  fit.reading_unit = "rad/s";
  fit.noise.sigma = kNotANumber;
  EXPECT_TRUE(NoiseJson(fit, DataSummary())["sigma_rad_s"].is_null());
  EXPECT_EQ(NoiseJson(fit, DataSummary())["reason"],
            "the residuals are 0.8 resolutions; sigma_rad_s is not a finite number");
}

TEST(StatisticsJson, HasNullForNonFiniteNumbers) {
  FitReport fit = ExampleFit();
  EXPECT_EQ(StatisticsJson(fit)["rms_residual_rad"], 0.00349);
  EXPECT_FALSE(StatisticsJson(fit).contains("reason"));
  fit.statistics.aicc = kNotANumber;
  EXPECT_TRUE(StatisticsJson(fit)["aicc"].is_null());
  EXPECT_EQ(StatisticsJson(fit)["reason"], "aicc is not a finite number");
}

TEST(IdentifiabilityJson, HasNullForNoAdvice) {
  const Json all = IdentifiabilityJson(ExampleFit());
  ASSERT_EQ(all.size(), 4);
  EXPECT_EQ(all[0].dump(), R"({"parameter":"inertia","verdict":"identifiable","direction":[],"advice":null})");
  EXPECT_EQ(all[1]["direction"].dump(), R"(["viscous","coulomb"])");
  EXPECT_EQ(all[1]["advice"], "let it swing for longer");
}

TEST(SolverJson, ListsTheAttemptsInTheirOrder) {
  const SolverSummary solver{7, 15, "done", {{"moving_start", false}, {"earlier_end", true}}};
  EXPECT_EQ(SolverJson(solver).dump(),
            R"({"iterations":7,"evaluations":15,"termination":"done","attempts":[{"name":"moving_start","kept":false},)"
            R"({"name":"earlier_end","kept":true}]})");
}

}  // namespace
}  // namespace pendulum::fit_json_test
