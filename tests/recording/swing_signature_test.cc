// SPDX-License-Identifier: Apache-2.0
#include "recording/swing_signature.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace pendulum::swing_signature_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A e^(-decay i) cos(2 π i / period + phase) + offset.
Eigen::VectorXd Oscillation(int rows, double period, double decay, double amplitude = 1, double phase = 0,
                            double offset = 0) {
  Eigen::VectorXd values(rows);
  for (int i = 0; i < rows; ++i) {
    values[i] = offset + amplitude * std::exp(-decay * i) * std::cos(2 * kPi * i / period + phase);
  }
  return values;
}

TEST(FindSwingSignature, GivesPeriodAndAmplitudeOfADecayingOscillation) {
  const auto found = FindSwingSignature(Oscillation(2000, 37.5, 0.001, 0.4, 0.3, 5));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rows_per_period, 37.5, 0.1);
  EXPECT_NEAR(found->amplitude, 0.4, 0.02);
  EXPECT_TRUE(found->decays);
  EXPECT_NEAR(found->period_ratio, 1, 0.01);
}

TEST(FindSwingSignature, GivesThePeriodOfAStronglyDecayingOscillation) {
  // It loses 30 % a period, so the middle of its range is not its zero.
  for (const double phase : {0.0, 1.0, 2.0, 3.0}) {
    const auto found = FindSwingSignature(Oscillation(4000, 400, 0.0009, 1, phase));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->period_ratio, 1, 0.005) << phase;
    EXPECT_LT(found->last_amplitude, found->first_amplitude);
  }
}

TEST(FindSwingSignature, IgnoresMissingNumbersAndAHold) {
  Eigen::VectorXd values(1500);
  values.head(500).setConstant(1);
  values.tail(1000) = Oscillation(1000, 50, 0.002);
  values[700] = std::numeric_limits<double>::quiet_NaN();
  const auto found = FindSwingSignature(values);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rows_per_period, 50, 1);
}

/// A logger writes rows of several sensors: each fills only some of them.
TEST(FindSwingSignature, CountsRowsWithoutNumbers) {
  const Eigen::VectorXd full = Oscillation(6000, 400, 0.0002);
  Eigen::VectorXd sparse = Eigen::VectorXd::Constant(6000, std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 6000; i += 10) sparse[i] = full[i];
  const auto found = FindSwingSignature(sparse);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rows_per_period, 400, 1);
  const Eigen::MatrixXd covariance = SwingCovariance({full, sparse}, found->rows_per_period);
  EXPECT_NEAR(covariance(1, 1), covariance(0, 0), 0.02 * covariance(0, 0));
  EXPECT_EQ(covariance(0, 1), covariance(1, 0));
}

TEST(FindSwingSignature, ADrivenOscillationDoesNotDecay) {
  const auto found = FindSwingSignature(Oscillation(1000, 40, 0));
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->decays);
}

TEST(FindSwingSignature, FindsNoneInARampAConstantOrNoise) {
  EXPECT_FALSE(FindSwingSignature(Eigen::VectorXd::LinSpaced(1000, 0, 10)));
  EXPECT_FALSE(FindSwingSignature(Eigen::VectorXd::Constant(1000, 3)));
  EXPECT_FALSE(FindSwingSignature(Eigen::VectorXd()));
  Eigen::VectorXd noise(1000);
  unsigned state = 1;
  for (double& value : noise) value = (state = state * 1664525U + 1013904223U) / 4294967296.0;
  EXPECT_FALSE(FindSwingSignature(noise));
}

TEST(SwingCovariance, CountsOnlyTheBandOfTheSwing) {
  const Eigen::VectorXd swing = Oscillation(2000, 50, 0);
  const Eigen::VectorXd drift = Eigen::VectorXd::LinSpaced(2000, 0, 3);
  const Eigen::VectorXd twice = Oscillation(2000, 25, 0, 2);
  const Eigen::VectorXd fast = Oscillation(2000, 3.7, 0, 2);
  const Eigen::MatrixXd covariance = SwingCovariance({swing, drift + twice + fast, -0.5 * swing}, 50);
  EXPECT_LT(covariance(1, 1), 0.03 * covariance(0, 0));
  EXPECT_NEAR(covariance(2, 2), 0.25 * covariance(0, 0), 1e-9);
  EXPECT_NEAR(covariance(0, 2), -0.5 * covariance(0, 0), 1e-9);
}

/// 2/π K(sin(A/2)), with K from Abramowitz & Stegun, table 17.1.
TEST(PendulumPeriodRatio, IsTheCompleteEllipticIntegral) {
  EXPECT_DOUBLE_EQ(PendulumPeriodRatio(0), 1);
  EXPECT_NEAR(PendulumPeriodRatio(kPi / 2), 2 / kPi * 1.854074677301372, 1e-12);
  EXPECT_NEAR(PendulumPeriodRatio(kPi / 3), 2 / kPi * 1.685750354812596, 1e-12);
}

}  // namespace
}  // namespace pendulum::swing_signature_test
