// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/correlated_residuals.h"

namespace pendulum::arma_likelihood_errors_test {
namespace {

using testing::DoubleNear;

/// Residuals of AR(p) noise of variance 1 from its recursion, for large sample numbers.
Eigen::VectorXd Recursion(const Autocorrelation& autocorrelation, Eigen::Index count, std::uint64_t seed) {
  constexpr Eigen::Index kBefore = 2000;
  Eigen::VectorXd noise = std::sqrt(autocorrelation.innovation_variance) * NormalNumbers(count + kBefore, seed);
  const auto order = static_cast<Eigen::Index>(autocorrelation.autoregressive.size());
  for (Eigen::Index t = order; t < noise.size(); ++t) {
    for (Eigen::Index j = 1; j <= order; ++j) noise[t] += autocorrelation.autoregressive[j - 1] * noise[t - j];
  }
  return noise.tail(count);
}

TEST(MaximizeCorrelatedLikelihood, RecoversASecondOrderProcessWithinItsErrors) {
  constexpr int kSeeds = 1000;
  constexpr Eigen::Index kSamples = 1000;
  const Autocorrelation autocorrelation = Autoregressive({1.5, -0.8});
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const CorrelatedResiduals data = Residuals(EvenTimes(kSamples), Recursion(autocorrelation, kSamples, seed), 0);
    const auto found = MaximizeCorrelatedLikelihood(data, Autoregressive({0.1, 0.1}));
    ASSERT_TRUE(found);
    for (int j : {0, 1})
      squares[j] += std::pow(found->autocorrelation.autoregressive[j] - autocorrelation.autoregressive[j], 2);
  }
  // Box & Jenkins, section 7.2: var φ_1 = var φ_2 = (1 - φ_2²) / N; the tolerance is three of its own errors.
  const double expected = (1 - 0.8 * 0.8) / kSamples;
  for (int j : {0, 1}) {
    EXPECT_THAT(squares[j] / kSeeds / expected, DoubleNear(1, 3 * std::sqrt(2.0 / kSeeds))) << j;
  }
}

/// With noise of half a count, rounding reduces the correlation of neighbours by a fourth: 0.9 / (1 + 1/3) = 0.675.
TEST(MaximizeCorrelatedLikelihood, FindsTheCorrelationBelowRounding) {
  constexpr int kSeeds = 40;
  constexpr Eigen::Index kSamples = 2000;
  constexpr double kCount = 2;
  const Eigen::VectorXd time = EvenTimes(kSamples);
  const Eigen::ArrayXd swing = 100 * (4.8 * time.array()).sin();
  double phi = 0, sigma = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Eigen::ArrayXd reading = swing + FirstOrderNoise(kSamples, 0.9, 0, seed).array();
    const CorrelatedResiduals data = Residuals(time, (reading / kCount).round() * kCount - swing, kCount * kCount / 12);
    const auto found = MaximizeCorrelatedLikelihood(data, Autoregressive({0.6}));
    ASSERT_TRUE(found);
    phi += found->autocorrelation.autoregressive[0] / kSeeds;
    sigma += found->sigma / kSeeds;
  }
  // Errors of one recording are some 0.014 and 0.06, of the mean 0.002 and 0.01. Allowed: three of these plus a bias of
  // 1 / N.
  EXPECT_THAT(phi, DoubleNear(0.9, 0.008));
  EXPECT_THAT(sigma, DoubleNear(1, 0.03));
}

/// S. S. Wilks, Annals of Mathematical Statistics 9:60, 1938.
TEST(MaximizeCorrelatedLikelihood, GainsChiSquareForAKnownShift) {
  constexpr int kSeeds = 1000;
  constexpr Eigen::Index kSamples = 1000;
  const Autocorrelation autocorrelation = Autoregressive({0.7});
  const Eigen::Vector3d truth(0.5, -0.3, 0.2);
  const Eigen::MatrixXd columns = SwingColumns(EvenTimes(kSamples));
  double statistic = 0;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  for (int seed = 1; seed <= kSeeds; ++seed) {
    CorrelatedResiduals data = Residuals(EvenTimes(kSamples), Recursion(autocorrelation, kSamples, seed), 0.2);
    data.residual += std::sqrt(0.2) * NormalNumbers(kSamples, kSeeds + seed);
    const auto at_truth = MaximizeCorrelatedLikelihood(data, autocorrelation);
    data.residual += columns * truth;
    AddColumns(columns, &data);
    const auto found = MaximizeCorrelatedLikelihood(data, autocorrelation);
    ASSERT_TRUE(at_truth && found);
    statistic += 2 * (found->log_likelihood - at_truth->log_likelihood) / kSeeds;
    shift += found->shift / kSeeds;
  }
  // Three degrees of freedom, each with variance 2; three standard errors of the mean.
  EXPECT_THAT(statistic, DoubleNear(3, 3 * std::sqrt(6.0 / kSeeds)));
  // Errors for one seed, from the spectrum S of noise and rounding: S(0.048) = 5.77 and S(0) = 5.87. For a sine whose
  // envelope has the mean square 0.82, sqrt(2 S / (N 0.82)) = 0.118; for the mean, sqrt(S / N) = 0.077.
  for (int i = 0; i < 3; ++i)
    EXPECT_THAT(shift[i], DoubleNear(truth[i], 3 * (i < 2 ? 0.118 : 0.077) / std::sqrt(kSeeds))) << i;
}

}  // namespace
}  // namespace pendulum::arma_likelihood_errors_test
