// SPDX-License-Identifier: Apache-2.0
// Compares traced motions with theory.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/trajectory/tolerance.h"
#include "pendulum/trajectory/trajectory.h"
#include "tests/model/typical_friction.h"
#include "tests/model/undamped_pendulum.h"

namespace pendulum::trajectory_accuracy_test {
namespace {

using testing::DoubleNear;
using testing::Le;

constexpr MotionModel kViscousModel = {"viscous", "viscous", Gravity::kSine};
constexpr MotionModel kLinearCoulomb = {"coulomb", "coulomb", Gravity::kLinear};
constexpr double kFinest = 1e-17;  // rad

Trajectory Released(const MotionModel& model, const std::vector<double>& parameters, double angle, double duration,
                    double tolerance = kFinest) {
  TraceOptions options;
  options.end = duration;
  options.tolerance = tolerance;
  return MakeTrajectory(model, parameters, {StartKind::kRelease, 0, angle, 0}, options).value();
}

template <FrictionModel F>
std::vector<Segment<double>> Segments(const Pendulum<F, double>& pendulum, double angle, double duration,
                                      double tolerance = kFinest) {
  TraceOptions options;
  options.end = duration;
  options.tolerance = tolerance;
  std::vector<Segment<double>> segments;
  TraceTrajectory(pendulum, Start<double>{StartKind::kRelease, 0, angle, 0}, options,
                  [&](const Segment<double>& segment) { segments.push_back(segment); });
  return segments;
}

struct Motion {
  double angle, rate, acceleration;
};

/// θ, θ' and θ'' from a segment's polynomial, with each power computed separately.
Motion At(const Segment<double>& segment, double time) {
  Motion motion{segment.angle[0], 0, 0};
  const double tau = time - segment.start;
  for (int k = 1; k <= segment.order; ++k) {
    motion.angle += segment.angle[k] * std::pow(tau, k);
    motion.rate += k * segment.angle[k] * std::pow(tau, k - 1);
    if (k > 1) motion.acceleration += k * (k - 1) * segment.angle[k] * std::pow(tau, k - 2);
  }
  return motion;
}

// ---- Undamped: elliptic functions --------------------------------------------------------------------------------

TEST(UndampedPendulum, FollowsTheEllipticFunctionsFromOneTo179Degrees) {
  for (int degrees = 1; degrees <= 179; ++degrees) {
    const double amplitude = degrees * kRadFromDeg;
    const Trajectory trajectory = Released(kViscousModel, {kReferenceInertia, 0}, amplitude, 20);
    double largest = 0;
    for (double time = 0; time <= 20; time += 0.0937) {
      largest = std::max(largest, std::abs(trajectory.Angle(time) - UndampedAngle(amplitude, kReferenceInertia, time)));
    }
    EXPECT_THAT(largest, Le(1e-9)) << degrees << " deg";
  }
}

/// Largest error [rad] over the last 3 s of 20 s, at the default tolerance for 1e-8 rad.
double ErrorAtTheDefaultTolerance(double amplitude) {
  const Trajectory trajectory =
      Released(kViscousModel, {kReferenceInertia, 0}, amplitude, 20, TraceTolerance(1e-8, amplitude));
  double largest = 0;
  for (const double time : {17.1, 17.7, 18.2, 18.8, 19.4, 20.0}) {
    largest = std::max(largest, std::abs(trajectory.Angle(time) - UndampedAngle(amplitude, kReferenceInertia, time)));
  }
  return largest;
}

// After a start from rest every other coefficient vanishes, at 90 deg three of four.
TEST(UndampedPendulum, KeepsTheErrorWhereCoefficientsVanish) {
  for (const double degrees : {90.0, 120.0, 150.0}) {
    EXPECT_THAT(ErrorAtTheDefaultTolerance(degrees * kRadFromDeg), Le(1e-8)) << degrees << " deg";
  }
  EXPECT_THAT(ErrorAtTheDefaultTolerance(std::acos(0.0)), Le(1e-8));
}

TEST(UndampedPendulum, KeepsTheErrorAtEveryFiftiethOfADegree) {
  for (int i = 0; i <= 5950; ++i) {
    const double degrees = 60 + 0.02 * i;
    EXPECT_THAT(ErrorAtTheDefaultTolerance(degrees * kRadFromDeg), Le(1e-8)) << degrees << " deg";
  }
}

// T(A) / T(0) = (2/π) K(sin(A/2)), with K computed by the arithmetic-geometric mean to 12 digits.
TEST(UndampedPendulum, HasThePeriodOfTheEllipticIntegral) {
  constexpr std::array<std::pair<double, double>, 7> kPeriodRatios = {{{10, 1.001907188143},
                                                                       {30, 1.017408797596},
                                                                       {60, 1.073182007149},
                                                                       {90, 1.180340599016},
                                                                       {120, 1.372880500618},
                                                                       {150, 1.762203729504},
                                                                       {170, 2.439362719674}}};
  const double small_angle_period = 2 * kPi * std::sqrt(kReferenceInertia);
  for (const auto& [degrees, ratio] : kPeriodRatios) {
    const double period = ratio * small_angle_period;
    const Pendulum<ViscousFriction, double> pendulum{Gravity::kSine, kReferenceInertia, {0}};
    const std::vector<Segment<double>> segments = Segments(pendulum, degrees * kRadFromDeg, 5.25 * period);
    int half_swings = 0;
    for (std::size_t i = 1; i < segments.size(); ++i) {
      if (At(segments[i], segments[i].start).rate != 0) continue;  // the rate is exactly 0 only at a reversal
      ++half_swings;
      EXPECT_THAT(2 * segments[i].start / half_swings / period, DoubleNear(1, 1e-11)) << degrees << " deg";
    }
    EXPECT_EQ(half_swings, 10) << degrees << " deg";
  }
}

// Benchmark problem of heyoka: x'' = -sin x from x = 1.3 at rest.
TEST(UndampedPendulum, KeepsPeriodAndEnergyOfTheHeyokaBenchmark) {
  constexpr double kPeriod = 7.019250311844546;
  const Trajectory trajectory = Released(kViscousModel, {1, 0}, 1.3, 1e4);
  double largest_drift = 0;
  for (double time = 0; time <= 1e4; time += 9.7) {
    const double energy = 0.5 * std::pow(trajectory.Rate(time), 2) - std::cos(trajectory.Angle(time));
    largest_drift = std::max(largest_drift, std::abs(energy + std::cos(1.3)));
  }
  EXPECT_THAT(largest_drift, Le(1e-11));
  EXPECT_THAT(trajectory.Angle(1424 * kPeriod), DoubleNear(1.3, 1e-11));  // 9995.4 s
  EXPECT_THAT(trajectory.Rate(1424 * kPeriod), DoubleNear(0, 1e-8));
  EXPECT_THAT(trajectory.Angle(1423.25 * kPeriod), DoubleNear(0, 1e-8));
  EXPECT_EQ(trajectory.summary().reversals, 2849);
}

// ---- Linear: closed forms ----------------------------------------------------------------------------------------

/// A linear pendulum released at `angle`. Each half swing is a damped oscillation about the angle where gravity
/// balances dry friction, until |θ| <= τ_c at a reversal.
class LinearPendulum {
 public:
  LinearPendulum(double inertia, double viscous, double coulomb, double angle)
      : decay_(viscous / (2 * inertia)), damped_(std::sqrt(1 / inertia - decay_ * decay_)), coulomb_(coulomb) {
    turning_points_.push_back(angle);
    const double q = std::exp(-decay_ * half_swing());
    while (std::abs(turning_points_.back()) > coulomb && turning_points_.size() < 1000) {
      const double from = turning_points_.back();
      turning_points_.push_back(Center(from) * (1 + q) - q * from);
    }
  }

  double half_swing() const { return kPi / damped_; }
  double stop_time() const { return static_cast<double>(turning_points_.size() - 1) * half_swing(); }

  std::pair<double, double> AngleAndRate(double time) const {
    const auto n = static_cast<std::size_t>(time / half_swing());
    if (n + 1 >= turning_points_.size()) return {turning_points_.back(), 0};
    const double center = Center(turning_points_[n]), from = turning_points_[n] - center;
    const double tau = time - static_cast<double>(n) * half_swing();
    const double envelope = from * std::exp(-decay_ * tau), phase = damped_ * tau;
    return {center + envelope * (std::cos(phase) + decay_ / damped_ * std::sin(phase)),
            -envelope * (damped_ + decay_ * decay_ / damped_) * std::sin(phase)};
  }

 private:
  double Center(double from) const { return from > 0 ? coulomb_ : -coulomb_; }

  double decay_, damped_, coulomb_;
  std::vector<double> turning_points_;
};

void ExpectLinearMotion(double viscous, double coulomb, double angle, double duration) {
  const LinearPendulum closed(kReferenceInertia, viscous, coulomb, angle);
  const Trajectory trajectory = Released(kLinearCoulomb, {kReferenceInertia, viscous, coulomb}, angle, duration);
  for (double time = 0; time <= duration; time += 0.0097) {
    const auto [expected_angle, expected_rate] = closed.AngleAndRate(time);
    ASSERT_THAT(trajectory.Angle(time), DoubleNear(expected_angle, 1e-12)) << "at " << time;
    ASSERT_THAT(trajectory.Rate(time), DoubleNear(expected_rate, 1e-11)) << "at " << time;
  }
  if (coulomb > 0) {
    EXPECT_THAT(trajectory.summary().stop_time, DoubleNear(closed.stop_time(), 1e-12));
    EXPECT_LT(closed.stop_time(), duration);
  }
}

TEST(LinearGravity, FollowsTheDampedOscillationWithViscousFriction) {
  ExpectLinearMotion(0.003 / 1.803, 0, 0.423, 60);
  ExpectLinearMotion(0.1, 0, -1.2, 20);
}

TEST(LinearGravity, FollowsTheStaircaseWithDryFriction) {
  ExpectLinearMotion(0, 0.006, 0.423, 30);
  ExpectLinearMotion(0, 0.03, -0.43, 8);
}

TEST(LinearGravity, FollowsTheClosedFormWithViscousAndDryFriction) {
  ExpectLinearMotion(0.003 / 1.803, 0.004, 0.6, 60);
}

// ζ = 1.5: θ = A (s2 e^{s1 t} - s1 e^{s2 t}) / (s2 - s1), s = (-ζ ± √(ζ² - 1)) ω_n.
TEST(LinearGravity, ReturnsWithoutReversalIfOverdamped) {
  const double root = std::sqrt(1.25), s1 = 10 * (root - 1.5), s2 = -10 * (root + 1.5);
  const Trajectory trajectory = Released({"linear", "viscous", Gravity::kLinear}, {0.01, 0.3}, 0.5, 3);
  for (double time = 0; time <= 3; time += 0.01) {
    const double expected = 0.5 * (s2 * std::exp(s1 * time) - s1 * std::exp(s2 * time)) / (s2 - s1);
    ASSERT_THAT(trajectory.Angle(time), DoubleNear(expected, 1e-12)) << "at " << time;
  }
  EXPECT_EQ(trajectory.summary().reversals, 0);
}

// ---- Every law ---------------------------------------------------------------------------------------------------

// With b = 0 the square of the rate, y = ω², obeys a linear equation in θ. In a downward half swing from A it is dy/dθ
// = k y + 2 (τ_c - sin θ) / I, k = 2 c / I, y(A) = 0; upwards it is the mirror image.
TEST(Drag, FollowsTheFirstIntegralInEachHalfSwing) {
  constexpr double kInertia = kReferenceInertia, kCoulombTorque = 0.004, kDragCoefficient = 0.002;
  const double k = 2 * kDragCoefficient / kInertia, constant = -kCoulombTorque / kDragCoefficient;
  const double cosine = 2 / (kInertia * (1 + k * k)), sine = k * cosine;
  const auto particular = [&](double x) { return constant + sine * std::sin(x) + cosine * std::cos(x); };
  const Pendulum<DragFriction, double> pendulum{Gravity::kSine, kInertia, {0, kCoulombTorque, kDragCoefficient}};
  double turn = 170 * kRadFromDeg;
  for (const Segment<double>& segment : Segments(pendulum, turn, 20)) {
    if (segment.order == 0) continue;
    const Motion first = At(segment, segment.start);
    if (first.rate == 0) turn = first.angle;
    for (const double share : {0.2, 0.5, 0.8}) {
      const Motion motion = At(segment, segment.start + share * (segment.end - segment.start));
      const double x = turn > 0 ? motion.angle : -motion.angle;
      const double expected = particular(x) - particular(std::abs(turn)) * std::exp(k * (x - std::abs(turn)));
      ASSERT_THAT(motion.rate * motion.rate, DoubleNear(expected, 1e-11)) << "at " << segment.start;
    }
  }
}

// Without viscous friction the kinetic energy obeys dK/dx = -sin x + τ (cos x + 2 K), where x falls from the turn: the
// load is cos x + 2 K > 0. Its solution is C exp(2 τ x) + (3 τ sin x + (1 - 2 τ²) cos x) / (1 + 4 τ²).
TEST(Load, FollowsTheFirstIntegralInEachHalfSwing) {
  constexpr double kTorque = 0.03;
  const auto particular = [](double x) {
    return (3 * kTorque * std::sin(x) + (1 - 2 * kTorque * kTorque) * std::cos(x)) / (1 + 4 * kTorque * kTorque);
  };
  const Pendulum<LoadFriction, double> pendulum{Gravity::kSine, kReferenceInertia, {0, kTorque}};
  double turn = 80 * kRadFromDeg;
  for (const Segment<double>& segment : Segments(pendulum, turn, 20)) {
    if (segment.order == 0) continue;
    const Motion first = At(segment, segment.start);
    if (first.rate == 0) turn = first.angle;
    for (const double share : {0.2, 0.5, 0.8}) {
      const Motion motion = At(segment, segment.start + share * (segment.end - segment.start));
      const double x = turn > 0 ? motion.angle : -motion.angle;
      const double energy = particular(x) - particular(std::abs(turn)) * std::exp(2 * kTorque * (x - std::abs(turn)));
      ASSERT_THAT(0.5 * kReferenceInertia * motion.rate * motion.rate, DoubleNear(energy, 1e-12))
          << "at " << segment.start;
    }
  }
}

/// Checks that the polynomials obey I θ'' = -sin θ - T(θ') in every step and that nothing jumps between steps.
template <FrictionModel F>
void ExpectEquationOfMotion(const Pendulum<F, double>& pendulum, double angle) {
  const std::vector<Segment<double>> segments = Segments(pendulum, angle, 20);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment<double>& segment = segments[i];
    if (i > 0) {
      const Motion before = At(segments[i - 1], segment.start), after = At(segment, segment.start);
      ASSERT_EQ(segments[i - 1].end, segment.start);
      ASSERT_THAT(after.angle, DoubleNear(before.angle, 1e-14));
      ASSERT_THAT(after.rate, DoubleNear(before.rate, 1e-13));
    }
    if (segment.order == 0) continue;
    for (const double share : {0.25, 0.5, 0.75, 0.999}) {
      const Motion motion = At(segment, segment.start + share * (segment.end - segment.start));
      const double load = std::cos(motion.angle) + pendulum.inertia * motion.rate * motion.rate;
      const double friction = TorqueUnder<F>(load, motion.rate, motion.rate > 0 ? 1.0 : -1.0, pendulum.friction.data());
      ASSERT_THAT(pendulum.inertia * motion.acceleration, DoubleNear(-std::sin(motion.angle) - friction, 1e-12))
          << F::kName << " at " << segment.start << " + " << share;
    }
  }
}

// friction_with_state_test does the same with laws that have states.
TEST(EveryLaw, ObeysTheEquationOfMotionInEveryStepAndIsContinuous) {
  FrictionModels::ForEach([]<typename F>() {
    if constexpr (HasState<F>) return;
    for (const double degrees : {10.0, 90.0, 175.0}) {
      ExpectEquationOfMotion(Pendulum<F, double>{Gravity::kSine, kReferenceInertia, TypicalFriction<F>(0.003)},
                             degrees * kRadFromDeg);
    }
  });
}

// Bristles store energy and return it: see friction_with_state_test.
TEST(EveryLaw, NeverGainsEnergy) {
  FrictionModels::ForEach([]<typename F>() {
    if constexpr (HasState<F>) return;
    std::vector<double> parameters = {kReferenceInertia};
    for (const double p : TypicalFriction<F>(0.003)) parameters.push_back(p);
    for (double degrees = 10; degrees <= 175; degrees += 15) {
      const Trajectory trajectory =
          Released({F::kName, F::kName, Gravity::kSine}, parameters, degrees * kRadFromDeg, 20);
      double before = 1 - std::cos(degrees * kRadFromDeg);
      for (double time = 0; time <= 20; time += 0.01) {
        const double energy =
            0.5 * kReferenceInertia * std::pow(trajectory.Rate(time), 2) + 1 - std::cos(trajectory.Angle(time));
        ASSERT_THAT(energy - before, Le(1e-12)) << F::kName << " from " << degrees << " deg at " << time;
        before = energy;
      }
      EXPECT_LT(before, 0.9 * (1 - std::cos(degrees * kRadFromDeg))) << F::kName;
    }
  });
}

}  // namespace
}  // namespace pendulum::trajectory_accuracy_test
