// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/optimum.h"

#include <cmath>

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

}  // namespace
}  // namespace pendulum::optimum_test
