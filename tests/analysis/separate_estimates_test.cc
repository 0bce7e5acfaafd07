// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/separate_estimates.h"

#include <limits>
#include <optional>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "pendulum/base/distributions.h"

namespace pendulum::separate_estimates_test {
namespace {

/// Two estimates with independent noise of 3 and 1. A common clock changes them by 4 and 2, the rig by 10 and -6, and
/// the first one is not constant by 5.
FitAloneResult SomeFit() {
  const Eigen::Vector2d value(100, -50), clock(4, 2), rig(10, -6);
  Eigen::MatrixXd all = clock * clock.transpose() + rig * rig.transpose();
  all(0, 0) += 25;
  return {{"a", "b"},
          value,
          Eigen::Vector2d(9, 1).asDiagonal(),
          {kNormal95, kNormal95},
          {all, rig.cwiseAbs(), Eigen::Vector2d(5, 0)}};
}

TEST(EstimatesToCompare, AlwaysIncludeInconstancyAndNeverTheRig) {
  const auto shared = EstimatesToCompare(SomeFit(), false);
  ASSERT_TRUE(shared);
  EXPECT_NEAR(shared->covariance(0, 0), 9 + 25, 1e-12);
  EXPECT_NEAR(shared->covariance(1, 1), 1, 1e-12);
  EXPECT_NEAR(shared->covariance(0, 1), 0, 1e-12);
}

TEST(EstimatesToCompare, IncludeClocksThatDiffer) {
  const auto own = EstimatesToCompare(SomeFit(), true);
  ASSERT_TRUE(own);
  EXPECT_NEAR(own->covariance(0, 0), 9 + 25 + 16, 1e-12);
  EXPECT_NEAR(own->covariance(1, 1), 1 + 4, 1e-12);
  EXPECT_NEAR(own->covariance(0, 1), 8, 1e-12);
}

TEST(EstimatesToCompare, AreWidenedByStudentsTAndAtABoundByTheLargest) {
  FitAloneResult fit = SomeFit();
  fit.t95 = {2 * kNormal95, std::nullopt};
  const auto estimates = EstimatesToCompare(fit, false);
  ASSERT_TRUE(estimates);
  EXPECT_NEAR(estimates->covariance(0, 0), 4 * 9 + 25, 1e-12);
  EXPECT_NEAR(estimates->covariance(1, 1), 4 * 1, 1e-12);
}

TEST(EstimatesToCompare, NeedFiniteNumbersAndPositiveVariances) {
  FitAloneResult fit = SomeFit();
  fit.covariance(1, 1) = 0;
  EXPECT_FALSE(EstimatesToCompare(fit, false));
  fit = SomeFit();
  fit.value[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(EstimatesToCompare(fit, false));
}

TEST(HaveOwnSources, IsTrueIfAClockOrCalibrationDiffers) {
  const auto same = SourcesText(1, 1e-4, "null");
  EXPECT_FALSE(HaveOwnSources({same, same}));
  EXPECT_TRUE(HaveOwnSources({same, SourcesText(1, 2e-4, "null")}));
  EXPECT_TRUE(HaveOwnSources({same, SourcesText(1, 1e-4, R"({"slope":2})")}));
}

}  // namespace
}  // namespace pendulum::separate_estimates_test
