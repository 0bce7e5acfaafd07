// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/optimum.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/fitting/fitted.h"

namespace pendulum::optimum_test {
namespace {

TEST(RemainingShift, IsTheDistanceFromTheSolutionInStandardErrors) {
  Fitted fitted = FitWithInternals(Must(SimulateRecording(ShortSwing())), ModelOptions("coulomb"));
  EXPECT_LT(RemainingShift(fitted.optimum), 1e-3);
  // A step of half a standard error along the covariance's first column: the maximum is then half a standard error
  // away.
  const Eigen::MatrixXd covariance = fitted.StandardErrors().covariance;
  for (int i = 0; i < 6; ++i) fitted.solution.parameters[i] += 0.5 * covariance(i, 0) / std::sqrt(covariance(0, 0));
  EXPECT_NEAR(RemainingShift(*Linearize(fitted.problem->solve, *fitted.cost, fitted.solution)), 0.5, 0.01);
}

TEST(WithoutBounds, FreesTheParametersAtBoundsInOrder) {
  Optimum optimum;
  optimum.free = {0, 2};
  optimum.at_bound = {1};
  const Eigen::Matrix3d information = Eigen::Vector3d(4, 16, 25).asDiagonal();
  const Optimum free = WithoutBounds(optimum, information);
  EXPECT_EQ(free.free, (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(free.at_bound.empty());
  EXPECT_EQ(free.information, information);
  ASSERT_TRUE(free.inverse.identifiable);
  EXPECT_TRUE(free.inverse.matrix.isApprox(information.inverse(), 1e-15));
}

}  // namespace
}  // namespace pendulum::optimum_test
