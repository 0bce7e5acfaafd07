// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/agreement.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::agreement_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Estimates of one parameter with a standard error of 1.
std::vector<SeparateEstimates> EstimatesOf(const std::vector<double>& values) {
  std::vector<SeparateEstimates> estimates;
  for (const double value : values) {
    estimates.push_back(
        {estimates.size(), {"inertia"}, Eigen::VectorXd::Constant(1, value), Eigen::MatrixXd::Identity(1, 1)});
  }
  return estimates;
}

// Mean 2, so χ² = 1 + 0 + 1, and with two degrees of freedom p = exp(-χ² / 2).
TEST(TestAgreement, IsCochransStatistic) {
  const Agreement agreement = TestAgreement(EstimatesOf({1, 2, 3}));
  EXPECT_NEAR(agreement.statistic, 2, 1e-12);
  EXPECT_EQ(agreement.dof, 2);
  ASSERT_TRUE(agreement.p);
  EXPECT_NEAR(*agreement.p, std::exp(-1), 1e-12);
}

TEST(FindDisagreeing, NamesTheFewestWithoutWhichAMajorityAgrees) {
  EXPECT_THAT(FindDisagreeing(EstimatesOf({10, 0, 0.5, -0.5, 0, 20})), ElementsAre(0, 5));
}

TEST(FindDisagreeing, NamesNoneWithoutAMajority) { EXPECT_THAT(FindDisagreeing(EstimatesOf({0, 100})), IsEmpty()); }

}  // namespace
}  // namespace pendulum::agreement_test
