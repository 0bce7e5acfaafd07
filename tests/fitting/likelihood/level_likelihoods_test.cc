// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/level_likelihoods.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::level_likelihoods_test {
namespace {

using testing::DoubleNear;

constexpr double kLevel = 0.35;
constexpr Eigen::Index kMany = 100'000;

NoiseModel Levels(double sigma) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = sigma;
  noise.resolution = 0.0035;
  return noise;
}

/// The exact likelihood is that of NoiseModel, which has its own tests.
void ExpectNear(const NoiseLikelihood& actual, const NoiseLikelihood& exact, double sigma) {
  EXPECT_THAT(actual.log, DoubleNear(exact.log, 1e-6));
  EXPECT_THAT(actual.score * sigma, DoubleNear(exact.score * sigma, 1e-5));
  EXPECT_THAT(actual.information * sigma * sigma, DoubleNear(exact.information * sigma * sigma, 1e-5));
  EXPECT_THAT(actual.sigma_score, DoubleNear(exact.sigma_score, 1e-5));
  EXPECT_THAT(actual.sigma_information, DoubleNear(exact.sigma_information, 1e-5 * (1 + exact.sigma_information)));
  EXPECT_THAT(actual.mixed * sigma, DoubleNear(exact.mixed * sigma, 1e-5));
}

TEST(LevelLikelihoods, MatchTheNoiseModelInsideAndOutsideTheTable) {
  for (const double counts : {0.05, 0.25, 1.0, 3.0}) {
    const NoiseModel noise = Levels(counts * 0.0035);
    const LevelLikelihoods likelihoods(noise, kMany);
    for (int i = -800; i <= 800; ++i) {
      const double m = kLevel + 0.011 * i * noise.sigma;
      SCOPED_TRACE(testing::Message() << counts << " counts, " << 0.011 * i << " sigma from the level");
      ExpectNear(likelihoods.At(kLevel, m), noise.LikelihoodAt(kLevel, m), noise.sigma);
    }
  }
}

TEST(LevelLikelihoods, AreExactAtAnEndOfTheRange) {
  NoiseModel noise = Levels(0.001);
  noise.high = kLevel;
  const LevelLikelihoods likelihoods(noise, kMany);
  EXPECT_EQ(likelihoods.At(kLevel, kLevel - 0.0004).log, noise.LikelihoodAt(kLevel, kLevel - 0.0004).log);
}

TEST(LevelLikelihoods, AreExactForFewReadings) {
  const NoiseModel noise = Levels(0.001);
  const LevelLikelihoods likelihoods(noise, 100);
  EXPECT_EQ(likelihoods.At(kLevel, kLevel + 0.0007).score, noise.LikelihoodAt(kLevel, kLevel + 0.0007).score);
}

}  // namespace
}  // namespace pendulum::level_likelihoods_test
