// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/joint_parabolas.h"

#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/fitting/joint_recordings.h"

namespace pendulum::joint_parabolas_test {
namespace {

// For independent estimates with normal errors, the best combination is the mean weighted with inverse covariances.
TEST(CombineParabolas, GivesTheWeightedMeanOfSeparateFits) {
  const TwoRuns runs;
  const Estimates mean = Combine({EstimatesOf(runs.alone[0], kPhysical), EstimatesOf(runs.alone[1], kPhysical)});
  const CombinedParabolas combined = CombineParabolas(runs.Problem());
  const Eigen::MatrixXd covariance = combined.information.inverse();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double std_error = std::sqrt(mean.covariance(i, i));
    const double estimate = kTextbookTorque * combined.parameters[static_cast<std::size_t>(i)];
    EXPECT_NEAR(estimate, mean.value[i], 1e-6 * std_error) << kPhysical[static_cast<std::size_t>(i)];
    EXPECT_NEAR(kTextbookTorque * std::sqrt(covariance(i, i)), std_error, 1e-6 * std_error);
  }
}

TEST(CombineParabolas, RespectsBounds) {
  FitOptions options = RigOptions();
  options.bounds["inertia"] = {0.0795, 0.09};  // the truth is 0.079
  const TwoRuns runs(options);
  const CombinedParabolas combined = CombineParabolas(runs.Problem());
  EXPECT_DOUBLE_EQ(kTextbookTorque * combined.parameters[0], 0.0795);
}

}  // namespace
}  // namespace pendulum::joint_parabolas_test
