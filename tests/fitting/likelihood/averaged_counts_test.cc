// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/averaged_counts.h"

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum::averaged_counts_test {
namespace {

double Normal(double u) { return 0.5 * std::erfc(-u / std::sqrt(2.0)); }

/// A mean to test: how it is taken, the value of its middle in counts, and σ.
struct Case {
  CountSum sum;
  double x = 0;
  double sigma = 0;
};

/// The distribution of the sum by definition: each reading shows level k with probability Φ(b) - Φ(a), and the sums of
/// all combinations are counted, in a map.
std::map<int, double> Enumerated(const Case& at) {
  std::map<int, double> sums = {{0, 1.0}};
  const int n = at.sum.readings;
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) / n - 0.5;
    const double value = at.x + at.sum.motion.slope * s + at.sum.motion.bend * s * s;
    std::map<int, double> next;
    for (int k = -12; k <= 12; ++k) {
      const double upper = k >= at.sum.high ? 1 : Normal((k + 0.5 - value) / at.sigma);
      const double lower = k <= at.sum.low ? 0 : Normal((k - 0.5 - value) / at.sigma);
      if (k > at.sum.high || k < at.sum.low || upper <= lower) continue;
      for (const auto& [sum, probability] : sums) next[sum + k] += probability * (upper - lower);
    }
    sums = std::move(next);
  }
  return sums;
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const int n : {2, 4, 16}) {
    for (const double sigma : {0.05, 0.1, 0.25, 0.5}) {
      for (const double slope : {0.0, 0.4, 5.0}) {
        Case at;
        at.sum.readings = n;
        at.sum.motion = {slope * uniform(generator), 0.3 * slope * uniform(generator)};
        at.x = 2 * uniform(generator);
        at.sigma = sigma;
        cases.push_back(at);
      }
    }
  }
  return cases;
}

TEST(CountSumLog, IsTheProbabilityOfAllCombinations) {
  for (Case at : Cases()) {
    for (const auto& [sum, probability] : Enumerated(at)) {
      if (probability < 1e-6 || (at.sum.readings >= 8 && at.sigma >= 0.4)) continue;
      at.sum.sum = sum;
      EXPECT_NEAR(std::exp(CountSumLog(at.sum, at.x, at.sigma)) / probability, 1, 1e-5)
          << at.sum.readings << " readings, sigma " << at.sigma << ", sum " << sum;
    }
  }
}

/// Where the sum is taken for a normal variable, its expectation, its variance and the bulk of its distribution are
/// those of the combinations.
TEST(CountSumLog, IsNearlyThatOfTheCombinationsForManyReadings) {
  for (const double x : {0.0, 0.2, 0.5}) {
    for (const double slope : {0.0, 0.7}) {
      Case at{{0, 16, {slope, 0}, -kInfinity, kInfinity}, x, 0.41};
      double mean = 0, square = 0, true_mean = 0, true_square = 0;
      for (const auto& [sum, probability] : Enumerated(at)) {
        at.sum.sum = sum;
        const double p = std::exp(CountSumLog(at.sum, at.x, at.sigma));
        mean += p * sum, square += p * sum * sum;
        true_mean += probability * sum, true_square += probability * sum * sum;
        EXPECT_NEAR(p, probability, 0.01);
      }
      EXPECT_NEAR(mean, true_mean, 2e-3);
      EXPECT_NEAR(square - mean * mean, true_square - true_mean * true_mean, 5e-3);
    }
  }
}

TEST(CountSumLog, SumsToOne) {
  for (Case at : Cases()) {
    double total = 0;
    for (int sum = -12 * at.sum.readings; sum <= 12 * at.sum.readings; ++sum) {
      at.sum.sum = sum;
      total += std::exp(CountSumLog(at.sum, at.x, at.sigma));
    }
    EXPECT_NEAR(total, 1, 1e-9) << at.sum.readings << " readings, sigma " << at.sigma;
  }
}

TEST(CountSumLog, IncludesWhatIsBeyondTheRange) {
  Case at{{0, 4, {}, -1, 1}, 1.2, 0.3};
  for (const auto& [sum, probability] : Enumerated(at)) {
    at.sum.sum = sum;
    if (probability < 1e-6) continue;
    EXPECT_NEAR(std::exp(CountSumLog(at.sum, at.x, at.sigma)) / probability, 1, 1e-5) << sum;
  }
}

TEST(CountSumDistribution, AddsUpTheProbabilities) {
  for (Case at : Cases()) {
    double below = 0;
    for (const auto& [sum, probability] : Enumerated(at)) {
      at.sum.sum = sum;
      const NoiseModel::Distribution u = CountSumDistribution(at.sum, at.x, at.sigma);
      const double tolerance = at.sum.readings >= 8 && at.sigma >= 0.4 ? 0.01 : 1e-9;
      EXPECT_NEAR(u.below, below, tolerance);
      EXPECT_NEAR(u.at, below + probability, tolerance);
      below += probability;
    }
  }
}

/// Central difference with Richardson's extrapolation.
double Slope(const std::function<double(double)>& f, double h) {
  const auto central = [&](double step) { return (f(step) - f(-step)) / (2 * step); };
  return (4 * central(h / 2) - central(h)) / 3;
}

TEST(CountSumLikelihood, HasTheDerivativesOfTheLogarithm) {
  constexpr double kStep = 1e-3;
  for (Case at : Cases()) {
    for (const auto& [sum, probability] : Enumerated(at)) {
      if (probability < 1e-3) continue;
      at.sum.sum = sum;
      const auto likelihood = [&](double x, double lambda) {
        return CountSumLikelihood(at.sum, at.x + x, at.sigma * std::exp(lambda));
      };
      const NoiseLikelihood l = likelihood(0, 0);
      const double h = kStep * at.sigma;
      const double scale = 1 / (at.sigma * at.sigma);
      EXPECT_NEAR(l.score, Slope([&](double x) { return likelihood(x, 0).log; }, h), 1e-5 * scale);
      EXPECT_NEAR(l.information, -Slope([&](double x) { return likelihood(x, 0).score; }, h), 1e-5 * scale);
      EXPECT_NEAR(l.sigma_score, Slope([&](double lambda) { return likelihood(0, lambda).log; }, kStep), 1e-5);
      EXPECT_NEAR(l.sigma_information, -Slope([&](double lambda) { return likelihood(0, lambda).sigma_score; }, kStep),
                  1e-5);
      EXPECT_NEAR(l.mixed, -Slope([&](double lambda) { return likelihood(0, lambda).score; }, kStep), 1e-5 * scale);
      const NoiseLikelihood without_sigma = CountSumSlope(at.sum, at.x, at.sigma);
      EXPECT_NEAR(without_sigma.log, l.log, 1e-12);
      EXPECT_NEAR(without_sigma.score, l.score, 1e-9 * scale);
      EXPECT_NEAR(without_sigma.information, l.information, 1e-9 * scale);
    }
  }
}

/// Normal, continuous noise of one reading: the mean of n has the variance (σ² + 1/12) / n (W. F. Sheppard, 1898).
TEST(CountSumLikelihood, IsNormalForLargeSigma) {
  for (const double sigma : {0.999 * kContinuousSigma, 1.001 * kContinuousSigma, 3.0}) {
    for (const int n : {16, 64}) {
      const double deviation = std::sqrt((sigma * sigma + 1.0 / 12) / n);
      for (const double z : {-2.0, -0.5, 0.0, 1.0, 2.0}) {
        CountSum sum;
        sum.readings = n;
        sum.sum = std::round(n * (0.3 + z * deviation));
        const double off = sum.sum / n - 0.3;
        const double normal =
            -0.5 * std::pow(off / deviation, 2) - std::log(n * deviation * std::sqrt(2 * std::acos(-1.0)));
        const NoiseLikelihood l = CountSumLikelihood(sum, 0.3, sigma);
        EXPECT_NEAR(l.log, normal, 0.02) << n << " readings, sigma " << sigma << ", z " << z;
        EXPECT_NEAR(l.score * deviation, off / deviation, 0.03);
        EXPECT_NEAR(l.information * deviation * deviation, 1, 0.05);
      }
    }
  }
}

TEST(CountSumLikelihood, LeadsBackFromImpossibleValues) {
  CountSum sum;
  sum.readings = 16;
  sum.sum = 5;
  for (const double x : {-30.0, -3.0, 4.0, 50.0}) {
    const NoiseLikelihood l = CountSumSlope(sum, x, 0.05);
    EXPECT_TRUE(std::isfinite(l.log));
    EXPECT_GT(l.score * (5.0 / 16 - x), 0);
    EXPECT_GT(l.information, 0);
  }
}

TEST(CountSumMargin, IsTheDistanceToTheNextChange) {
  CountSum sum;
  sum.readings = 2;
  sum.motion.slope = 0.4;  // the readings are 0.1 below and above the middle
  sum.sum = 4;
  EXPECT_NEAR(CountSumMargin(sum, 2.25), 0.15, 1e-12);
  EXPECT_NEAR(CountSumMargin(sum, 1.75), 0.15, 1e-12);
  EXPECT_EQ(CountSumMargin(sum, 2.45), 0);  // readings without noise would be 2 and 3
}

NoiseModel Means(int readings, double sigma) {
  NoiseModel noise;
  noise.family = NoiseFamily::kAveraged;
  noise.sigma = sigma;
  noise.averaging = {readings, 0.5, 0.1, nullptr, {}};
  noise.resolution = 0.5 / readings;
  return noise;
}

TEST(NoiseModel, OfOneReadingIsQuantized) {
  NoiseModel one = Means(1, 0.1);
  NoiseModel quantized = one;
  quantized.family = NoiseFamily::kQuantized;
  for (const double m : {0.4, 0.55, 0.7, 0.9}) {
    EXPECT_EQ(one.LikelihoodAt(0.6, m).log, quantized.LikelihoodAt(0.6, m).log);
    EXPECT_EQ(one.DevianceAt(0.6, m).score, quantized.DevianceAt(0.6, m).score);
  }
}

TEST(NoiseModel, OfMeansIsInUnitsOfTheReading) {
  const NoiseModel noise = Means(4, 0.1);
  const double h = 1e-5;
  const double y = 0.1 + 0.5 * 6 / 4;
  const NoiseLikelihood l = noise.LikelihoodAt(y, 0.8);
  EXPECT_NEAR(l.score, (noise.LikelihoodAt(y, 0.8 + h).log - noise.LikelihoodAt(y, 0.8 - h).log) / (2 * h), 1e-5);
  const SampleLikelihood sample = noise.DevianceAt(y, 0.8);
  EXPECT_NEAR(sample.deviance, -2 * l.log, 1e-9);
  EXPECT_NEAR(sample.score, l.score, 1e-9);
  EXPECT_NEAR(sample.weight, l.information, 1e-6);
  EXPECT_TRUE(noise.IsInterval(y));
}

TEST(NoiseModel, HasTheMotionOfEachMean) {
  NoiseModel noise = Means(4, 0.05);
  noise.averaging.motions =
      std::make_shared<const std::vector<WindowMotion>>(std::vector<WindowMotion>{{0, 0}, {1.5, 0}, {0.2, 0.1}});
  EXPECT_EQ(noise.ForSample(1).averaging.motion.slope, 1.5);
  EXPECT_EQ(noise.From(1).ForSample(1).averaging.motion.bend, 0.1);
  // At rest all four readings show the level 0.6; spread over three counts they also do on average.
  EXPECT_GT(noise.ForSample(0).LikelihoodAt(0.6, 0.6).log, -1e-5);
  EXPECT_NEAR(noise.ForSample(1).LikelihoodAt(0.6, 0.6).log, noise.ForSample(1).LikelihoodAt(1.1, 1.1).log, 1e-9);
}

}  // namespace
}  // namespace pendulum::averaged_counts_test
