// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/line_likelihood.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::line_likelihood_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(DepthTable, AgreesWithTheExactProbability) {
  for (const double sigma : {1e-6, 0.003, 0.05, 0.1, 0.5, 2.0}) {
    for (const double width : {1.0, kInfinity}) {
      DepthTable table(width);
      table.Build(sigma);
      const double last = std::min(0.5 * width, 12 * sigma);
      for (int i = 0; i <= 1000; ++i) {
        const double depth = -10 * sigma + i / 1000.0 * (last + 10 * sigma);
        const double exact = GaussianInterval(-depth / sigma, (width - depth) / sigma).log;
        // Remainder of a quintic: (1/4)⁶ / 46080 times a sixth derivative of a few units.
        ASSERT_NEAR(table(depth), exact, 1e-7) << sigma << " " << width << " " << depth;
        ASSERT_EQ(table(depth), table.At(depth).log);
      }
    }
  }
}

TEST(DepthTable, HasTheDerivativesOfTheNoiseModel) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.resolution = 1;
  for (const double sigma : {0.05, 0.25, 1.0}) {
    noise.sigma = sigma;
    DepthTable table(1);
    table.Build(sigma);
    for (int i = 1; i < 1000; ++i) {
      const double depth = -8 * sigma + i / 1000.0 * (0.5 + 8 * sigma);
      // The reading is 0: a value below it lies deeper as it increases.
      const NoiseLikelihood exact = noise.LikelihoodAt(0, depth - 0.5);
      ASSERT_NEAR(table.At(depth).slope, exact.score, 1e-6 / sigma) << sigma << " " << depth;
      ASSERT_NEAR(-table.At(depth).curvature, exact.information, 1e-4 / (sigma * sigma)) << sigma << " " << depth;
    }
  }
}

/// Six samples, resolution 0.1, range 0 to 1; samples two to four have the same model.
LevelSamples Samples() {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.resolution = 0.1;
  noise.low = 0;
  noise.high = 1;
  Eigen::VectorXd value(6);
  value << 0.2, 0.3, 0.4, 0.3, 0.0, 1.0;
  Eigen::VectorXd readings(6);
  readings << 0.23, 0.33, 0.33, 0.33, -0.02, 0.97;
  Eigen::MatrixXd jacobian(6, 1);
  jacobian << 1, 2, 2, 2, 3, 4;
  return MergeSamples(noise, value, readings, jacobian);
}

TEST(MergeSamples, CountsEqualSamplesAndPutsCensoredSamplesLast) {
  const LevelSamples samples = Samples();
  ASSERT_EQ(samples.size(), 5);
  EXPECT_EQ(samples.levels, 3);
  EXPECT_EQ(samples.count, (Eigen::VectorXd(5) << 1, 2, 1, 1, 1).finished());
  const Eigen::VectorXd position = (Eigen::VectorXd(5) << 0.3, 0.3, -0.7, 0.2, -0.3).finished();
  EXPECT_LT((samples.position - position).norm(), 1e-12);
  const Eigen::VectorXd slope = (Eigen::VectorXd(5) << 10, 20, 20, -30, 40).finished();
  EXPECT_LT((samples.slope - slope).norm(), 1e-12);
}

TEST(LevelSamples, ListsSamplesNearAnEdgeNearestFirst) {
  // Depths .2, .2, -.2; for the censored samples .2, -.3.
  const LevelSamples none_moves = Samples().Near(0.1, 0);
  EXPECT_EQ(none_moves.levels, 1);
  EXPECT_EQ(none_moves.size(), 2);
  const LevelSamples some_move = Samples().Near(0.1, 0.006);  // the first sample does not move far enough
  EXPECT_EQ(some_move.slope.col(0), (Eigen::VectorXd(4) << 20, 20, 40, -30).finished());
  EXPECT_EQ(some_move.count, (Eigen::VectorXd(4) << 1, 2, 1, 1).finished());
}

TEST(LineLikelihood, MatchesTheSumOfTheNoiseModel) {
  const LevelSamples samples = Samples();
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.resolution = 0.1;
  noise.sigma = 0.02;
  noise.low = 0;
  noise.high = 1;
  const double step = 0.001;
  double expected = 2 * noise.LikelihoodAt(0.3, 0.33 + 2 * step).log + noise.LikelihoodAt(0.2, 0.23 + step).log;
  expected += noise.LikelihoodAt(0.4, 0.33 + 2 * step).log + noise.LikelihoodAt(0.0, -0.02 + 3 * step).log;
  expected += noise.LikelihoodAt(1.0, 0.97 + 4 * step).log;
  LineLikelihood likelihood;
  likelihood.SetSigma(0.2);
  EXPECT_NEAR(likelihood.Sum(samples, samples.position, samples.slope.col(0), step, -kInfinity), expected, 6e-5);
  EXPECT_EQ(likelihood.work(), 5);
  EXPECT_LT(likelihood.Sum(samples, samples.position, samples.slope.col(0), step, expected + 0.1), expected + 0.1);
}

}  // namespace
}  // namespace pendulum::line_likelihood_test
