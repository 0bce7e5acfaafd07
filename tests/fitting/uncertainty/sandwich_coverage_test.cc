// SPDX-License-Identifier: Apache-2.0
// Least-squares intervals with the sandwich A^-1 W'RW A^-1 contain the truth with the stated probability.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>
#include <gtest/gtest.h>

#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "tests/fitting/correlated_noise.h"

namespace pendulum::sandwich_coverage_test {
namespace {

/// Which of a swing's three 95 % intervals contain 0 if only noise was measured. The noise variance is RSS divided by
/// the number of samples minus tr(A^-1 W'RW), the part absorbed by the fit. Student's t uses the effective number
/// of samples minus K.
Eigen::Array3i Covered(const Eigen::VectorXd& time, const Eigen::VectorXd& noise) {
  const Eigen::MatrixXd columns = SwingColumns(time);
  const Eigen::Matrix3d inverse = (columns.transpose() * columns).llt().solve(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d estimate = inverse * (columns.transpose() * noise);
  const Eigen::VectorXd residual = noise - columns * estimate;
  const Autocorrelation correlation = EstimateAutocorrelation(time, residual, columns);
  const Eigen::Matrix3d taken = inverse * CorrelatedSum(correlation, time, columns);
  const Eigen::Matrix3d covariance = taken * inverse;
  const auto samples = static_cast<double>(time.size());
  const double variance = residual.squaredNorm() / (samples - taken.trace());
  Eigen::Array3i covered;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double freedom = samples * inverse(i, i) / covariance(i, i) - 3;
    const boost::math::students_t distribution(std::clamp(freedom, 1.0, samples));
    const double half_width = boost::math::quantile(distribution, 0.975) * std::sqrt(variance * covariance(i, i));
    covered[i] = std::abs(estimate[i]) <= half_width ? 1 : 0;
  }
  return covered;
}

/// Coverage of the intervals for AR(1) noise plus white noise: sine, cosine, zero angle.
Eigen::Array3d Coverage(Eigen::Index samples, double phi, double white_share, int seeds = 700) {
  Eigen::Array3i covered = Eigen::Array3i::Zero();
  for (int seed = 1; seed <= seeds; ++seed) {
    covered +=
        Covered(EvenTimes(samples), FirstOrderNoise(samples, phi, white_share, static_cast<std::uint64_t>(seed)));
  }
  return covered.cast<double>() / seeds;
}

/// Two standard errors of a share of 0.95 are 0.0165 for 700 seeds, 0.008 for 3000.
void ExpectWithin(const Eigen::Array3d& coverage, double lowest, double highest) {
  EXPECT_GE(coverage.minCoeff(), lowest) << coverage.transpose();
  EXPECT_LE(coverage.maxCoeff(), highest) << coverage.transpose();
}

TEST(SandwichIntervals, CoverForWhiteNoise) { ExpectWithin(Coverage(2000, 0, 0, 3000), 0.935, 0.965); }

TEST(SandwichIntervals, CoverForAShortCorrelation) { ExpectWithin(Coverage(2000, 0.5, 0), 0.93, 0.97); }

TEST(SandwichIntervals, CoverForCorrelationOverTenSamples) { ExpectWithin(Coverage(2000, 0.9, 0), 0.93, 0.97); }

TEST(SandwichIntervals, CoverForCorrelationOverTenSamplesInWhiteNoise) {
  ExpectWithin(Coverage(2000, 0.9, 0.5), 0.93, 0.97);
}

// These recordings are only 40 and 10 autocorrelation times long, so the zero angle has only that many effective
// readings.
TEST(SandwichIntervals, NearlyCoverForCorrelationOverFiftySamples) {
  ExpectWithin(Coverage(2000, 0.98, 0), 0.91, 0.97);
}

TEST(SandwichIntervals, NearlyCoverForARecordingOfFiveSeconds) { ExpectWithin(Coverage(500, 0.9, 0), 0.90, 0.97); }

}  // namespace
}  // namespace pendulum::sandwich_coverage_test
