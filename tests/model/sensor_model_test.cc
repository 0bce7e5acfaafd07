// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/sensor_model.h"

#include <array>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::sensor_model_test {
namespace {

using testing::DoubleNear;

struct Case {
  SensorModel sensor;
  std::vector<double> parameters;
};

SensorModel Kind(SensorKind kind) {
  SensorModel sensor;
  sensor.kind = kind;
  return sensor;
}

std::vector<Case> Cases() {
  SensorModel accelerometer = Kind(SensorKind::kAcceleration);
  accelerometer.gravity = 9.81;
  SensorModel arc = Kind(SensorKind::kArc);
  arc.pivot_x = 3;
  arc.pivot_y = -2;
  arc.down = -1;
  return {{Kind(SensorKind::kScaledRate), {1.65, 0.115}},
          {accelerometer, {0.2, 1.01, 0.3, 0.25}},
          {Kind(SensorKind::kCoordinate), {0.02, 640, 400}},
          {arc, {0.02, 3.1, -2.2, 40}}};
}

/// Compares with central differences of the reading at several states.
TEST(SensorModel, HasTheDerivativesOfItsReading) {
  constexpr double kStep = 1e-6;
  for (const Case& each : Cases()) {
    const SensorModel& sensor = each.sensor;
    for (const double angle : {-2.0, -0.4, 0.0, 0.7}) {
      std::array<double, SensorModel::kStates> state = {angle, 1.3, -7.0};
      std::vector<double> p = each.parameters;
      const SensorModel::Response at = sensor.At(state, p.data());
      const auto slope = [&](double& number) {
        const double before = number;
        number = before + kStep;
        const double above = sensor.At(state, p.data()).reading;
        number = before - kStep;
        const double below = sensor.At(state, p.data()).reading;
        number = before;
        return (above - below) / (2 * kStep);
      };
      for (std::size_t k = 0; k < state.size(); ++k) EXPECT_THAT(at.by_state[k], DoubleNear(slope(state[k]), 1e-5));
      for (std::size_t k = 0; k < p.size(); ++k) EXPECT_THAT(at.by_parameter[k], DoubleNear(slope(p[k]), 1e-5));
    }
  }
}

/// Textbook: at rest an accelerometer shows g along the rod and 0 across it. On a point mass that swings on a string
/// without friction it shows 0 across the string, because r α = -g sin θ.
TEST(SensorModel, MatchesAnAccelerometer) {
  SensorModel sensor = Kind(SensorKind::kAcceleration);
  sensor.gravity = 9.81;
  const std::array across = {0.0, 1.0, 0.0, 0.5};
  const std::array along = {0.0, 1.0, kPi / 2, 0.5};
  EXPECT_THAT(sensor.At({0, 0, 0}, across.data()).reading, DoubleNear(0, 1e-12));
  EXPECT_THAT(sensor.At({0, 0, 0}, along.data()).reading, DoubleNear(9.81, 1e-12));
  EXPECT_THAT(sensor.At({0.4, 1, -9.81 / 0.5 * std::sin(0.4)}, across.data()).reading, DoubleNear(0, 1e-12));
  // On a circle of radius r at the rate ω the acceleration is r ω² towards the centre.
  EXPECT_THAT(sensor.At({0, 3, 0}, along.data()).reading, DoubleNear(9.81 + 0.5 * 9, 1e-12));
}

/// A point on a circle, seen from the pivot, appears at its angle, also beyond a full turn.
TEST(SensorModel, MeasuresTheAngleFromThePivot) {
  for (const double down : {1.0, -1.0}) {
    SensorModel arc = Kind(SensorKind::kArc);
    arc.down = down;
    const std::array p = {0.1, 0.0, 0.0, 2.0};
    for (const double angle : {-4.0, -1.0, 0.0, 2.5, 7.0}) {
      EXPECT_THAT(arc.At({angle, 0, 0}, p.data()).reading, DoubleNear(angle + 0.1, 1e-12));
    }
  }
}

TEST(SensorModel, NamesItsParameters) {
  for (const auto& [sensor, parameters] : Cases()) {
    EXPECT_EQ(sensor.Parameters().size(), parameters.size());
    EXPECT_EQ(sensor.size(), static_cast<int>(parameters.size()));
  }
  EXPECT_EQ(SensorModel().size(), 1);
  EXPECT_TRUE(IsSensorParameter("radius"));
  EXPECT_FALSE(IsSensorParameter("zero_angle"));
}

}  // namespace
}  // namespace pendulum::sensor_model_test
