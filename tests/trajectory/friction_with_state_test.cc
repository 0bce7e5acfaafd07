// SPDX-License-Identifier: Apache-2.0
// Trajectories of a friction law with a state, tested with the law of P. R. Dahl, "A solid friction model", Aerospace
// Corporation TOR-158(3107-18), 1968. The product has no such law yet.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/coulomb.h"
#include "pendulum/trajectory/trajectory.h"
#include "trajectory/tracer.h"

namespace pendulum::friction_with_state_test {
namespace {

using testing::DoubleNear;
using testing::Gt;

/// T = b ω + σ z,  z' = ω - |ω| z σ/τ_c: bristles of stiffness σ that slide at the torque τ_c.
struct Dahl {
  static constexpr std::string_view kName = "dahl";
  static constexpr std::string_view kTitle = "viscous friction and bristles";
  static constexpr std::string_view kAbout = "Dry friction that yields like a spring before it slides.";
  static constexpr std::string_view kFormula = "{viscous} th' + {stiffness} z";
  static constexpr std::array<ParameterInfo, 3> kParameters = {
      {kViscous, kCoulomb, {"stiffness", "σ", "N m/rad", "1/rad", 0.0, kUnbounded, "stiffness of the bristles"}}};
  static constexpr int kStates = 1;

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + direction * p[1];
  }
  static double TorqueAt(const std::array<double, 1>& z, const double* p) { return p[2] * z[0]; }
  static double Stiffness(const double* p) { return p[2]; }

  template <typename T>
  class Recurrence {
   public:
    void Begin(const std::array<T, 1>& z) { z_[0] = z[0]; }
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      z_[n + 1] = kInverse[n + 1] * (rate[n] - direction * (p[2] / p[1]) * CauchyProduct(rate, z_, n));
      return p[0] * rate[n] + p[2] * z_[n];
    }
    std::array<T, 1> StatesAt(int order, double tau) const { return {EvaluateSeries(z_, order, tau)}; }

   private:
    Series<T> z_{};
  };
};

static_assert(FrictionWithState<Dahl>);
static_assert(!FrictionWithState<ViscousFriction>);

constexpr double kInertia = 0.044, kViscousTorque = 0.002, kSliding = 0.02, kStiffness = 3;
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

constexpr std::array<double, 5> kParameters = {kInertia, kViscousTorque, kSliding, kStiffness, kAngle};

double Angle(const Segment<double>& segment, double tau) { return EvaluateSeries(segment.angle, segment.order, tau); }

// Along a half swing z is a function of the angle alone: dz/dθ = 1 - s z σ/τ_c, so
// z = s z∞ + (z_0 - s z∞) exp(-|θ - θ_0| / z∞) with z∞ = τ_c/σ. With this z the equation of motion must hold
// everywhere.
TEST(FrictionWithState, ObeysTheEquationOfMotionWithTheStateAsAFunctionOfTheAngle) {
  constexpr double kSlidingState = kSliding / kStiffness;
  double z = 0, reversal_angle = kAngle, direction = -1;
  for (const Segment<double>& segment : TraceValues(kParameters)) {
    const Segment<double> rate = RateOf(segment), acceleration = RateOf(rate);
    const auto state_at = [&](double angle) {
      const double sliding = direction * kSlidingState;
      return sliding + (z - sliding) * std::exp(-std::abs(angle - reversal_angle) / kSlidingState);
    };
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      const double tau = share * (segment.end - segment.start);
      const double angle = Angle(segment, tau);
      const double balance = kInertia * Angle(acceleration, tau) + std::sin(angle) + kViscousTorque * Angle(rate, tau) +
                             kStiffness * state_at(angle);
      ASSERT_THAT(balance, DoubleNear(0, 1e-9)) << "at " << segment.start + tau << " s";
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
      Trace<double>({Gravity::kSine, kInertia, {kViscousTorque, kSliding, kStiffness}}, kAngle, &summary);
  EXPECT_EQ(summary.outcome, TraceSummary::Outcome::kComplete);
  EXPECT_EQ(summary.stop_time, std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(segments.back().end, kEnd);
  const double last = Angle(segments.back(), segments.back().end - segments.back().start);
  EXPECT_LT(std::abs(std::sin(last)), kSliding * 1.01);
  // There are more reversals than half periods π sqrt(I) of the free swing, because the bristles are stiffer than
  // gravity.
  EXPECT_THAT(summary.reversals, Gt(kEnd / (kPi * std::sqrt(kInertia))));
}

TEST(FrictionWithState, HasTheDerivativesWithRespectToAllParameters) {
  using T = ReleaseDual<Dahl>;
  const auto& p = kParameters;
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

}  // namespace
}  // namespace pendulum::friction_with_state_test
