// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/half_swing_map.h"

#include <array>
#include <cmath>
#include <vector>

#include <boost/math/special_functions/ellint_1.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::half_swing_map_test {
namespace {

constexpr double kFrequency = 4.8;  // rad/s
constexpr MotionModel kDragModel = {"drag", "drag", Gravity::kSine};
constexpr MotionModel kLinearDrag = {"drag", "drag", Gravity::kLinear};

using Friction = std::array<double, 3>;

std::optional<HalfSwingEnd> Swing(const MotionModel& model, const Friction& friction, double amplitude,
                                  double natural_frequency) {
  return ComputeHalfSwing(model, friction, amplitude, natural_frequency, 1, true);
}

/// Rate and angle for the drag law by classical Runge-Kutta steps in time, as an independent method.
HalfSwingEnd ByRungeKutta(const Friction& p, double amplitude) {
  const double square = kFrequency * kFrequency;
  const auto acceleration = [&](double angle, double rate) {
    return -square * (std::sin(angle) + p[0] * rate + p[1] + p[2] * rate * rate);
  };
  constexpr double kStep = 1e-5;  // s
  double angle = -amplitude, rate = 0, time = 0;
  HalfSwingEnd end;
  while (true) {
    const double k1 = rate, a1 = acceleration(angle, rate);
    const double k2 = rate + kStep / 2 * a1, a2 = acceleration(angle + kStep / 2 * k1, k2);
    const double k3 = rate + kStep / 2 * a2, a3 = acceleration(angle + kStep / 2 * k2, k3);
    const double k4 = rate + kStep * a3, a4 = acceleration(angle + kStep * k3, k4);
    const double next = rate + kStep / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (next <= 0) break;
    angle += kStep / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (next > end.peak_rate) end.peak_rate = next, end.peak_delay = time + kStep;
    rate = next;
    time += kStep;
  }
  const double a = acceleration(angle, rate);  // the remaining motion is a parabola
  end.amplitude = angle - 0.5 * rate * rate / a;
  end.duration = time - rate / a;
  return end;
}

TEST(HalfSwingMap, TakesHalfTheEllipticPeriodWithoutFriction) {
  for (const double amplitude : {1e-4, 0.1, 0.42, 1.0, 1.5, 2.0}) {
    const auto end = Swing(kDragModel, Friction{}, amplitude, kFrequency);
    ASSERT_TRUE(end);
    const double expected = 2 / kFrequency * boost::math::ellint_1(std::sin(amplitude / 2));
    EXPECT_NEAR(end->amplitude / amplitude, 1, 1e-13) << amplitude;
    EXPECT_NEAR(end->duration / expected, 1, 1e-12) << amplitude;
    EXPECT_NEAR(end->peak_rate / (2 * kFrequency * std::sin(amplitude / 2)), 1, 1e-13) << amplitude;  // eq. (6.2)
    EXPECT_NEAR(end->peak_delay / (expected / 2), 1, 1e-12) << amplitude;
  }
}

TEST(HalfSwingMap, LosesTwiceTheStickingAngleToDryFriction) {
  const auto end = Swing(kLinearDrag, Friction{0, 0.01, 0}, 0.3, kFrequency);
  ASSERT_TRUE(end);
  EXPECT_NEAR(end->amplitude, 0.28, 1e-14);
  EXPECT_NEAR(end->duration, kPi / kFrequency, 1e-13);
  EXPECT_NEAR(end->peak_rate, 0.29 * kFrequency, 1e-13);  // half the distance, about the point where friction holds
}

TEST(HalfSwingMap, FollowsTheLogDecrementForALinearPendulum) {
  const double damping_ratio = 0.05;
  const double root = std::sqrt(1 - damping_ratio * damping_ratio);
  const auto end = Swing(kLinearDrag, Friction{2 * damping_ratio / kFrequency, 0, 0}, 0.3, kFrequency);
  ASSERT_TRUE(end);
  EXPECT_NEAR(end->amplitude, 0.3 * std::exp(-kPi * damping_ratio / root), 1e-14);
  EXPECT_NEAR(end->duration, kPi / (kFrequency * root), 1e-12);
  // θ' = A ω0 / root exp(-ζ ω0 t) sin(ω_d t) is largest at ω_d t = atan(root / ζ) = acos ζ.
  const double delay = std::acos(damping_ratio) / (kFrequency * root);
  EXPECT_NEAR(end->peak_delay, delay, 1e-12);
  EXPECT_NEAR(end->peak_rate, 0.3 * kFrequency * std::exp(-damping_ratio * kFrequency * delay), 1e-13);
}

TEST(HalfSwingMap, MatchesRungeKuttaForAllThreeTerms) {
  const Friction friction = {0.004, 0.003, 0.002};
  for (const double amplitude : {0.05, 0.42, 1.2, 2.1}) {
    const auto end = Swing(kDragModel, friction, amplitude, kFrequency);
    const HalfSwingEnd expected = ByRungeKutta(friction, amplitude);
    ASSERT_TRUE(end);
    EXPECT_NEAR(end->amplitude, expected.amplitude, 1e-10) << amplitude;
    EXPECT_NEAR(end->duration, expected.duration, 1e-9) << amplitude;
    EXPECT_NEAR(end->peak_rate, expected.peak_rate, 1e-8) << amplitude;
    EXPECT_NEAR(end->peak_delay, expected.peak_delay, 1.1e-5) << amplitude;  // one step
  }
}

TEST(HalfSwingMap, AcceptsFrictionOfEitherSign) {
  const auto gain = Swing(kLinearDrag, Friction{0, -0.01, 0}, 0.3, kFrequency);
  ASSERT_TRUE(gain);
  EXPECT_NEAR(gain->amplitude, 0.32, 1e-14);
}

TEST(HalfSwingMap, IsMissingIfFrictionStopsTheSwing) {
  EXPECT_FALSE(Swing(kDragModel, Friction{0, 0.2, 0}, 0.3, kFrequency));
  EXPECT_FALSE(Swing(kDragModel, Friction{0, 0.5, 0}, 0.3, kFrequency));
}

}  // namespace
}  // namespace pendulum::half_swing_map_test
