// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/linear_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/fitted_run.h"

namespace pendulum::linear_fit_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Lt;
using testing::Not;

auto RelativelyNear(double expected, double tolerance) { return DoubleNear(expected, std::abs(tolerance * expected)); }

/// Independent standard normal numbers, of a fixed seed.
MatrixXd Normal(Index rows, Index columns, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

/// AR(1) noise of variance 1 with this correlation.
VectorXd Autocorrelated(Index size, double correlation, unsigned seed) {
  VectorXd z = Normal(size, 1, seed);
  for (Index i = 1; i < size; ++i) z[i] = correlation * z[i - 1] + std::sqrt(1 - correlation * correlation) * z[i];
  return z;
}

Autocorrelation FirstOrder(double correlation) {
  Autocorrelation autocorrelation;
  autocorrelation.kind = Autocorrelation::Kind::kAutoregressive;
  autocorrelation.autoregressive = {correlation};
  autocorrelation.innovation_variance = 1 - correlation * correlation;
  autocorrelation.interval = 1;
  return autocorrelation;
}

VectorXd Seconds(Index count) { return VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1)); }

// ---- Scores --------------------------------------------------------------------------------------------------------

// Normal: l = -(y - m)² / 2σ², so ∂l/∂m = (y - m) / σ² and -∂²l/∂m² = 1 / σ².
TEST(TermsOf, MatchANormalDensity) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const ReadingTerms terms = TermsOf(noise, Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(0.9, 2.3));
  EXPECT_THAT(terms.score, ElementsAre(DoubleNear(0.4, 1e-12), DoubleNear(-1.2, 1e-12)));
  EXPECT_THAT(terms.information, ElementsAre(DoubleNear(4, 1e-12), DoubleNear(4, 1e-12)));
}

ReadingTerms TermsOfDraws(const NoiseModel& noise, const VectorXd& value) {
  return TermsOf(noise, value, VectorXd::Zero(value.size()));
}

TEST(ScoreCovariance, AddsIndependentScoresForWhiteNoise) {
  NoiseModel noise;
  noise.sigma = 0.02;
  const VectorXd value = noise.sigma * Normal(50, 1, 1);
  const MatrixXd weights = Normal(50, 3, 2);
  const MatrixXd covariance = ScoreCovariance(noise, {}, TermsOfDraws(noise, value), Seconds(50), weights);
  const MatrixXd expected = weights.transpose() * weights / (0.02 * 0.02);
  EXPECT_THAT((covariance - expected).norm(), Lt(1e-12 * expected.norm()));
}

// Σ_ij w_i ρ^|i-j| w_j / σ², term by term.
TEST(ScoreCovariance, UsesTheCorrelationsOfTheNoise) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const VectorXd value = noise.sigma * Autocorrelated(30, 0.8, 1);
  const VectorXd weights = Normal(30, 1, 2);
  double expected = 0;
  for (Index i = 0; i < 30; ++i)
    for (Index j = 0; j < 30; ++j) expected += weights[i] * std::pow(0.8, std::abs(i - j)) * weights[j] / 0.25;
  const MatrixXd covariance = ScoreCovariance(noise, FirstOrder(0.8), TermsOfDraws(noise, value), Seconds(30), weights);
  EXPECT_THAT(covariance(0, 0), RelativelyNear(expected, 1e-9));
}

// Fisher's information of the location of Student's t is (ν + 1) / (ν + 3) / scale²; 20000 draws reproduce it to 1 %.
TEST(ScoreCovariance, IsTheInformationForStudentsNoise) {
  NoiseModel noise;
  noise.family = NoiseFamily::kStudent;
  noise.sigma = 0.5;
  std::mt19937_64 generator(3);
  std::student_t_distribution<double> student(4);
  const VectorXd value = VectorXd::NullaryExpr(20000, [&] { return 0.5 * student(generator); });
  const MatrixXd ones = MatrixXd::Ones(20000, 1);
  const MatrixXd covariance = ScoreCovariance(noise, {}, TermsOfDraws(noise, value), Seconds(20000), ones);
  EXPECT_THAT(covariance(0, 0) / 20000, RelativelyNear(5.0 / 7 / 0.25, 0.03));
}

// Levels 2 σ apart: information Σ (φ(a) - φ(b))² / (Φ(b) - Φ(a)) of the intervals [a, b], in units of 1 / σ².
TEST(ScoreCovariance, IsTheRemainingInformationForCoarseLevels) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = 0.5;
  noise.resolution = 1;
  const VectorXd value = (0.5 * Normal(20000, 1, 4)).array().round();
  double expected = 0;
  for (int level = -3; level <= 3; ++level) {
    const double a = 2 * level - 1, b = 2 * level + 1;
    const double density = (std::exp(-0.5 * a * a) - std::exp(-0.5 * b * b)) / std::sqrt(2 * kPi);
    expected += density * density / (0.5 * (std::erfc(a / std::sqrt(2.0)) - std::erfc(b / std::sqrt(2.0))));
  }
  const MatrixXd ones = MatrixXd::Ones(20000, 1);
  const MatrixXd covariance = ScoreCovariance(noise, {}, TermsOfDraws(noise, value), Seconds(20000), ones);
  EXPECT_THAT(covariance(0, 0) / 20000, RelativelyNear(expected / 0.25, 0.02));
}

// Residuals about the mean of N correlated values, 4000 times: their corrected variance is 1 within 3 %.
TEST(Inflation, CorrectsTheVarianceAboutAMean) {
  constexpr Index kCount = 50;
  double lost = 0;  // the mean's variance over that of independent values
  for (Index i = 0; i < kCount; ++i)
    for (Index j = 0; j < kCount; ++j) lost += std::pow(0.9, std::abs(i - j)) / kCount;
  double variance = 0;
  for (unsigned seed = 0; seed < 4000; ++seed) {
    const VectorXd z = Autocorrelated(kCount, 0.9, seed);
    variance += (z.array() - z.mean()).square().sum() / (kCount - 1) / 4000;
  }
  EXPECT_THAT(variance, Lt(0.8));
  EXPECT_THAT(variance * Inflation({}, kCount, 1, lost), DoubleNear(1, 0.03));
}

// A likelihood's σ² is RSS / N; for independent residuals it is too small by the factor (N - k) / N.
TEST(Inflation, CorrectsForParametersOnlyIfSigmaDoesNot) {
  EXPECT_DOUBLE_EQ(Inflation({}, 100, 5, 5), 1);
  NoiseModel quantized;
  quantized.family = NoiseFamily::kQuantized;
  EXPECT_DOUBLE_EQ(Inflation(quantized, 100, 5, 5), 100.0 / 95);
}

TEST(AutocorrelationOf, FindsTheAutocorrelationOfTheNoise) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const VectorXd zero = VectorXd::Zero(2000);
  const MatrixXd none(2000, 0);
  const auto autocorrelation = [&](const VectorXd& z) {
    return AutocorrelationOf(noise, Seconds(2000), noise.sigma * z, zero, none);
  };
  EXPECT_EQ(autocorrelation(Normal(2000, 1, 1)).Name(), "white");
  const Autocorrelation found = autocorrelation(Autocorrelated(2000, 0.9, 1));
  ASSERT_EQ(found.Name(), "AR(1)");
  // Its standard error is sqrt((1 - φ²) / N) = 0.01.
  EXPECT_THAT(found.autoregressive[0], DoubleNear(0.9, 0.04));
}

// ---- Linearize -----------------------------------------------------------------------------------------------------

LinearFit LinearOf(const FitOfRun& run, bool with_bounds, const ParameterPriors& priors = {}) {
  const NoiseModel noise{run.fit.noise.family, run.fit.noise.sigma, 0};
  return LinearizeFit(run.recording, run.fit, {}, TermsOf(noise, run.recording.value, run.fit.fitted), priors,
                      with_bounds)
      .value();
}

TEST(LinearizeFit, PredictsTheRefitAfterASmallChange) {
  const FitOfRun before = FitTo(NoisyRun(), "coulomb", {});
  const LinearFit linear = LinearOf(before, true);
  const VectorXd change = 1e-3 * Normal(before.recording.size(), 1, 5);  // half the noise
  Recording changed = before.recording;
  changed.value += change;
  const FitOfRun after = FitTo(changed, ModelOptions("coulomb"));
  const double variance = before.fit.noise.sigma * before.fit.noise.sigma;
  const VectorXd predicted = linear.influence.transpose() * change / variance;
  for (std::size_t i = 0; i < linear.free.size(); ++i) {
    const ParameterEstimate& old = before.fit.parameters[static_cast<std::size_t>(linear.free[i])];
    const double moved = after.fit.Find(old.info.name)->estimate - old.estimate;
    EXPECT_THAT(predicted[static_cast<Index>(i)], DoubleNear(moved, 0.02 * *old.std_error)) << old.info.name;
  }
  EXPECT_THAT(predicted[0], Not(DoubleNear(0, 0.05 * *before.fit.parameters[0].std_error)));
}

// The fit's reported errors come from another implementation.
TEST(LinearizeFit, HasTheErrorsOfTheFitOnItsDiagonal) {
  const FitOfRun run = FitTo(NoisyRun(), "coulomb", {});
  const LinearFit linear = LinearOf(run, true);
  ASSERT_EQ(linear.free.size(), run.fit.parameters.size());
  for (std::size_t i = 0; i < linear.free.size(); ++i) {
    const auto k = static_cast<Index>(i);
    EXPECT_THAT(std::sqrt(linear.inverse(k, k)), RelativelyNear(*run.fit.parameters[i].std_error, 1e-3));
  }
}

// A prior as accurate as the data: two independent values with errors s have a mean with error s / √2.
TEST(LinearizeFit, IncludesPriors) {
  const FitOfRun run = FitTo(NoisyRun(), "coulomb", {});
  const double alone = std::sqrt(LinearOf(run, true).inverse(0, 0));
  const ParameterPriors priors = {{"inertia", {run.fit.parameters[0].estimate, alone}}};
  EXPECT_THAT(std::sqrt(LinearOf(run, true, priors).inverse(0, 0)), RelativelyNear(alone / std::sqrt(2.0), 1e-6));
}

// Dry friction fitted to a recording without it is at 0 in about half of the recordings.
TEST(LinearizeFit, FreesParametersAtABoundIfRequested) {
  SyntheticOptions run = NoisyRun("viscous");
  FitOfRun fitted;
  do {
    fitted = FitTo(run, "coulomb", {});
  } while (!fitted.fit.parameters[2].at_bound && ++run.seed < 20);
  ASSERT_TRUE(fitted.fit.parameters[2].at_bound);
  EXPECT_THAT(LinearOf(fitted, true).free, Not(Contains(2)));
  EXPECT_THAT(LinearOf(fitted, false).free, Contains(2));
}

TEST(LinearizeFit, IsEmptyIfTheMotionCannotBeComputed) {
  FitOfRun run = FitTo(NoisyRun(), "coulomb", {});
  const ReadingTerms terms = TermsOf({}, run.recording.value, run.fit.fitted);
  run.fit.parameters[0].estimate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(LinearizeFit(run.recording, run.fit, {}, terms, {}, true));
}

}  // namespace
}  // namespace pendulum::linear_fit_test
