// SPDX-License-Identifier: Apache-2.0
// The noise of synthetic recordings: its size, its correlation, its distribution.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <boost/math/distributions/students_t.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/trajectory/synthetic.h"
#include "tests/trajectory/synthetic_support.h"

namespace pendulum::synthetic_noise_test {
namespace {

using testing::DoubleNear;

TEST(SimulateRecording, AddsWhiteNoiseOfTheGivenDeviation) {
  SyntheticOptions options = TextbookRig();
  options.duration = 200;
  const Result<Recording> clean = SimulateRecording(options);
  options.noise = 0.0035;
  const Result<Recording> noisy = SimulateRecording(options);
  ASSERT_TRUE(clean && noisy);
  const std::vector<double> noise = Deviations(noisy->value, clean->value);
  const double limit = 5 / std::sqrt(20000.0);  // five standard errors of a mean and of a correlation of 20000 samples
  ExpectStandardDeviation(noise, 0.0035);
  EXPECT_THAT(std::accumulate(noise.begin(), noise.end(), 0.0) / 20000 / 0.0035, DoubleNear(0, limit));
  const double lag1 =
      std::inner_product(noise.begin() + 1, noise.end(), noise.begin(), 0.0) / 20000 / (0.0035 * 0.0035);
  EXPECT_THAT(lag1, DoubleNear(0, limit));
}

/// The noise of a recording of 20000 samples: its readings minus the readings without noise.
std::vector<double> NoiseOf(SyntheticOptions options) {
  options.duration = 200;
  const Result<Recording> noisy = SimulateRecording(options);
  options.noise = 0;
  const Result<Recording> clean = SimulateRecording(options);
  EXPECT_TRUE(noisy && clean);
  return noisy && clean ? Deviations(noisy->value, clean->value) : std::vector<double>{};
}

// e_i = r e_(i-1) + sqrt(1 - r²) σ x_i with white x_i. Subtracting r e_(i-1) leaves white noise of σ sqrt(1 - r²).
TEST(SimulateRecording, CorrelatesEachNoiseSampleWithThePrevious) {
  for (const double correlation : {0.9, 0.5, -0.7}) {
    SyntheticOptions options = TextbookRig();
    options.noise = 0.0035;
    options.noise_correlation = correlation;
    const std::vector<double> noise = NoiseOf(options);
    std::vector<double> innovations;
    for (std::size_t i = 1; i < noise.size(); ++i) innovations.push_back(noise[i] - correlation * noise[i - 1]);
    ExpectStandardDeviation(innovations, 0.0035 * std::sqrt(1 - correlation * correlation));
    const double lag1 = std::inner_product(innovations.begin() + 1, innovations.end(), innovations.begin(), 0.0) /
                        std::inner_product(innovations.begin(), innovations.end(), innovations.begin(), 0.0);
    EXPECT_THAT(lag1, DoubleNear(0, 5 / std::sqrt(20000.0))) << correlation;  // five standard errors
  }
}

TEST(SimulateRecording, HasFullyCorrelatedNoiseFromTheFirstSample) {
  SyntheticOptions options = TextbookRig();
  options.duration = 2.1;
  options.noise = 1;
  options.noise_correlation = 0.95;
  std::vector<double> first;
  std::vector<double> third;
  for (options.seed = 1; options.seed <= 2000; ++options.seed) {
    const Result<Recording> recording = SimulateRecording(options);
    ASSERT_TRUE(recording) << recording.error().message();
    first.push_back(recording->value[0] - 0.423);  // still held
    third.push_back(recording->value[2] - 0.423);
  }
  ExpectStandardDeviation(first, 1);
  ExpectStandardDeviation(third, 1);
}

// The empirical distribution of n samples stays within 2.7 / sqrt(n) of the true one, except for one seed in a million
// (Kolmogorov: 2 exp(-2 d² n)).
TEST(SimulateRecording, DrawsStudentsNoiseOfTheGivenScale) {
  SyntheticOptions options = TextbookRig();
  options.noise = 0.0035;
  options.noise_freedom = 3;
  std::vector<double> noise = NoiseOf(options);
  std::sort(noise.begin(), noise.end());
  const boost::math::students_t distribution(3);
  double farthest = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double expected = cdf(distribution, noise[i] / 0.0035);
    farthest =
        std::max(farthest, std::abs(expected - (static_cast<double>(i) + 0.5) / static_cast<double>(noise.size())));
  }
  EXPECT_LT(farthest, 2.7 / std::sqrt(20000.0));
}

// Fine quantization adds q²/12 to the variance (Widrow & Kollar, Quantization Noise, 2008).
TEST(SimulateRecording, AddsNoiseBeforeQuantization) {
  SyntheticOptions options = TextbookRig();
  options.duration = 200;
  const Result<Recording> clean = SimulateRecording(options);
  options.noise = 0.0035;
  options.resolution = 0.0035;
  const Result<Recording> quantized = SimulateRecording(options);
  ASSERT_TRUE(clean && quantized);
  ExpectStandardDeviation(Deviations(quantized->value, clean->value), 0.0035 * std::sqrt(1 + 1.0 / 12));
}

// The first numbers of boost::random::normal_distribution on mt19937_64 seeded with 1, from Boost 1.74 with g++ 12 and
// clang 19. If they change, datasets/ changes too.
TEST(SimulateRecording, DrawsItsNoiseByAFixedAlgorithm) {
  SyntheticOptions options = TextbookRig();
  options.release_angle = 0.25;
  options.noise = 1;
  const Result<Recording> recording = SimulateRecording(options);
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_THAT(recording->value[0] - 0.25, DoubleNear(-0.22770229850701265, 1e-15));
  EXPECT_THAT(recording->value[1] - 0.25, DoubleNear(-0.25937725029558445, 1e-15));
  EXPECT_THAT(recording->value[2] - 0.25, DoubleNear(-0.61281862908331552, 1e-15));
}

}  // namespace
}  // namespace pendulum::synthetic_noise_test
