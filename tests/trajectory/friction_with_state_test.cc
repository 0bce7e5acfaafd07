// SPDX-License-Identifier: Apache-2.0
// Trajectories of a friction law with a state.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/dahl.h"
#include "pendulum/model/friction/viscous.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum::friction_with_state_test {
namespace {

using testing::DoubleNear;
using testing::Gt;
using testing::Le;

using Dahl = DahlFriction;

static_assert(FrictionWithState<Dahl>);
static_assert(!FrictionWithState<ViscousFriction>);

constexpr double kInertia = 0.044, kViscousTorque = 0.002, kSliding = 0.02, kPresliding = 0.007;
constexpr double kAngle = 0.8, kEnd = 12;

/// All segments of a pendulum released at 0 s.
template <typename T>
std::vector<Segment<T>> Trace(const Pendulum<Dahl, T>& pendulum, const T& angle, TraceSummary* summary = nullptr) {
  std::vector<Segment<T>> segments;
  const TraceSummary traced =
      TraceTrajectory(pendulum, {StartKind::kRelease, 0, angle, T(0.0)}, {.begin = 0, .end = kEnd, .tolerance = 1e-13},
                      [&](const Segment<T>& segment) { segments.push_back(segment); });
  if (summary != nullptr) *summary = traced;
  return segments;
}

std::vector<Segment<double>> TraceValues(const std::array<double, 5>& p) {
  return Trace<double>({Gravity::kSine, p[0], {p[1], p[2], p[3]}}, p[4]);
}

constexpr std::array<double, 5> kParameters = {kInertia, kViscousTorque, kSliding, kPresliding, kAngle};

double Angle(const Segment<double>& segment, double tau) { return EvaluateSeries(segment.angle, segment.order, tau); }

// Along a half swing u is a function of the angle alone: du/dθ = (1 - s u) / θ_p, so
// u = s + (u_0 - s) exp(-|θ - θ_0| / θ_p). With this u the equation of motion must hold everywhere. By the same
// equation the energy with that of the bristles, τ_c θ_p u²/2, changes by -b ω² - τ_c |ω| u²: it never rises.
TEST(FrictionWithState, ObeysTheEquationOfMotionWithTheStateAsAFunctionOfTheAngle) {
  double z = 1, energy_before = kUnbounded, reversal_angle = kAngle, direction = -1;
  for (const Segment<double>& segment : TraceValues(kParameters)) {
    const Segment<double> rate = RateOf(segment), acceleration = RateOf(rate);
    const auto state_at = [&](double angle) {
      return direction + (z - direction) * std::exp(-std::abs(angle - reversal_angle) / kPresliding);
    };
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      const double tau = share * (segment.end - segment.start);
      const double angle = Angle(segment, tau);
      const double balance = kInertia * Angle(acceleration, tau) + std::sin(angle) + kViscousTorque * Angle(rate, tau) +
                             kSliding * state_at(angle);
      ASSERT_THAT(balance, DoubleNear(0, 1e-9)) << "at " << segment.start + tau << " s";
      const double energy = 0.5 * kInertia * std::pow(Angle(rate, tau), 2) + 1 - std::cos(angle) +
                            0.5 * kSliding * kPresliding * std::pow(state_at(angle), 2);
      ASSERT_THAT(energy - energy_before, Le(1e-12)) << "at " << segment.start + tau << " s";
      energy_before = energy;
    }
    const double length = segment.end - segment.start;
    if (std::abs(Angle(rate, length)) > 1e-9) continue;
    const double angle = Angle(segment, length);
    z = state_at(angle);
    reversal_angle = angle;
    direction = -direction;
  }
}

// Bristles hold any torque up to τ_c. The pendulum therefore ends where gravity's torque is within ± τ_c, and
// oscillates there on the bristles indefinitely.
TEST(FrictionWithState, EndsInSmallOscillationsOnTheBristles) {
  TraceSummary summary;
  const auto segments =
      Trace<double>({Gravity::kSine, kInertia, {kViscousTorque, kSliding, kPresliding}}, kAngle, &summary);
  EXPECT_EQ(summary.outcome, TraceSummary::Outcome::kComplete);
  EXPECT_EQ(summary.stop_time, std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(segments.back().end, kEnd);
  const double last = Angle(segments.back(), segments.back().end - segments.back().start);
  EXPECT_LT(std::abs(std::sin(last)), kSliding * 1.01);
  // There are more reversals than half periods π sqrt(I) of the free swing, because the bristles are stiffer than
  // gravity.
  EXPECT_THAT(summary.reversals, Gt(kEnd / (kPi * std::sqrt(kInertia))));
}

// A pendulum that is already in motion has slid since its last reversal: at first its friction is b ω + s τ_c.
TEST(FrictionWithState, SlidesAtTheStartOfAMotion) {
  for (const double rate : {2.0, -2.0}) {
    const Pendulum<Dahl, double> pendulum{Gravity::kSine, kInertia, {kViscousTorque, kSliding, kPresliding}};
    std::vector<Segment<double>> segments;
    TraceTrajectory(pendulum, {StartKind::kMoving, 0, kAngle, rate}, {.begin = 0, .end = 1, .tolerance = 1e-13},
                    [&](const Segment<double>& segment) { segments.push_back(segment); });
    const double torque = std::sin(kAngle) + kViscousTorque * rate + std::copysign(kSliding, rate);
    EXPECT_THAT(2 * segments.front().angle[2], DoubleNear(-torque / kInertia, 1e-12));
  }
}

void ExpectDerivatives(const std::array<double, 5>& p) {
  using T = ReleaseDual<Dahl>;
  const auto segments = Trace<T>({Gravity::kSine, T(p[0], 0), {T(p[1], 1), T(p[2], 2), T(p[3], 3)}}, T(p[4], 4));
  const auto angle_at = [](const std::vector<Segment<double>>& traced, double time) {
    for (const auto& segment : traced) {
      if (time <= segment.end) return Angle(segment, time - segment.start);
    }
    return std::nan("");
  };
  for (std::size_t k = 0; k < p.size(); ++k) {
    auto more = p, less = p;
    const double step = 1e-5 * p[k];
    more[k] += step, less[k] -= step;
    const auto above = TraceValues(more), below = TraceValues(less);
    for (const Segment<T>& segment : segments) {
      const double tau = 0.5 * (segment.end - segment.start);
      double partial = 0;
      for (int n = segment.order; n >= 0; --n)
        partial = partial * tau + PartialsAtFixedTime(segment, n)[static_cast<int>(k)];
      const double time = segment.start + tau;
      const double difference = (angle_at(above, time) - angle_at(below, time)) / (2 * step);
      EXPECT_THAT(partial, DoubleNear(difference, 1e-5 * (1 / p[k] + std::abs(difference)))) << k << " at " << time;
    }
  }
}

TEST(FrictionWithState, HasTheDerivativesWithRespectToAllParameters) { ExpectDerivatives(kParameters); }

// Bristles that bend over so small an angle slide within a step, in which powers of angle / θ_p are huge.
TEST(FrictionWithState, HasTheDerivativesIfTheBristlesBendOverASmallAngle) {
  for (const double angle : {6e-4, 1e-3, 3e-3}) ExpectDerivatives({kInertia, kViscousTorque, 0.002, angle, 0.42});
}

}  // namespace
}  // namespace pendulum::friction_with_state_test
