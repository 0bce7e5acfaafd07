// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_point_view.h"

#include <cmath>
#include <random>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/free_swing.h"

namespace pendulum::turning_point_view_test {
namespace {

using testing::DoubleNear;
using testing::SizeIs;

constexpr double kSquare = 22;  // ω0² [1/s²]
constexpr double kRadius = 0.3;
constexpr Eigen::Index kSamples = 2000;

/// θ, θ' and θ'' at 100 Hz of a swing from 0.6 rad with viscous friction [1/s] and a little dry friction, by
/// fourth-order Runge-Kutta.
Eigen::MatrixX3d Motion(double viscous = 0.05, Eigen::Index samples = kSamples) {
  const auto acceleration = [=](double angle, double rate, double side) {
    return -kSquare * std::sin(angle) - viscous * rate - 0.05 * side;
  };
  Eigen::MatrixX3d motion(samples, 3);
  double angle = 0.6, rate = 0, side = -1;
  constexpr int kSteps = 20;
  constexpr double kStep = 0.01 / kSteps;
  for (Eigen::Index i = 0; i < samples; ++i) {
    motion.row(i) << angle, rate, acceleration(angle, rate, side);
    for (int step = 0; step < kSteps; ++step) {
      if (rate != 0) side = rate > 0 ? 1 : -1;
      const double a1 = acceleration(angle, rate, side);
      const double v2 = rate + 0.5 * kStep * a1;
      const double a2 = acceleration(angle + 0.5 * kStep * rate, v2, side);
      const double v3 = rate + 0.5 * kStep * a2;
      const double a3 = acceleration(angle + 0.5 * kStep * v2, v3, side);
      const double v4 = rate + kStep * a3;
      const double a4 = acceleration(angle + kStep * v3, v4, side);
      angle += kStep / 6 * (rate + 2 * v2 + 2 * v3 + v4);
      rate += kStep / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
  }
  return motion;
}

Recording AngleOf(const Eigen::MatrixX3d& motion) {
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(motion.rows(), 0, 0.01 * static_cast<double>(motion.rows() - 1));
  recording.value = motion.col(0);
  return recording;
}

/// The readings of an accelerometer along an axis, with noise of the given standard deviation (MODEL.md eq. (14.2)).
Recording Seen(const Eigen::MatrixX3d& motion, double axis, double noise, double gravity) {
  Recording recording = AngleOf(motion);
  recording.quantity = Quantity::kAcceleration;
  recording.unit = "m/s^2";
  std::mt19937_64 generator(1);
  boost::random::normal_distribution<double> draw;
  recording.shows_gravity = gravity > 0;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double across = kRadius * motion(i, 2) + gravity * std::sin(motion(i, 0));
    const double along = kRadius * motion(i, 1) * motion(i, 1) + gravity * std::cos(motion(i, 0));
    recording.value[i] = across * std::cos(axis) + along * std::sin(axis) + noise * draw(generator);
  }
  return recording;
}

Recording Acceleration(double axis, double noise) { return Seen(Motion(), axis, noise, kStandardGravity); }

TEST(IsAlongRod, DistinguishesAlongFromAcross) {
  EXPECT_FALSE(IsAlongRod(Acceleration(0, 0.05)));
  EXPECT_TRUE(IsAlongRod(Acceleration(kPi / 2, 0.05)));
  EXPECT_TRUE(IsAlongRod(Acceleration(-kPi / 2, 0.05)));
}

/// Durations from two swings to a hundred times the duration of the motion, which dry friction ends; without viscous
/// friction, with little and with much.
TEST(IsAlongRod, DistinguishesAlongFromAcrossWithoutGravity) {
  for (const double viscous : {0.0, 0.05, 1.0}) {
    for (const Eigen::Index samples : {300, 2000, 10000, 100000}) {
      const Eigen::MatrixX3d motion = Motion(viscous, samples);
      for (const double upright : {1.0, -1.0}) {
        const Recording along = Seen(motion, upright * (kPi / 2 + 0.03), 0.05, 0);
        EXPECT_TRUE(IsAlongRod(along)) << viscous << ", " << samples;
        EXPECT_EQ(RadialSide(along), upright);
        EXPECT_FALSE(IsAlongRod(Seen(motion, (upright - 1) / 2 * kPi + 0.03, 0.05, 0))) << viscous << ", " << samples;
      }
    }
  }
}

TEST(IsAlongRod, IgnoresOutliers) {
  Recording along = Seen(Motion(), kPi / 2, 0.05, 0);
  Recording across = Seen(Motion(), 0, 0.05, 0);
  for (const Eigen::Index i : {700, 1200}) along.value[i] = -20;
  for (const Eigen::Index i : {700, 1200}) across.value[i] = 50;
  EXPECT_TRUE(IsAlongRod(along));
  EXPECT_EQ(RadialSide(along), 1);
  EXPECT_FALSE(IsAlongRod(across));
}

/// Between passages through the bottom the view is proportional to sin(θ/2) with its sign (MODEL.md eq. (14.5)), except
/// for the loss by friction within a half swing.
TEST(TurningPointView, UnfoldsAnAccelerationAlongTheRod) {
  const Eigen::MatrixX3d motion = Motion();
  for (const double axis : {kPi / 2, -kPi / 2}) {
    const Recording view = TurningPointView(Acceleration(axis, 0));
    EXPECT_EQ(view.quantity, Quantity::kAngle);
    EXPECT_FALSE(view.is_calibrated());
    const double scale = std::sqrt(2 * (kStandardGravity + 2 * kRadius * kSquare));
    // The first swing begins before the first bottom, whose reading is needed.
    for (Eigen::Index i = 40; i < kSamples / 2; ++i) {
      ASSERT_THAT(view.value[i] / scale, DoubleNear(std::sin(0.5 * motion(i, 0)), 0.05)) << i;
    }
  }
}

TEST(TurningPointView, HasTheTurningPointsOfTheMotion) {
  const auto expected = FindFreeSwings(AngleOf(Motion()));
  ASSERT_TRUE(expected);
  for (const double axis : {0.0, kPi / 2}) {
    const auto swings = FindFreeSwings(Acceleration(axis, 0.02));
    ASSERT_TRUE(swings) << swings.error().message();
    ASSERT_THAT(*swings, SizeIs(1));
    EXPECT_THAT(swings->front().half_period, DoubleNear(expected->front().half_period, 0.01));
    EXPECT_THAT(swings->front().turns.size(), testing::Ge(expected->front().turns.size() - 3));
  }
}

TEST(TurningPointView, KeepsAnglesAndRates) {
  const Recording recording = AngleOf(Motion());
  EXPECT_FALSE(HasTurningPointView(recording));
  EXPECT_EQ(TurningPointView(recording).value, recording.value);
}

}  // namespace
}  // namespace pendulum::turning_point_view_test
