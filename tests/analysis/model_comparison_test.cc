// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/model_comparison.h"

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/recommendation_cases.h"
#include "tests/analysis/whole_swing.h"
#include "tests/fitting/correlated_noise.h"

namespace pendulum::model_comparison_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

struct Compared {
  FittedRecording fitted;
  Comparison comparison;
};

Compared Compare(const Recording& recording, const std::vector<std::string>& models, const CompareOptions& how = {}) {
  FitOptions options;
  options.interval = IntervalMethod::kCovariance;
  FittedRecording fitted = Must(FitModels(recording, Whole(recording), options, models));
  Comparison comparison = CompareModels(OnlyOne(fitted), options, how);
  return {std::move(fitted), std::move(comparison)};
}

constexpr CompareOptions kCriteriaOnly = {.predict = false};

/// A recording with Gaussian noise and without levels.
Recording GaussianRecording(std::string_view model, std::uint64_t seed = 1) {
  return Must(SimulateRecording(NoisyRun(model, seed)));
}

// AIC = 2 k - 2 log L, BIC = k ln N - 2 log L with k parameters including σ. log L of Gaussian residuals with the most
// likely σ is -N/2 (ln(2π RSS/N) + 1).
TEST(CompareModels, HasTheTextbooksCriteria) {
  const auto [fitted, comparison] = Compare(GaussianRecording("coulomb"), {"viscous", "coulomb"}, kCriteriaOnly);
  ASSERT_EQ(comparison.likelihood, Likelihood::kIndependent);
  ASSERT_THAT(comparison.rows, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    const ComparisonRow& row = comparison.rows[i];
    const double n = static_cast<double>(fitted.used.size());
    const double rss = fitted.fits[i].residual.squaredNorm();
    const double log_likelihood = -0.5 * n * (std::log(2 * kPi * rss / n) + 1);
    const int k = i == 0 ? 6 : 7;  // inertia, friction, release_angle, release_time, zero_angle, σ
    EXPECT_EQ(row.parameters, k);
    EXPECT_NEAR(*row.log_likelihood, log_likelihood, 1e-6);
    EXPECT_NEAR(*row.aic, 2 * k - 2 * log_likelihood, 1e-6);
    EXPECT_NEAR(*row.aicc, 2 * k - 2 * log_likelihood + 2.0 * k * (k + 1) / (n - k - 1), 1e-6);
    EXPECT_NEAR(*row.bic, k * std::log(n) - 2 * log_likelihood, 1e-6);
  }
}

TEST(CompareModels, HasWeightsThatAddUpToOneAndDifferencesToTheBest) {
  const auto [fitted, comparison] =
      Compare(GaussianRecording("coulomb"), {"viscous", "coulomb", "drag"}, kCriteriaOnly);
  double sum = 0;
  double least = kUnbounded;
  for (const ComparisonRow& row : comparison.rows) {
    sum += *row.akaike_weight;
    least = std::min(least, *row.delta_bic);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(least, 0);
}

// The richer law contains the simpler one and cannot fit worse.
TEST(CompareModels, GivesARicherLawNoSmallerLikelihood) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto [fitted, comparison] =
        Compare(GaussianRecording("coulomb", seed), {"viscous", "coulomb", "drag", "asymmetric"}, kCriteriaOnly);
    const auto& rows = comparison.rows;
    EXPECT_GE(*rows[1].log_likelihood, *rows[0].log_likelihood - 1e-6);
    EXPECT_GE(*rows[2].log_likelihood, *rows[1].log_likelihood - 1e-6);
    EXPECT_GE(*rows[3].log_likelihood, *rows[1].log_likelihood - 1e-4);
    EXPECT_THAT(comparison.tests, SizeIs(4));  // viscous in coulomb and drag, coulomb in drag and asymmetric
  }
}

TEST(CompareModels, PredictsBetterWithTheRightLaw) {
  SyntheticOptions run = NoisyRun();
  run.duration = 20;
  const auto [fitted, comparison] = Compare(Must(SimulateRecording(run)), {"viscous", "coulomb"});
  const auto& rows = comparison.rows;
  EXPECT_EQ(comparison.recommended, "coulomb");
  EXPECT_GT(rows[0].forward.rms, 1.5 * rows[1].forward.rms);
  EXPECT_THAT(rows[1].cross_validation.standardized, DoubleNear(1, 0.1));
}

/// The textbook's swing with AR(1) noise of standard deviation `sigma` [rad], on levels of this resolution.
Recording CorrelatedRecording(double sigma, double resolution, std::uint64_t seed) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.noise = 0;
  Recording recording = Must(SimulateRecording(run));
  recording.value += sigma * FirstOrderNoise(recording.size(), 0.9, 0, seed);
  if (resolution > 0) {
    recording.value = resolution * (recording.value.array() / resolution).round();
    recording.resolution = resolution;
  }
  return recording;
}

TEST(CompareModels, UsesTheAutocorrelation) {
  const auto [fitted, comparison] =
      Compare(CorrelatedRecording(0.004, 0, 5), {"viscous", "coulomb", "drag"}, kCriteriaOnly);
  EXPECT_EQ(comparison.likelihood, Likelihood::kCorrelated);
  EXPECT_LT(comparison.effective_samples, 0.5 * static_cast<double>(fitted.used.size()));
  EXPECT_THAT(comparison.criterion, HasSubstr("autocorrelated residuals"));
  // The innovations of AR(1) noise with correlation 0.9 have sqrt(1 - 0.81) times its standard deviation: ln L is
  // larger by -N/2 ln(0.19).
  const double n = static_cast<double>(fitted.used.size());
  const double gained = *comparison.rows[1].log_likelihood - fitted.fits[1].statistics.log_likelihood;
  EXPECT_NEAR(gained, -0.5 * n * std::log(0.19), 0.1 * n);
}

// If autocorrelation is ignored, it looks like additional friction terms. If it is included, the true law is
// recommended: viscous and dry friction.
TEST(CompareModels, RecommendsTheTrueLawForAutocorrelatedNoise) {
  int right = 0;
  constexpr int kSeeds = 10;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto compared = Compare(CorrelatedRecording(0.002, 0, static_cast<std::uint64_t>(seed)),
                                  {"viscous", "coulomb", "drag"}, kCriteriaOnly);
    if (compared.comparison.recommended == "coulomb") ++right;
  }
  EXPECT_GE(right, kSeeds - 1);
}

// Below half a count the likelihood of autocorrelated readings is not known. That of independent readings, scaled to
// the effective samples, still recommends the true law: viscous and dry friction.
TEST(CompareModels, RecommendsTheTrueLawForSmallAutocorrelatedNoise) {
  int right = 0, scaled = 0;
  constexpr int kSeeds = 10;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto [fitted, comparison] =
        Compare(CorrelatedRecording(0.3 * kCount, kCount, static_cast<std::uint64_t>(seed)),
                {"viscous", "coulomb", "drag"}, kCriteriaOnly);
    if (comparison.likelihood == Likelihood::kScaled) ++scaled;
    if (comparison.recommended == "coulomb") ++right;
  }
  EXPECT_GE(scaled, kSeeds - 1);
  EXPECT_GE(right, kSeeds - 1);
}

// Without noise the residuals of all laws that contain the true one are rounding errors.
TEST(CompareModels, RecommendsTheSimplestLawWithoutNoise) {
  SyntheticOptions exact = TextbookRun("coulomb");
  exact.noise = exact.resolution = 0;
  const auto [fitted, comparison] =
      Compare(Must(SimulateRecording(exact)), {"viscous", "coulomb", "drag"}, kCriteriaOnly);
  EXPECT_EQ(comparison.likelihood, Likelihood::kNone);
  EXPECT_THAT(comparison.reason, HasSubstr("no noise is left"));
  EXPECT_EQ(comparison.recommended, "coulomb");
}

TEST(CompareModels, ComparesConvergedFitsOnly) {
  Compared made = Compare(GaussianRecording("coulomb"), {"viscous", "coulomb"}, kCriteriaOnly);
  made.fitted.fits[1].termination = Termination::kNotConverged;
  made.fitted.fits[1].reason = "made so";
  const Comparison again = CompareModels(OnlyOne(made.fitted), {}, kCriteriaOnly);
  EXPECT_EQ(again.recommended, "viscous");
  EXPECT_FALSE(again.rows[1].judged || again.rows[1].bic);
  EXPECT_THAT(again.rows[1].reason, HasSubstr("made so"));
  made.fitted.fits[0].termination = Termination::kFailed;
  const Comparison none = CompareModels(OnlyOne(made.fitted), {}, kCriteriaOnly);
  EXPECT_THAT(none.recommended, IsEmpty());
  EXPECT_EQ(none.likelihood, Likelihood::kNone);
}

}  // namespace
}  // namespace pendulum::model_comparison_test
