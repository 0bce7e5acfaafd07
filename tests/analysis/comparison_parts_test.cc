// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/comparison_parts.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::comparison_parts_test {
namespace {

using testing::HasSubstr;

ComparisonRow RowOf(int parameters, std::optional<double> log_likelihood) {
  ComparisonRow row;
  row.parameters = parameters;
  row.log_likelihood = log_likelihood;
  return row;
}

// log L = -10, k = 3, N = 10, n = e²: AIC = 6 + 20, AICc adds 2 · 3 · 4 / 6, BIC = 3 · 2 + 20.
TEST(SetCriteria, MatchesAkaikeHurvichAndSchwarz) {
  ComparisonRow row = RowOf(3, -10);
  SetCriteria(10, std::exp(2.0), row);
  EXPECT_DOUBLE_EQ(row.aic.value(), 26);
  EXPECT_DOUBLE_EQ(row.aicc.value(), 30);
  EXPECT_DOUBLE_EQ(row.bic.value(), 26);
}

TEST(SetCriteria, IsEmptyWithoutALikelihood) {
  ComparisonRow row = RowOf(3, std::nullopt);
  SetCriteria(10, 10, row);
  EXPECT_FALSE(row.aic || row.aicc || row.bic);
}

// exp(0) and exp(-1) over their sum: e / (1 + e) and 1 / (1 + e).
TEST(SetDifferences, AreRelativeToTheSmallestAndWeightsSumToOne) {
  std::vector<ComparisonRow> rows(3);
  rows[0].aicc = 102;
  rows[0].bic = 105;
  rows[2].aicc = 100;
  rows[2].bic = 110;
  SetDifferences(rows);
  EXPECT_DOUBLE_EQ(rows[0].delta_bic.value(), 0);
  EXPECT_DOUBLE_EQ(rows[2].delta_bic.value(), 5);
  EXPECT_NEAR(rows[0].akaike_weight.value(), 0.268941421369995, 1e-14);
  EXPECT_NEAR(rows[2].akaike_weight.value(), 0.731058578630005, 1e-14);
  EXPECT_FALSE(rows[1].delta_bic || rows[1].akaike_weight);
}

TEST(BestFit, IsTheConvergedFitWithTheSmallestAicc) {
  std::vector<FitReport> fits(4);
  const double aicc[] = {5, 3, 1, std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t i = 0; i < 4; ++i) {
    fits[i].termination = i == 2 ? Termination::kNotConverged : Termination::kConverged;
    fits[i].statistics.aicc = aicc[i];
  }
  EXPECT_EQ(BestFit(fits), &fits[1]);
  EXPECT_EQ(BestFit({}), nullptr);
}

// Four parameters: free, fixed, at the bound 0 of a simpler law, and at another bound. Two of them and σ count.
TEST(DescribeFit, CountsFreeParametersAndNoise) {
  FitReport fit;
  fit.termination = Termination::kConverged;
  fit.parameters.resize(4);
  fit.parameters[0].estimate = 0.5;
  fit.parameters[1].fixed = true;
  fit.parameters[2].at_bound = true;
  fit.parameters[3].at_bound = true;
  fit.parameters[3].estimate = 1;
  EXPECT_EQ(DescribeFit(fit).parameters, 3);
  EXPECT_TRUE(DescribeFit(fit).judged);
  fit.termination = Termination::kNotConverged;
  fit.reason = "too few iterations";
  EXPECT_FALSE(DescribeFit(fit).judged);
  EXPECT_EQ(DescribeFit(fit).reason, "not_converged: too few iterations");
}

// ---- Likelihood ----------------------------------------------------------------------------------------------------

/// Autocorrelated residuals of 1 mrad.
FitReport Autocorrelated() {
  FitReport fit;
  fit.model = {"coulomb", "coulomb", Gravity::kSine};
  fit.statistics.rms_residual = 1e-3;
  fit.trace_error = 1e-9;
  fit.noise.sigma = 1e-3;
  fit.noise.autocorrelation = {Autocorrelation::Kind::kAutoregressive, {0.5}};
  return fit;
}

TEST(ChooseLikelihood, IsIndependentWithoutAutocorrelation) {
  FitReport fit = Autocorrelated();
  fit.noise.autocorrelation = {};
  fit.noise.family = NoiseFamily::kHuber;
  EXPECT_EQ(ChooseLikelihood(fit, 0), Likelihood::kIndependent);
  EXPECT_EQ(DescribeLikelihood(Likelihood::kIndependent, fit), "likelihood of independent huber residuals");
}

TEST(ChooseLikelihood, IsCorrelatedForNormalNoiseAboveHalfACount) {
  const FitReport fit = Autocorrelated();
  EXPECT_EQ(ChooseLikelihood(fit, 0), Likelihood::kCorrelated);
  EXPECT_EQ(ChooseLikelihood(fit, 1.9e-3), Likelihood::kCorrelated);
  EXPECT_EQ(ChooseLikelihood(fit, 2.1e-3), Likelihood::kScaled);
  EXPECT_THAT(DescribeLikelihood(Likelihood::kCorrelated, fit), HasSubstr("AR(1) as for coulomb"));
  EXPECT_THAT(DescribeLikelihood(Likelihood::kScaled, fit), HasSubstr("noise below half a count"));
}

TEST(ChooseLikelihood, IsScaledIfThatOfAutocorrelatedResidualsIsNotKnown) {
  FitReport censored = Autocorrelated();
  censored.noise.censored = 1;
  EXPECT_EQ(ChooseLikelihood(censored, 0), Likelihood::kScaled);
  EXPECT_THAT(DescribeLikelihood(Likelihood::kScaled, censored), HasSubstr("an end of the sensor's range"));
  FitReport robust = Autocorrelated();
  robust.noise.family = NoiseFamily::kStudent;
  EXPECT_EQ(ChooseLikelihood(robust, 0), Likelihood::kScaled);
  EXPECT_THAT(DescribeLikelihood(Likelihood::kScaled, robust), HasSubstr("a robust loss"));
}

TEST(ChooseLikelihood, ReturnsNoneForRounding) {
  FitReport rounding = Autocorrelated();
  rounding.statistics.rms_residual = rounding.trace_error;
  EXPECT_EQ(ChooseLikelihood(rounding, 0), Likelihood::kNone);
  EXPECT_THAT(DescribeLikelihood(Likelihood::kNone, rounding), HasSubstr("error of its computed trajectory"));
}

TEST(SharedAutocorrelation, HasOrderEightAtMost) {
  FitReport fit = Autocorrelated();
  EXPECT_EQ(SharedAutocorrelation(fit).Name(), "AR(1)");
  fit.noise.autocorrelation.autoregressive.assign(20, 0.01);
  EXPECT_EQ(SharedAutocorrelation(fit).Name(), "AR(8)");
}

TEST(SumOfLogLevelWidths, ConvertsDensitiesToProbabilitiesOfLevels) {
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(10, 0, 9);
  EXPECT_EQ(SumOfLogLevelWidths(recording), 0);
  recording.resolution = std::exp(-2.0);  // ten readings on levels of exp(-2) rad: 10 ln q
  EXPECT_DOUBLE_EQ(SumOfLogLevelWidths(recording), -20);
}

}  // namespace
}  // namespace pendulum::comparison_parts_test
