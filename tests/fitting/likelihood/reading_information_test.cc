// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/reading_information.h"

#include <cmath>
#include <map>
#include <optional>

#include <boost/math/distributions/normal.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum::reading_information_test {
namespace {

using testing::DoubleNear;

constexpr SensorRange kNarrow = {-1, 2};  // levels -1, 0, 1, 2 at a resolution of 1

/// The probability of each reading, from Boost's normal distribution and the levels of SensorReading.
std::map<double, double> Probabilities(double x, double sigma, const std::optional<SensorRange>& range) {
  const boost::math::normal noise(x, sigma);
  std::map<double, double> probabilities;
  for (int k = -60; k <= 60; ++k) {
    const double below = k == -60 ? 0.0 : cdf(noise, k - 0.5);
    const double mass =
        k < x ? cdf(noise, k + 0.5) - below : cdf(complement(noise, k - 0.5)) - cdf(complement(noise, k + 0.5));
    probabilities[SensorReading(k, 1, range)] += mass;
  }
  return probabilities;
}

/// Σ ∇p ∇pᵀ / p over (x, log σ), ∇ by central differences.
Eigen::Matrix2d InformationByDifferences(double x, double sigma, const std::optional<SensorRange>& range) {
  constexpr double kStep = 1e-5;
  const auto middle = Probabilities(x, sigma, range);
  const auto right = Probabilities(x + kStep * sigma, sigma, range);
  const auto left = Probabilities(x - kStep * sigma, sigma, range);
  const auto wide = Probabilities(x, sigma * std::exp(kStep), range);
  const auto narrow = Probabilities(x, sigma * std::exp(-kStep), range);
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (const auto& [reading, probability] : middle) {
    if (probability < 1e-12) continue;
    const Eigen::Vector2d slope((right.at(reading) - left.at(reading)) / (2 * kStep * sigma),
                                (wide.at(reading) - narrow.at(reading)) / (2 * kStep));
    information += slope * slope.transpose() / probability;
  }
  return information;
}

TEST(ReadingInformation, IsTheNormalInformationWithoutLevels) {
  const Eigen::Matrix2d information = ReadingInformation(0.3, 0.2, 0, {});
  EXPECT_DOUBLE_EQ(information(0, 0), 25);
  EXPECT_DOUBLE_EQ(information(1, 1), 2);
  EXPECT_EQ(information(0, 1), 0);
}

// A comparator at its threshold leaves 2/π of the information, for any noise.
TEST(ReadingInformation, IsTwoOverPiAtTheThresholdOfAComparator) {
  for (const double sigma : {0.01, 1.0, 50.0}) {
    const Eigen::Matrix2d information = ReadingInformation(0, sigma, 1, SensorRange{-0.5, 0.5});
    EXPECT_THAT(information(0, 0) * sigma * sigma, DoubleNear(2 / kPi, 1e-14)) << sigma;
    EXPECT_THAT(information(0, 1), DoubleNear(0, 1e-14));
    EXPECT_THAT(information(1, 1), DoubleNear(0, 1e-14));
  }
}

TEST(ReadingInformation, IsTheSumOverAllReadings) {
  for (const std::optional<SensorRange>& range : {std::optional<SensorRange>(), std::optional(kNarrow)}) {
    for (const double sigma : {0.1, 0.3, 0.5, 2.5}) {
      for (const double x : {-2.0, -1.3, 0.0, 0.2, 0.49, 1.7, 3.1}) {
        const Eigen::Matrix2d expected = InformationByDifferences(x, sigma, range);
        const Eigen::Matrix2d information = ReadingInformation(x, sigma, 1, range);
        // Differences of probabilities have rounding errors of 1e-16, divided twice by a step of 1e-5 σ.
        const double tolerance = 1e-6 * std::max(1.0, 1 / (sigma * sigma));
        EXPECT_TRUE(information.isApprox(expected, 1e-6) || (information - expected).norm() < tolerance)
            << "x " << x << ", sigma " << sigma << "\n"
            << information << "\nis not\n"
            << expected;
      }
    }
  }
}

// Levels finer than the noise lose as much information as white noise of variance q²/12 (Widrow & Kollar, Quantization
// Noise, 2008). The next term is of the order (q/σ)⁴ / 288, 2e-4 at σ = 2 q.
TEST(ReadingInformation, TreatsFineLevelsAsWhiteNoise) {
  const Eigen::Matrix2d information = ReadingInformation(0.37, 2, 1, {});
  EXPECT_THAT(information(0, 0) * (4 + 1.0 / 12), DoubleNear(1, 3e-4));
}

TEST(ReadingInformation, VanishesInsideALevelAndFarBeyondTheRange) {
  EXPECT_LT(ReadingInformation(0, 0.02, 1, {}).norm(), 1e-100);
  EXPECT_LT(ReadingInformation(1e3, 0.5, 1, kNarrow).norm(), 1e-100);
  EXPECT_LT(ReadingInformation(-1e3, 0.5, 1, kNarrow).norm(), 1e-100);
}

}  // namespace
}  // namespace pendulum::reading_information_test
