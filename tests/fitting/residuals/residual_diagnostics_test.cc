// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/residual_diagnostics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include <boost/math/distributions/normal.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/student_t_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::residual_diagnostics_test {
namespace {

using testing::DoubleNear;

/// Four residuals with sums that are easy to compute: Σ r² = 6, Σ r_i r_{i-1} = -3, Σ (r_i - r_{i-1})² = 17.
const Eigen::Vector4d kFour(1, -1, 2, 0);

/// Deterministic residuals that look like noise: 0.01 times the sine of a fast phase.
Eigen::VectorXd Scattered(Eigen::Index count) {
  return Eigen::ArrayXd::LinSpaced(count, 1, static_cast<double>(count)).unaryExpr([](double i) {
    return 0.01 * std::sin(i * i);
  });
}

/// Statistics of a fit with large quantile residuals and small residuals.
FitStatistics StatisticsOf(const Eigen::VectorXd& quantile_residual, double log_likelihood, int free_parameters) {
  return ComputeStatistics(0.01 * quantile_residual, quantile_residual, log_likelihood, free_parameters);
}

TEST(ComputeStatistics, MatchesFourResidualsComputedByHand) {
  // The likelihood of these four residuals is -4/2 (ln(2 π 6/4) + 1); k = 2: one parameter and sigma.
  const FitStatistics statistics = ComputeStatistics(kFour, kFour, -6.486684349035020, 1);
  EXPECT_THAT(statistics.rms_residual, DoubleNear(1.224744871391589, 1e-15));  // sqrt(6 / 4)
  EXPECT_EQ(statistics.log_likelihood, -6.486684349035020);
  EXPECT_THAT(statistics.aic, DoubleNear(4 + 12.97336869807004, 1e-12));
  EXPECT_THAT(statistics.aicc, DoubleNear(4 + 12.97336869807004 + 12, 1e-12));            // + 2 k (k + 1) / (N - k - 1)
  EXPECT_THAT(statistics.bic, DoubleNear(2.772588722239781 + 12.97336869807004, 1e-12));  // 2 ln 4
  EXPECT_THAT(statistics.durbin_watson, DoubleNear(17.0 / 6, 1e-15));
  EXPECT_EQ(statistics.effective_samples, 4);
}

TEST(ComputeStatistics, TakesSizesFromResidualsAndOrderFromQuantileResiduals) {
  const Eigen::Vector4d still(0.5, 0.5, 0.5, 0.5);
  const FitStatistics statistics = ComputeStatistics(still, kFour, 0, 1);
  EXPECT_EQ(statistics.rms_residual, 0.5);
  EXPECT_THAT(statistics.durbin_watson, DoubleNear(17.0 / 6, 1e-15));
  const Eigen::VectorXd scattered = Scattered(500);
  const FitStatistics others = ComputeStatistics(Eigen::VectorXd::Ones(500), scattered, 0, 1);
  EXPECT_EQ(others.ljung_box_p, LjungBoxP(scattered));
  EXPECT_EQ(others.runs_p, RunsP(scattered));
}

TEST(ComputeStatistics, EachFreeParameterCostsTwoInAicAndLogNInBic) {
  const FitStatistics five = StatisticsOf(Scattered(500), 100, 5);
  const FitStatistics six = StatisticsOf(Scattered(500), 100, 6);
  EXPECT_THAT(six.aic - five.aic, DoubleNear(2, 1e-9));
  EXPECT_THAT(six.bic - five.bic, DoubleNear(std::log(500), 1e-9));
  EXPECT_EQ(six.log_likelihood, five.log_likelihood);
}

TEST(ComputeStatistics, DurbinWatsonDistinguishesAlternatingConstantAndRandom) {
  Eigen::VectorXd alternating = Eigen::VectorXd::Ones(1000);
  for (Eigen::Index i = 1; i < 1000; i += 2) alternating[i] = -1;
  EXPECT_THAT(StatisticsOf(alternating, 0, 1).durbin_watson, DoubleNear(4, 0.01));
  EXPECT_EQ(StatisticsOf(Eigen::VectorXd::Ones(1000), 0, 1).durbin_watson, 0);
  EXPECT_THAT(StatisticsOf(Scattered(2000), 0, 1).durbin_watson, DoubleNear(2, 0.2));
}

TEST(ComputeStatistics, StaysFiniteForAPerfectFit) {
  const FitStatistics statistics = StatisticsOf(Eigen::VectorXd::Zero(100), 5e4, 5);
  EXPECT_THAT(statistics.rms_residual, DoubleNear(0, 1e-150));
  EXPECT_TRUE(std::isfinite(statistics.bic));
  EXPECT_EQ(statistics.durbin_watson, 0);
  EXPECT_EQ(statistics.ljung_box_p, 1);
  EXPECT_EQ(statistics.runs_p, 1);
}

TEST(Lag1Correlation, MatchesKnownSequences) {
  EXPECT_EQ(Lag1Correlation(kFour), -0.5);
  EXPECT_THAT(Lag1Correlation(Eigen::VectorXd::Ones(1000)), DoubleNear(0.999, 1e-12));
  EXPECT_EQ(Lag1Correlation(Eigen::VectorXd::Zero(10)), 0);
}

Eigen::VectorXd WhiteNoise(Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(count, [&] { return normal(generator); });
}

// ---- Independence --------------------------------------------------------------------------------------------------

/// ++--++--++: Σ r² = 10, Σ r_i r_{i-1} = 1, Σ r_i r_{i-2} = -8; five runs of six and four signs.
Eigen::VectorXd Pairs() {
  Eigen::VectorXd pairs(10);
  pairs << 1, 1, -1, -1, 1, 1, -1, -1, 1, 1;
  return pairs;
}

/// Share of 4000 white series for which a test gives less than 5 %; its standard deviation is 0.0035.
double RejectedShare(const std::function<double(const Eigen::VectorXd&)>& test) {
  constexpr int kSeries = 4000;
  int rejected = 0;
  for (std::uint64_t seed = 1; seed <= kSeries; ++seed) rejected += test(WhiteNoise(500, seed)) < 0.05 ? 1 : 0;
  return static_cast<double>(rejected) / kSeries;
}

TEST(LjungBoxP, MatchesTenResidualsComputedByHand) {
  // N (N + 2) (ρ₁² / 9 + ρ₂² / 8) = 120 (0.01 / 9 + 0.64 / 8), and χ² with two degrees of freedom is exponential.
  const double portmanteau = 120 * (0.01 / 9 + 0.64 / 8);
  EXPECT_THAT(LjungBoxP(Pairs()), DoubleNear(std::exp(-portmanteau / 2), 1e-14));
  EXPECT_THAT(LjungBoxP(-7 * Pairs()), DoubleNear(std::exp(-portmanteau / 2), 1e-14));
}

TEST(LjungBoxP, RejectsWhiteNoiseInFivePercentOfSeries) {
  // Four standard deviations about .0524, the value for NumPy's normal noise in 20000 series with 20 lags.
  EXPECT_THAT(RejectedShare(LjungBoxP), DoubleNear(0.0524, 0.014));
}

TEST(LjungBoxP, IsSmallForCorrelationWithinTwentyLags) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd noise = WhiteNoise(2000, seed);
    Eigen::VectorXd echo = noise;
    echo.tail(1980) += 0.4 * noise.head(1980);  // ρ₂₀ = 0.4 / 1.16 adds 238, of which χ² has p = 1e-39
    EXPECT_LT(LjungBoxP(echo), 1e-20) << seed;
    echo = noise;
    echo.tail(1979) += 0.4 * noise.head(1979);  // a lag beyond the 20
    EXPECT_GT(LjungBoxP(echo), 1e-7) << seed;
  }
}

TEST(LjungBoxP, IsOneWithoutResiduals) {
  EXPECT_EQ(LjungBoxP(Eigen::VectorXd::Zero(100)), 1);
  EXPECT_EQ(LjungBoxP(kFour), 1);  // N / 5 lags is 0
}

TEST(RunsP, MatchesSequencesComputedByHand) {
  // 5 runs; mean 2 · 6 · 4 / 10 + 1 = 5.8, variance 48 · 38 / (100 · 9) = 2.0267: 0.56195 standard deviations.
  EXPECT_THAT(RunsP(Pairs()), DoubleNear(0.5741491, 1e-7));
  Eigen::VectorXd halves = Eigen::VectorXd::Ones(20);
  halves.tail(10) *= -1;
  // 2 runs; mean 11, variance 200 · 180 / (400 · 19) = 4.7368: 4.1352 standard deviations below.
  EXPECT_THAT(RunsP(halves), DoubleNear(3.546e-5, 1e-8));
  Eigen::VectorXd alternating = Eigen::VectorXd::Ones(20);
  for (Eigen::Index i = 1; i < 20; i += 2) alternating[i] = -1;
  EXPECT_THAT(RunsP(alternating), DoubleNear(3.546e-5, 1e-8));  // 20 runs, equally far above the mean
}

TEST(RunsP, IsOneIfAllResidualsHaveOneSign) {
  EXPECT_EQ(RunsP(Eigen::VectorXd::Ones(100)), 1);
  EXPECT_EQ(RunsP(-Eigen::VectorXd::Ones(100)), 1);
}

TEST(RunsP, RejectsWhiteNoiseInFivePercentOfSeries) {
  // The number of runs is an integer, so the level is met only to 0.009, the probability of one number at its edge.
  EXPECT_THAT(RejectedShare(RunsP), DoubleNear(0.05, 0.015));
}

// ---- Quantile residuals --------------------------------------------------------------------------------------------

/// 20000 readings of a swing of that amplitude, and their values with noise of 1.
struct NoisyReadings {
  Eigen::VectorXd readings;
  Eigen::VectorXd value;

  NoisyReadings(double amplitude, std::uint64_t seed) {
    constexpr Eigen::Index kCount = 20000;
    readings = (amplitude * Eigen::ArrayXd::LinSpaced(kCount, 0, 97).sin()).matrix();
    value = readings + WhiteNoise(kCount, seed);
  }
};

/// Largest distance between the distribution of z and the standard normal distribution.
double KolmogorovDistance(Eigen::VectorXd z) {
  const boost::math::normal normal;
  std::sort(z.begin(), z.end());
  const auto n = static_cast<double>(z.size());
  double distance = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double below = static_cast<double>(i) / n;
    const double probability = boost::math::cdf(normal, z[i]);
    distance = std::max({distance, probability - below, below + 1 / n - probability});
  }
  return distance;
}

/// Expects mean, variance and correlation within four standard deviations (exceeded with p = 6e-5), and the
/// Kolmogorov-Smirnov distance below the value that is exceeded with p = 1e-3.
void ExpectStandardNormalAndIndependent(const Eigen::VectorXd& z) {
  const auto n = static_cast<double>(z.size());
  EXPECT_THAT(z.mean(), DoubleNear(0, 4 / std::sqrt(n)));
  EXPECT_THAT(z.squaredNorm() / n, DoubleNear(1, 4 * std::sqrt(2 / n)));
  EXPECT_LT(KolmogorovDistance(z), 1.95 / std::sqrt(n));
  EXPECT_THAT(Lag1Correlation(z), DoubleNear(0, 4 / std::sqrt(n)));
}

NoiseModel Quantized(double resolution) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.resolution = resolution;
  return noise;
}

Eigen::VectorXd Rounded(const Eigen::VectorXd& value, double resolution) {
  return (resolution * (value.array() / resolution).round()).matrix();
}

TEST(QuantileResiduals, AreStandardNormalForAnyRounding) {
  for (const double sigma : {0.1, 0.3, 1.0}) {  // in resolutions
    SCOPED_TRACE(sigma);
    const double q = 1 / sigma;
    const NoisyReadings run(45 * q, 1);
    const NoiseModel noise = Quantized(q);
    ExpectStandardNormalAndIndependent(QuantileResiduals(noise, Rounded(run.value, q), run.readings));
  }
}

TEST(QuantileResiduals, AreStandardNormalForCensoredReadings) {
  for (const double q : {0.0, 1.0, 10.0}) {  // in σ; 0: not rounded
    SCOPED_TRACE(q);
    const double amplitude = 45 * std::max(q, 1.0);
    const NoisyReadings run(amplitude, 2);
    // The range ends at levels 30 and -35, where a third of all readings lie.
    const double unit = std::max(q, 1.0);
    Eigen::VectorXd value = q > 0 ? Rounded(run.value, q) : run.value;
    value = value.cwiseMin(30 * unit).cwiseMax(-35 * unit);
    NoiseModel noise = q > 0 ? Quantized(q) : NoiseModel{};
    noise.high = 30 * unit - 0.5 * q;
    noise.low = -35 * unit + 0.5 * q;
    ExpectStandardNormalAndIndependent(QuantileResiduals(noise, value, run.readings));
  }
}

TEST(QuantileResiduals, AreNormalForStudentsNoise) {
  NoisyReadings run(45, 3);
  std::mt19937_64 generator(4);
  boost::random::student_t_distribution<double> student(NoiseModel::kStudentFreedom);
  for (Eigen::Index i = 0; i < run.value.size(); ++i) run.value[i] = run.readings[i] + 0.1 * student(generator);
  NoiseModel noise;
  noise.family = NoiseFamily::kStudent;
  noise.sigma = 0.1;
  ExpectStandardNormalAndIndependent(QuantileResiduals(noise, run.value, run.readings));
}

TEST(QuantileResiduals, AreResidualsOverSigmaForPlainNoise) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const Eigen::VectorXd z = QuantileResiduals(noise, kFour, Eigen::Vector4d(1, 1, 1, 1));
  EXPECT_EQ(z, Eigen::VectorXd(Eigen::Vector4d(0, -4, 2, -2)));
}

TEST(QuantileResiduals, AreReproducible) {
  const NoisyReadings run(45, 1);
  const Eigen::VectorXd value = Rounded(run.value, 5);
  EXPECT_EQ(QuantileResiduals(Quantized(5), value, run.readings), QuantileResiduals(Quantized(5), value, run.readings));
}

TEST(QuantileResiduals, StayFiniteFarFromTheModel) {
  NoiseModel noise = Quantized(1);
  noise.sigma = 1e-3;
  noise.high = 2.5;
  const Eigen::VectorXd z = QuantileResiduals(noise, Eigen::Vector3d(0, 3, 0), Eigen::Vector3d(1000, -1000, -1000));
  EXPECT_TRUE(z.allFinite());
  EXPECT_LT(z[0], -7);
  EXPECT_GT(z[1], 7);
  EXPECT_GT(z[2], 7);
}

// ---- Autocorrelated residuals ---------------------------------------------------------------------------------------

TEST(AreAutocorrelated, IsFalseForWhiteNoise) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) alarms += AreAutocorrelated(WhiteNoise(1000, seed), 130) ? 1 : 0;
  // χ² with 50 degrees of freedom is six standard deviations above its mean in 2e-6 of all cases.
  EXPECT_EQ(alarms, 0);
}

TEST(AreAutocorrelated, IsTrueForAutocorrelatedNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Eigen::VectorXd noise = WhiteNoise(2000, seed);
    for (Eigen::Index i = 1; i < noise.size(); ++i) noise[i] += 0.3 * noise[i - 1];
    EXPECT_TRUE(AreAutocorrelated(noise, 130)) << seed;
  }
}

TEST(AreAutocorrelated, IsTrueForAMisfitBelowTheNoise) {
  // Period 130 samples, a third of the variance.
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(2000, 0, 2000 * 2 * kPi / 130);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(AreAutocorrelated(WhiteNoise(2000, seed) + phase.sin().matrix(), 130)) << seed;
  }
}

TEST(AreAutocorrelated, AcceptsAnyNumberOfResidualsAndLags) {
  for (const int lags : {-1, 0, 1, 130, 1'000'000'000}) {
    EXPECT_FALSE(AreAutocorrelated(Eigen::VectorXd::Zero(100), lags)) << lags;
    EXPECT_FALSE(AreAutocorrelated(Eigen::VectorXd::Unit(8, 3), lags)) << lags;
  }
}

/// 20 s at 100 Hz of a swing of 5 rad/s: 15 periods.
struct SwingExample {
  static constexpr double kPeriod = 2 * kPi / 5;
  Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(2000, 0, 19.99);
  Eigen::VectorXd fitted = (0.4 * (-0.02 * time.array()).exp() * (5 * time.array()).cos()).matrix();
  /// Rate of the readings, divided by its norm over one period: added to white noise of 1, it is a phase error of one
  /// standard error per period.
  Eigen::VectorXd rate = (-(5 * time.array()).sin() / std::sqrt(0.5 * 100 * kPeriod)).matrix();
};

TEST(HavePhaseOrAmplitudeErrors, HasTheStatedFalseAlarmRate) {
  const SwingExample swing;
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const Eigen::VectorXd noise = WhiteNoise(2000, seed);
    alarms += HavePhaseOrAmplitudeErrors(swing.time, swing.fitted, noise, SwingExample::kPeriod) ? 1 : 0;
  }
  // Two sums at 1e-4 each: 0.4 are expected, and more than three have p < 0.001.
  EXPECT_LE(alarms, 3);
}

TEST(HavePhaseOrAmplitudeErrors, DetectsAGrowingPhaseError) {
  // It grows by 0.3 standard errors per period: 4.5 in the last period, where each sample's error is 0.03 of the noise.
  const SwingExample swing;
  const Eigen::VectorXd error = (0.3 * swing.time.array() / SwingExample::kPeriod * swing.rate.array()).matrix();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(
        HavePhaseOrAmplitudeErrors(swing.time, swing.fitted, WhiteNoise(2000, seed) + error, SwingExample::kPeriod))
        << seed;
  }
}

TEST(HavePhaseOrAmplitudeErrors, DetectsAKick) {
  // From the middle on the phase is wrong by three standard errors in each period.
  const SwingExample swing;
  Eigen::VectorXd error = 3 * swing.rate;
  error.head(1000).setZero();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd residual = WhiteNoise(2000, seed) + error;
    EXPECT_TRUE(HavePhaseOrAmplitudeErrors(swing.time, swing.fitted, residual, SwingExample::kPeriod)) << seed;
  }
}

TEST(HavePhaseOrAmplitudeErrors, IsFalseForTooFewSamples) {
  const SwingExample swing;
  EXPECT_FALSE(
      HavePhaseOrAmplitudeErrors(swing.time, swing.fitted, Eigen::VectorXd::Zero(2000), SwingExample::kPeriod));
  EXPECT_FALSE(HavePhaseOrAmplitudeErrors(swing.time, swing.fitted, 100 * swing.rate, 6.0));  // three periods
  const Eigen::VectorXd still = Eigen::VectorXd::Constant(2000, 0.3);                         // a constant has no phase
  EXPECT_FALSE(HavePhaseOrAmplitudeErrors(swing.time, still, swing.rate, SwingExample::kPeriod));
}

}  // namespace
}  // namespace pendulum::residual_diagnostics_test
