// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/swing_information.h"

#include <cmath>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using testing::DoubleNear;

constexpr double kHalfPeriod = 0.6;  // s

/// A swing whose amplitude decays with exp(-decay t).
FreeSwing Decaying(double decay, int half_swings) {
  FreeSwing swing;
  for (int i = 0; i <= half_swings; ++i) swing.turns.push_back(3 + kHalfPeriod * i);
  for (int i = 0; i < half_swings; ++i) swing.heights.push_back(2 * std::exp(-decay * kHalfPeriod * (i + 0.5)));
  return swing;
}

/// The standard error of the frequency of exp(-decay t) (a cos ωt + b sin ωt) from readings in [from, to] with noise of
/// 1, by least squares.
double FrequencyError(double decay, double from, double to) {
  constexpr double kStep = 0.01;  // s
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (double t = from; t < to; t += kStep) {
    const double size = std::exp(-decay * t), phase = kPi / kHalfPeriod * t;
    const Eigen::Vector3d gradient = size * Eigen::Vector3d(std::cos(phase), std::sin(phase), -t * std::sin(phase));
    normal += gradient * gradient.transpose();
  }
  return std::sqrt(normal.inverse()(2, 2));
}

// With a constant amplitude the standard error is in proportion to T^-3/2.
TEST(LeftOutOf, HalfOfASteadySwingCostsTheRootOfEight) {
  const auto left_out = LeftOutOf(Decaying(0, 40), 3, 3 + 20 * kHalfPeriod);
  ASSERT_TRUE(left_out);
  EXPECT_EQ(left_out->half_swings, 20);
  EXPECT_EQ(left_out->all, 40);
  EXPECT_FALSE(left_out->is_largest);
  EXPECT_THAT(left_out->larger_errors, DoubleNear(std::sqrt(8), 1e-9));
}

TEST(LeftOutOf, CostsWhatLeastSquaresSayOfTheFrequency) {
  constexpr int kAll = 60, kWithout = 15;
  for (const double decay : {0.0, 0.03, 0.1}) {
    SCOPED_TRACE(decay);
    const double begin = kWithout * kHalfPeriod, end = kAll * kHalfPeriod;
    const auto without_first = LeftOutOf(Decaying(decay, kAll), 3 + begin, 3 + end);
    ASSERT_TRUE(without_first);
    EXPECT_EQ(without_first->half_swings, kWithout);
    EXPECT_EQ(without_first->is_largest, decay > 0);
    const double ratio = FrequencyError(decay, begin, end) / FrequencyError(decay, 0, end);
    EXPECT_THAT(without_first->larger_errors, DoubleNear(ratio, 0.02 * ratio));
    const auto without_last = LeftOutOf(Decaying(decay, kAll), 3, 3 + end - begin);
    ASSERT_TRUE(without_last);
    EXPECT_FALSE(without_last->is_largest);
    const double other = FrequencyError(decay, 0, end - begin) / FrequencyError(decay, 0, end);
    EXPECT_THAT(without_last->larger_errors, DoubleNear(other, 0.02 * other));
  }
}

TEST(LeftOutOf, DoesNotCountAHold) {
  FreeSwing swing = Decaying(0.1, 10);
  swing.turns.front() -= 2;  // somewhere in a hold of some seconds
  swing.after_hold = 3;
  EXPECT_FALSE(LeftOutOf(swing, 3.05, swing.turns.back()));
}

TEST(LeftOutOf, IsNothingForTheWholeSwingOrAnother) {
  const FreeSwing swing = Decaying(0.1, 10);
  EXPECT_FALSE(LeftOutOf(swing, swing.turns.front(), swing.turns.back()));
  EXPECT_FALSE(LeftOutOf(swing, 0, 1));
  EXPECT_FALSE(LeftOutOf(FreeSwing{}, 0, 1));
}

}  // namespace
}  // namespace pendulum
