// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turns_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum::turns_view_test {
namespace {

using testing::DoubleNear;
using testing::SizeIs;

SyntheticOptions Swing() {
  SyntheticOptions options;
  options.parameters = {0.045, 0.002, 0.002};
  options.start = StartKind::kMoving;
  options.initial_angle = 0.6;
  options.initial_rate = 0;
  return options;
}

Recording Acceleration(double axis, double noise) {
  SyntheticOptions options = Swing();
  options.quantity = Quantity::kAcceleration;
  options.sensor.kind = SensorKind::kAcceleration;
  options.sensor.gravity = kStandardGravity;
  options.sensor_parameters = {0, 1, axis, 0.3};
  options.noise = noise;
  return SimulateRecording(options).value();
}

TEST(IsRadial, TellsAlongFromAcross) {
  EXPECT_FALSE(IsRadial(Acceleration(0, 0.05)));
  EXPECT_TRUE(IsRadial(Acceleration(kPi / 2, 0.05)));
  EXPECT_TRUE(IsRadial(Acceleration(-kPi / 2, 0.05)));
}

/// The view is in proportion to sin(θ/2) between passages through the bottom, with its sign (MODEL.md eq. (74)), but for
/// what friction takes within half a swing.
TEST(TurnsView, UnfoldsAnAccelerationAlongTheRod) {
  const SyntheticOptions options = Swing();
  const Recording motion = SimulateRecording(options).value();
  for (const double axis : {kPi / 2, -kPi / 2}) {
    const Recording view = TurnsView(Acceleration(axis, 0));
    EXPECT_EQ(view.quantity, Quantity::kAngle);
    EXPECT_FALSE(view.is_calibrated());
    const double scale = std::sqrt(2 * (kStandardGravity + 2 * 0.3 / 0.045));
    // The first swing begins before any bottom has told its reading.
    for (Eigen::Index i = 40; i < 1000; ++i) {
      ASSERT_THAT(view.value[i] / scale, DoubleNear(std::sin(0.5 * motion.value[i]), 0.05)) << i;
    }
  }
}

TEST(TurnsView, HasTheTurningPointsOfTheMotion) {
  const auto expected = FindFreeSwings(SimulateRecording(Swing()).value());
  ASSERT_TRUE(expected);
  for (const double axis : {0.0, kPi / 2}) {
    const auto swings = FindFreeSwings(Acceleration(axis, 0.02));
    ASSERT_TRUE(swings) << swings.error().message;
    ASSERT_THAT(*swings, SizeIs(1));
    EXPECT_THAT(swings->front().half_period, DoubleNear(expected->front().half_period, 0.01));
    EXPECT_THAT(swings->front().turns.size(), testing::Ge(expected->front().turns.size() - 3));
  }
}

TEST(TurnsView, LeavesAnglesAndRatesAsTheyAre) {
  const Recording recording = SimulateRecording(Swing()).value();
  EXPECT_FALSE(HasOtherView(recording));
  EXPECT_EQ(TurnsView(recording).value, recording.value);
}

}  // namespace
}  // namespace pendulum::turns_view_test
