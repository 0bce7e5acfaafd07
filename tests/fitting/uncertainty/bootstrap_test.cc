// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/bootstrap.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/uncertainty/standard_errors.h"
#include "tests/fitting/fitted.h"

namespace pendulum::bootstrap_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Bootstrap, InterpolatesBetweenOrderStatistics) {
  Bootstrap bootstrap;
  bootstrap.estimates.resize(5, 2);
  bootstrap.estimates << 3, 0, 1, 0, 5, 0, 2, 0, 4, 7;
  EXPECT_DOUBLE_EQ(bootstrap.Quantile(0, 0), 1);
  EXPECT_DOUBLE_EQ(bootstrap.Quantile(0, 0.5), 3);
  EXPECT_DOUBLE_EQ(bootstrap.Quantile(0, 0.1), 1.4);  // four tenths between the first and the second
  EXPECT_DOUBLE_EQ(bootstrap.Quantile(0, 1), 5);
  EXPECT_DOUBLE_EQ(bootstrap.Quantile(1, 0.875), 3.5);
}

/// Compares the ends of bootstrap and covariance intervals for one recording, in half lengths.
void ExpectIntervalsOfCovariance(const Recording& recording, FitOptions options, double allowed) {
  options.interval = IntervalMethod::kCovariance;
  const FitReport covariance = Fit(recording, options);
  options.interval = IntervalMethod::kBootstrap;
  const FitReport bootstrap = Fit(recording, options);
  EXPECT_EQ(bootstrap.interval_method, "quantiles of 999 bootstrap fits, seed 1");
  for (std::size_t i = 0; i < covariance.parameters.size(); ++i) {
    const ParameterEstimate& a = covariance.parameters[i];
    const ParameterEstimate& b = bootstrap.parameters[i];
    const double half_length = 0.5 * (*a.upper95 - *a.lower95);
    EXPECT_NEAR((*b.lower95 - *a.lower95) / half_length, 0, allowed) << a.info.name;
    EXPECT_NEAR((*b.upper95 - *a.upper95) / half_length, 0, allowed) << a.info.name;
  }
}

// The end of an interval from 999 fits has a standard error of 4 % of the half length: sqrt(.025 · .975 / 999) divided
// by the normal density there. An eighth is three times that.
constexpr double kScatter = 0.125;

TEST(Bootstrap, MatchesCovarianceIntervalsForWhiteNoise) {
  ExpectIntervalsOfCovariance(Must(SimulateRecording(ShortSwing())), ModelOptions("coulomb"), kScatter);
}

TEST(Bootstrap, MatchesCovarianceIntervalsOnLevels) {
  SyntheticOptions run = ShortSwing();
  run.resolution = kCount;
  run.noise = 0.4 * kCount;
  FitOptions options = ModelOptions("coulomb");
  options.noise = NoiseFamily::kQuantized;
  ExpectIntervalsOfCovariance(Must(SimulateRecording(run)), options, kScatter);
}

TEST(Bootstrap, MatchesSandwichIntervalsForAutocorrelatedNoise) {
  SyntheticOptions run = ShortSwing();
  run.noise = 0;
  run.duration = 30;
  const Recording recording = WithNoise(Must(SimulateRecording(run)), 1, AutocorrelatedNoise(0.8, 0.002));
  const FitReport report = Fit(recording, ModelOptions("coulomb"));
  ASSERT_THAT(report.std_error_method, StartsWith("sandwich"));
  // Blocks cut the autocorrelation at their ends, and 1500 samples give only a few blocks.
  ExpectIntervalsOfCovariance(recording, ModelOptions("coulomb"), 0.25);
}

/// A short recording whose fits cost little.
Fitted SmallFit() {
  SyntheticOptions run = ShortSwing("viscous");
  run.sample_rate = 15;
  return FitWithInternals(Must(SimulateRecording(run)), ModelOptions("viscous"));
}

Bootstrap Bootstrapped(const Fitted& fitted, std::uint64_t seed, int threads) {
  FitOptions options = fitted.options;
  options.seed = seed;
  options.threads = threads;
  return RunBootstrap(*fitted.problem, options, fitted.solution, fitted.residuals, fitted.correlation);
}

TEST(Bootstrap, DoesNotDependOnTheNumberOfThreads) {
  Fitted fitted = SmallFit();
  const Bootstrap one = Bootstrapped(fitted, 1, 1);
  const Bootstrap three = Bootstrapped(fitted, 1, 3);
  EXPECT_EQ(one.failed, 0);
  EXPECT_EQ(one.estimates.rows(), kBootstrapFits);
  EXPECT_EQ(one.estimates, three.estimates);
}

TEST(Bootstrap, DiffersFromSeedToSeed) {
  Fitted fitted = SmallFit();
  const Bootstrap one = Bootstrapped(fitted, 1, 2);
  for (const std::uint64_t seed : {std::uint64_t{2}, (std::uint64_t{1} << 32U) + 1}) {
    const Bootstrap other = Bootstrapped(fitted, seed, 2);
    EXPECT_GT((one.estimates - other.estimates).cwiseAbs().minCoeff(), 0) << seed;
  }
}

TEST(Bootstrap, HasEstimatesThatScatterAboutTheFitByTheStandardErrors) {
  Fitted fitted = SmallFit();
  const Bootstrap bootstrap = Bootstrapped(fitted, 1, 2);
  const Errors errors = fitted.StandardErrors();
  for (int i = 0; i < 5; ++i) {
    const Eigen::ArrayXd deviation =
        (bootstrap.estimates.col(i).array() - fitted.At(i)) / std::sqrt(errors.covariance(i, i));
    EXPECT_NEAR(deviation.mean(), 0, 4 / std::sqrt(999)) << i;
    // The noise is drawn with the σ for N - F degrees of freedom, as in the standard errors.
    EXPECT_NEAR(std::sqrt(deviation.square().mean()), 1, 4 / std::sqrt(2 * 999)) << i;
  }
}

TEST(Bootstrap, ReportsItsProgress) {
  Fitted fitted = SmallFit();
  int done = 0;
  fitted.options.progress = [&](const ProgressStep& step) {
    EXPECT_EQ(step.what, "bootstrap of viscous");
    EXPECT_EQ(step.total, kBootstrapFits);
    EXPECT_EQ(step.done, ++done);
  };
  Bootstrapped(fitted, 1, 1);
  EXPECT_EQ(done, kBootstrapFits);
}

}  // namespace
}  // namespace pendulum::bootstrap_test
