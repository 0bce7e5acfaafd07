// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residual_diagnostics.h"

#include <cmath>
#include <cstdint>
#include <random>

#include <boost/math/distributions/normal.hpp>
#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using testing::DoubleNear;

/// Four residuals whose sums are in the head: Σ r² = 6, Σ r_i r_{i-1} = -3, Σ (r_i - r_{i-1})² = 17.
const Eigen::Vector4d kFour(1, -1, 2, 0);

/// Residuals that look like noise and are none: 1 + sin of a fast phase, scaled.
Eigen::VectorXd Scattered(Eigen::Index count) {
  return Eigen::ArrayXd::LinSpaced(count, 1, static_cast<double>(count)).unaryExpr([](double i) {
    return 0.01 * std::sin(i * i);
  });
}

TEST(ComputeStatistics, AgreesWithFourResidualsReckonedByHand) {
  const FitStatistics statistics = ComputeStatistics(kFour, 1, 0);
  EXPECT_THAT(statistics.rms_residual, DoubleNear(1.224744871391589, 1e-15));     // sqrt(6 / 4)
  EXPECT_THAT(statistics.log_likelihood, DoubleNear(-6.486684349035020, 1e-13));  // -4/2 (ln(2 π 6/4) + 1)
  EXPECT_THAT(statistics.aic, DoubleNear(4 + 12.97336869807004, 1e-12));          // k = 2: one parameter and sigma
  EXPECT_THAT(statistics.aicc, DoubleNear(4 + 12.97336869807004 + 12, 1e-12));    // + 2 k (k + 1) / (N - k - 1)
  EXPECT_THAT(statistics.bic, DoubleNear(2.772588722239781 + 12.97336869807004, 1e-12));  // 2 ln 4
  EXPECT_THAT(statistics.durbin_watson, DoubleNear(17.0 / 6, 1e-15));
}

TEST(ComputeStatistics, LogLikelihoodIsTheSumOfNormalLogDensities) {
  const Eigen::VectorXd residual = Scattered(500);
  const boost::math::normal normal(0, std::sqrt(residual.squaredNorm() / 500));
  double expected = 0;
  for (const double r : residual) expected += std::log(boost::math::pdf(normal, r));
  EXPECT_THAT(ComputeStatistics(residual, 5, 0).log_likelihood, DoubleNear(expected, 1e-9));
}

TEST(ComputeStatistics, ADensityTimesTheResolutionIsAProbability) {
  const Eigen::VectorXd residual = Scattered(500);
  const FitStatistics density = ComputeStatistics(residual, 5, 0);
  const FitStatistics probability = ComputeStatistics(residual, 5, 0.003);
  EXPECT_THAT(probability.log_likelihood - density.log_likelihood, DoubleNear(500 * std::log(0.003), 1e-9));
  EXPECT_THAT(density.bic - probability.bic, DoubleNear(1000 * std::log(0.003), 1e-9));
  EXPECT_EQ(probability.durbin_watson, density.durbin_watson);
}

TEST(ComputeStatistics, EachFreeParameterCostsTwoInAicAndLogNInBic) {
  const Eigen::VectorXd residual = Scattered(500);
  const FitStatistics five = ComputeStatistics(residual, 5, 0);
  const FitStatistics six = ComputeStatistics(residual, 6, 0);
  EXPECT_THAT(six.aic - five.aic, DoubleNear(2, 1e-9));
  EXPECT_THAT(six.bic - five.bic, DoubleNear(std::log(500), 1e-9));
  EXPECT_EQ(six.log_likelihood, five.log_likelihood);
}

TEST(ComputeStatistics, DurbinWatsonTellsAlternatingFromConstantFromScattered) {
  Eigen::VectorXd alternating = Eigen::VectorXd::Ones(1000);
  for (Eigen::Index i = 1; i < 1000; i += 2) alternating[i] = -1;
  EXPECT_THAT(ComputeStatistics(alternating, 1, 0).durbin_watson, DoubleNear(4, 0.01));
  EXPECT_EQ(ComputeStatistics(Eigen::VectorXd::Ones(1000), 1, 0).durbin_watson, 0);
  EXPECT_THAT(ComputeStatistics(Scattered(2000), 1, 0).durbin_watson, DoubleNear(2, 0.2));
}

TEST(ComputeStatistics, StaysFiniteForAPerfectFit) {
  const FitStatistics statistics = ComputeStatistics(Eigen::VectorXd::Zero(100), 5, 0.001);
  EXPECT_THAT(statistics.rms_residual, DoubleNear(0, 1e-150));
  EXPECT_TRUE(std::isfinite(statistics.log_likelihood));
  EXPECT_TRUE(std::isfinite(statistics.bic));
  EXPECT_EQ(statistics.durbin_watson, 0);
}

TEST(Lag1Correlation, OfKnownSequences) {
  EXPECT_EQ(Lag1Correlation(kFour), -0.5);
  EXPECT_THAT(Lag1Correlation(Eigen::VectorXd::Ones(1000)), DoubleNear(0.999, 1e-12));
  EXPECT_EQ(Lag1Correlation(Eigen::VectorXd::Zero(10)), 0);
}

Eigen::VectorXd WhiteNoise(Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(count, [&] { return normal(generator); });
}

TEST(FollowEachOther, IsNotSaidOfWhiteNoise) {
  int said = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) said += FollowEachOther(WhiteNoise(1000, seed), 130) ? 1 : 0;
  // χ² with 50 degrees of freedom is six standard deviations above its mean in 2e-6 of all cases.
  EXPECT_EQ(said, 0);
}

TEST(FollowEachOther, IsSaidOfNoiseThatRemembers) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Eigen::VectorXd noise = WhiteNoise(2000, seed);
    for (Eigen::Index i = 1; i < noise.size(); ++i) noise[i] += 0.3 * noise[i - 1];
    EXPECT_TRUE(FollowEachOther(noise, 130)) << seed;
  }
}

TEST(FollowEachOther, IsSaidOfAMisfitThatSwingsUnderTheNoise) {
  // Period 130 samples, a third of the variance.
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(2000, 0, 2000 * 2 * kPi / 130);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(FollowEachOther(WhiteNoise(2000, seed) + phase.sin().matrix(), 130)) << seed;
  }
}

TEST(FollowEachOther, TakesAnyNumberOfResidualsAndLags) {
  for (const int lags : {-1, 0, 1, 130, 1'000'000'000}) {
    EXPECT_FALSE(FollowEachOther(Eigen::VectorXd::Zero(100), lags)) << lags;
    EXPECT_FALSE(FollowEachOther(Eigen::VectorXd::Unit(8, 3), lags)) << lags;
  }
}

/// 20 s at 100 Hz of a swing of 5 rad/s: 15 periods.
struct SwingExample {
  static constexpr double kPeriod = 2 * kPi / 5;
  Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(2000, 0, 19.99);
  Eigen::VectorXd fitted = (0.4 * (-0.02 * time.array()).exp() * (5 * time.array()).cos()).matrix();
  /// Of the readings, over its norm in one period: an error of one standard error there for a noise of 1.
  Eigen::VectorXd rate = (-(5 * time.array()).sin() / std::sqrt(0.5 * 100 * kPeriod)).matrix();
};

TEST(SwingAlong, IsSaidOfWhiteNoiseAsSeldomAsItSays) {
  const SwingExample swing;
  int said = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    said += SwingAlong(swing.time, swing.fitted, WhiteNoise(2000, seed), SwingExample::kPeriod) ? 1 : 0;
  }
  // Two sums at 1e-4 each: 0.4 are expected, and more than three have p < 0.001.
  EXPECT_LE(said, 3);
}

TEST(SwingAlong, IsSaidOfAPhaseErrorThatGrows) {
  // By 0.3 standard errors in each period: 4.5 in the last one, where the samples' own are 0.03 of the noise.
  const SwingExample swing;
  const Eigen::VectorXd error = (0.3 * swing.time.array() / SwingExample::kPeriod * swing.rate.array()).matrix();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(SwingAlong(swing.time, swing.fitted, WhiteNoise(2000, seed) + error, SwingExample::kPeriod)) << seed;
  }
}

TEST(SwingAlong, IsSaidOfAKick) {
  // From the middle on the phase is off by three standard errors in each period.
  const SwingExample swing;
  Eigen::VectorXd error = 3 * swing.rate;
  error.head(1000).setZero();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd residual = WhiteNoise(2000, seed) + error;
    EXPECT_TRUE(SwingAlong(swing.time, swing.fitted, residual, SwingExample::kPeriod)) << seed;
  }
}

TEST(SwingAlong, IsNotSaidOfTooLittleOrOfNothing) {
  const SwingExample swing;
  EXPECT_FALSE(SwingAlong(swing.time, swing.fitted, Eigen::VectorXd::Zero(2000), SwingExample::kPeriod));
  EXPECT_FALSE(SwingAlong(swing.time, swing.fitted, 100 * swing.rate, 6.0));  // three periods
  const Eigen::VectorXd still = Eigen::VectorXd::Constant(2000, 0.3);         // has no phase
  EXPECT_FALSE(SwingAlong(swing.time, still, swing.rate, SwingExample::kPeriod));
}

}  // namespace
}  // namespace pendulum
