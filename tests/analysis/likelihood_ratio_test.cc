// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/likelihood_ratio.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::likelihood_ratio_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

// S. G. Self & K.-Y. Liang, JASA 82:605 (1987), cases 5 and 7: one and two bounded parameters.
TEST(WeightsAtBound, MatchSelfAndLiang) {
  EXPECT_THAT(WeightsAtBound(0, 1), ElementsAre(0, 1));
  EXPECT_THAT(WeightsAtBound(1, 0), ElementsAre(0.5, 0.5));
  EXPECT_THAT(WeightsAtBound(1, 1), ElementsAre(0, 0.5, 0.5));
  EXPECT_THAT(WeightsAtBound(2, 0, 0.0), ElementsAre(0.25, 0.5, 0.25));
}

// 5 % points: 3.8415 for χ²(1); 2.7055 for half χ²(0), half χ²(1); 4.2306 for weights 1/4, 1/2, 1/4 (Self & Liang).
TEST(ChiBarTail, HasTheTabulatedFivePercentPoints) {
  EXPECT_THAT(ChiBarTail(WeightsAtBound(0, 1), 3.841459), DoubleNear(0.05, 1e-6));
  EXPECT_THAT(ChiBarTail(WeightsAtBound(1, 0), 2.705543), DoubleNear(0.05, 1e-6));
  EXPECT_THAT(ChiBarTail(WeightsAtBound(2, 0, 0.0), 4.2306), DoubleNear(0.05, 1e-4));
}

TEST(ChiBarTail, IsOneIfTheStatisticIsNotPositive) {
  EXPECT_EQ(ChiBarTail(WeightsAtBound(1, 0), 0), 1);
  EXPECT_EQ(ChiBarTail(WeightsAtBound(2, 0, 0.3), -1), 1);
}

// The statistic of two bounded means of a normal pair with known covariance, computed from the four faces of the
// quadrant. It is an independent simulation of the weights.
TEST(ChiBarTail, MatchesASimulatedProjectionOnTheQuadrant) {
  for (const double correlation : {-0.9, 0.0, 0.6}) {
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal;
    const double other = std::sqrt(1 - correlation * correlation);
    constexpr int kDraws = 40'000;
    int beyond = 0;
    for (int i = 0; i < kDraws; ++i) {
      const double a = normal(generator);
      const double b = correlation * a + other * normal(generator);
      const double both = (a * a - 2 * correlation * a * b + b * b) / (other * other);
      // The remaining distance when one mean is held at 0 and the other is fitted.
      const double held_a = b - correlation * a, held_b = a - correlation * b;
      const double left_b = held_a > 0 ? a * a : both, left_a = held_b > 0 ? b * b : both;
      const double left = a > 0 && b > 0 ? 0 : std::min({left_a, left_b, both});
      if (both - left > 3) ++beyond;
    }
    const double expected = ChiBarTail(WeightsAtBound(2, 0, correlation), 3);
    const double scatter = std::sqrt(expected * (1 - expected) / kDraws);
    EXPECT_THAT(beyond / static_cast<double>(kDraws), DoubleNear(expected, 4 * scatter)) << correlation;
  }
}

TEST(DescribeMixture, DescribesTheMixtureInWords) {
  EXPECT_EQ(DescribeMixture(WeightsAtBound(0, 1)), "χ²(1)");
  EXPECT_EQ(DescribeMixture(WeightsAtBound(1, 0)), "half χ²(0), half χ²(1)");
  EXPECT_EQ(DescribeMixture(WeightsAtBound(2, 0, 0.0)), "a quarter χ²(0), half χ²(1), a quarter χ²(2)");
}

}  // namespace
}  // namespace pendulum::likelihood_ratio_test
