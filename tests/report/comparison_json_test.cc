// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/comparison_json.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/identify/example_identification.h"

namespace pendulum::comparison_json_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ComparisonJson, HasARowForEachModel) {
  const Json rows = ComparisonJson(ExampleComparedIdentification())["rows"];
  ASSERT_EQ(rows.size(), 2);
  EXPECT_EQ(rows[0]["cross_validation"].dump(), R"({"rms_rad":0.0035,"standardized":1.0125,"samples":1600})");
  EXPECT_EQ(rows[0]["rms_residual_rad"], 0.00349);
  EXPECT_FALSE(rows[0].contains("reason"));
  for (const char* key : {"log_likelihood", "aic", "aicc", "bic", "delta_bic", "akaike_weight", "cross_validation",
                          "forward_prediction"}) {
    EXPECT_TRUE(rows[1][key].is_null()) << key;
  }
}

TEST(ComparisonJson, ExplainsAMissingPrediction) {
  Identification report = ExampleComparedIdentification();
  report.comparison->rows[0].forward = {0, 0, 0, "it ends early"};
  const Json row = ComparisonJson(report)["rows"][0];
  EXPECT_TRUE(row["forward_prediction"].is_null());
  EXPECT_EQ(row["reason"], "forward prediction: it ends early");
  report.comparison->rows[0].forward.reason.clear();
  EXPECT_EQ(ComparisonJson(report)["rows"][0]["reason"], "forward prediction: not made");
}

TEST(ComparisonJson, NamesTheBasisOfTheCriteria) {
  Identification report = ExampleComparedIdentification();
  const std::pair<Likelihood, const char*> named[] = {{Likelihood::kIndependent, "independent"},
                                                      {Likelihood::kCorrelated, "correlated"},
                                                      {Likelihood::kScaled, "scaled"},
                                                      {Likelihood::kNone, "none"}};
  for (const auto& [likelihood, name] : named) {
    report.comparison->likelihood = likelihood;
    const Json json = ComparisonJson(report);
    EXPECT_EQ(json["likelihood"], name);
    EXPECT_EQ(json["criterion"].is_null(), likelihood == Likelihood::kNone);
  }
}

TEST(ComparisonJson, IsNullWithoutARecommendation) {
  Identification report = ExampleComparedIdentification();
  report.comparison->recommended.clear();
  EXPECT_TRUE(ComparisonJson(report)["recommended"].is_null());
  EXPECT_TRUE(ComparisonJson(ExampleIdentification()).is_null());
}

TEST(ComparisonJson, ExplainsAMissingPValue) {
  const Json tests = ComparisonJson(ExampleComparedIdentification())["tests"];
  EXPECT_FALSE(tests[0].contains("reason"));
  EXPECT_TRUE(tests[1]["p"].is_null());
  EXPECT_EQ(tests[1]["reason"], "drag did not converge");
}

TEST(ComparisonJson, NamesTheUnitOfARate) {
  Identification report = ExampleComparedIdentification();
  report.unit = "rad/s";
  const Json row = ComparisonJson(report)["rows"][0];
  EXPECT_TRUE(row.contains("rms_residual_rad_s"));
  EXPECT_TRUE(row["cross_validation"].contains("rms_rad_s"));
}

TEST(ComparisonJson, WritesNonFiniteNumbersAsNull) {
  Identification report = ExampleComparedIdentification();
  ComparisonRow& row = report.comparison->rows[0];
  row.aic = kNan;
  row.cross_validation.standardized = kNan;
  const Json json = ComparisonJson(report)["rows"][0];
  EXPECT_TRUE(json["aic"].is_null());
  EXPECT_TRUE(json["cross_validation"]["standardized"].is_null());
  EXPECT_EQ(json["cross_validation"]["reason"], "standardized is not a finite number");
}

TEST(ConstancyJson, HasTheTestsOfHalvesAndAmplitude) {
  const Constancy constancy = ExampleConstancy();
  const Json json = ConstancyJson(&constancy);
  EXPECT_EQ(json["constant"], false);
  EXPECT_EQ(json["halves"]["rows"].size(), 2);
  EXPECT_EQ(json["amplitude"]["windows"].size(), 3);
  EXPECT_TRUE(json["amplitude"]["windows"][0]["friction"].is_null());
  EXPECT_EQ(json["amplitude"]["trends"][0]["span"], 0.0195);
  EXPECT_FALSE(json.contains("reason"));
}

TEST(ConstancyJson, ExplainsAMissingTest) {
  Constancy constancy = ExampleConstant();
  constancy.halves_p.reset();
  constancy.halves.clear();
  constancy.reason = "the second half did not converge";
  const Json json = ConstancyJson(&constancy);
  EXPECT_TRUE(json["halves"]["p"].is_null());
  EXPECT_EQ(json["halves"]["reason"], constancy.reason);
  EXPECT_EQ(json["reason"], constancy.reason);
  EXPECT_EQ(json["constant"], true);
}

TEST(ConstancyJson, IsNullWithAReasonWithoutATest) {
  FitReport fit = ExampleFit();
  Constancy constancy;
  EXPECT_TRUE(ConstancyJson(nullptr).is_null());
  EXPECT_TRUE(ConstancyJson(&constancy).is_null());
  EXPECT_EQ(NoConstancyReason(fit, nullptr), "it was not tested");
  constancy.reason = "too short";
  EXPECT_EQ(NoConstancyReason(fit, &constancy), "too short");
  fit.termination = Termination::kNotIdentifiable;
  EXPECT_EQ(NoConstancyReason(fit, nullptr), "the fit is not_identifiable");
  constancy = ExampleConstancy();
  EXPECT_EQ(NoConstancyReason(fit, &constancy), "");
}

}  // namespace
}  // namespace pendulum::comparison_json_test
