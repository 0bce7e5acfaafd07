// SPDX-License-Identifier: Apache-2.0
#include "fitting/residuals/burg.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/correlated_noise.h"

namespace pendulum::burg_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<GapFreeSpan> Whole(const Eigen::VectorXd& value) { return {{0, value.size()}}; }

TEST(ReflectionCoefficients, MatchFourSamplesComputedByHand) {
  // Order 1: 2 (2·1 + 3·2 + 5·3) / (2² + 3² + 5² + 1² + 2² + 3²) = 46/52. The forward errors are then 3 - 23/26·2 =
  // 32/26 and 5 - 23/26·3 = 61/26, the backward errors 1 - 23/26·2 = -20/26 and 2 - 23/26·3 = -17/26. Order 2: 2
  // (32·-20 + 61·-17) / (32² + 61² + 20² + 17²) = -3354/5434.
  const Eigen::Vector4d value(1, 2, 3, 5);
  EXPECT_THAT(ReflectionCoefficients(value, Whole(value), 2),
              ElementsAre(DoubleNear(23.0 / 26, 1e-15), DoubleNear(-3354.0 / 5434, 1e-15)));
}

TEST(ReflectionCoefficients, UseTheSumsOfTwoParts) {
  // The sample between the spans belongs to neither.
  Eigen::VectorXd value(9);
  value << 1, 2, 3, 5, 1000, 5, 3, 2, 1;
  EXPECT_THAT(ReflectionCoefficients(value, {{0, 4}, {5, 4}}, 2),
              ElementsAre(DoubleNear(23.0 / 26, 1e-15), DoubleNear(-3354.0 / 5434, 1e-15)));
}

TEST(ReflectionCoefficients, EndAtPerfectPredictionAndAreZeroForZeros) {
  EXPECT_THAT(ReflectionCoefficients(Eigen::VectorXd::Ones(100), {{0, 100}}, 5), IsEmpty());
  EXPECT_THAT(ReflectionCoefficients(Eigen::VectorXd::Zero(100), {{0, 100}}, 5), ElementsAre(0, 0, 0, 0, 0));
}

TEST(ReflectionCoefficients, AcceptPartsShorterThanTheOrder) {
  const Eigen::VectorXd value = FirstOrderNoise(40, 0.5, 0, 1);
  EXPECT_THAT(ReflectionCoefficients(value, {{0, 3}, {3, 1}, {4, 36}}, 10), SizeIs(10));
}

TEST(ReflectionCoefficients, AreTheCorrelationOfAFirstOrderProcess) {
  const Eigen::VectorXd value = FirstOrderNoise(100'000, 0.8, 0, 1);
  // Each has a standard error of at most 1 / sqrt(N) = 0.003 (Kay & Makhoul, IEEE ASSP 31:56, 1983); the tolerance is
  // four standard errors.
  EXPECT_THAT(ReflectionCoefficients(value, Whole(value), 3),
              ElementsAre(DoubleNear(0.8, 0.013), DoubleNear(0, 0.013), DoubleNear(0, 0.013)));
}

TEST(CoefficientsFromReflection, MatchesAPolynomialComputedByHand) {
  // (0.5) -> (0.5 + 0.5·0.2, -0.2) = (0.6, -0.2) -> (0.6 - 0.3·-0.2, -0.2 - 0.3·0.6, 0.3).
  EXPECT_THAT(CoefficientsFromReflection({0.5, -0.2, 0.3}),
              ElementsAre(DoubleNear(0.66, 1e-15), DoubleNear(-0.38, 1e-15), DoubleNear(0.3, 1e-15)));
  EXPECT_THAT(CoefficientsFromReflection({}), IsEmpty());
}

}  // namespace
}  // namespace pendulum::burg_test
