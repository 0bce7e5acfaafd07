// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/distributions.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace pendulum::distributions_test {
namespace {

// Values as printed in the NIST/SEMATECH e-Handbook of Statistical Methods, sections 1.3.6.7.1 to 1.3.6.7.4.
TEST(Distributions, MatchPrintedTables) {
  EXPECT_NEAR(NormalQuantile(0.5 + 0.47500), 1.96, 5e-5);
  EXPECT_NEAR(NormalQuantile(0.5 - 0.47500), -1.96, 5e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.95, 1), 3.841, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.999, 10), 29.588, 5e-4);
  EXPECT_NEAR(ChiSquareTail(18.307, 10), 0.05, 5e-6);
  EXPECT_NEAR(StudentQuantile(0.975, 10), 2.228, 5e-4);
  EXPECT_NEAR(StudentQuantile(0.975, 1), 12.706, 5e-4);
  EXPECT_NEAR(FisherTail(4.965, 1, 10), 0.05, 5e-5);
  EXPECT_NEAR(FisherTail(3.326, 5, 10), 0.05, 5e-5);
}

// Student's t with one degree of freedom is the Cauchy distribution. The chi-square tail with two degrees is exp(-x/2).
TEST(Distributions, MatchClosedForms) {
  EXPECT_DOUBLE_EQ(StudentProbability(1, 1), 0.75);
  EXPECT_DOUBLE_EQ(StudentTail(1, 1), 0.25);
  EXPECT_DOUBLE_EQ(StudentDensity(0, 1), 0.31830988618379067);
  EXPECT_DOUBLE_EQ(ChiSquareTail(3, 2), 0.22313016014842982);
  EXPECT_DOUBLE_EQ(NormalQuantile(0.5), 0);
}

// No success in 10 trials: (1 - p)^10 = 0.025; no failure: p^10 = 0.025.
TEST(Distributions, MatchTheLimitsOfClopperAndPearson) {
  EXPECT_EQ(BinomialLowerLimit(0, 10, 0.025), 0);
  EXPECT_NEAR(BinomialUpperLimit(0, 10, 0.025), 1 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_NEAR(BinomialLowerLimit(10, 10, 0.025), std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(BinomialUpperLimit(10, 10, 0.025), 1);
}

TEST(Distributions, ThrowForInvalidArguments) {
  EXPECT_THROW(ChiSquareTail(std::numeric_limits<double>::infinity(), 1), std::domain_error);
  EXPECT_THROW(StudentTail(std::numeric_limits<double>::quiet_NaN(), 1), std::domain_error);
  EXPECT_THROW(ChiSquareTail(1, 0), std::domain_error);
  EXPECT_THROW(StudentQuantile(1, 5), std::overflow_error);
}

// Values from tables of the normal distribution.
TEST(TwoSidedP, MatchesTheNormalDistribution) {
  EXPECT_NEAR(TwoSidedP(1.959963985), 0.05, 1e-9);
  EXPECT_NEAR(TwoSidedP(-3.290526731), 0.001, 1e-10);
  EXPECT_EQ(TwoSidedP(0), 1);
}

}  // namespace
}  // namespace pendulum::distributions_test
