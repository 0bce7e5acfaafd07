// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/trajectory.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "tests/model/undamped_pendulum.h"

namespace pendulum::trajectory_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Le;
using Outcome = TraceSummary::Outcome;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr MotionModel kCoulombModel = {"coulomb", "coulomb", Gravity::kSine};
constexpr MotionModel kLinearCoulomb = {"coulomb", "coulomb", Gravity::kLinear};

TraceOptions Until(double end, double tolerance = 1e-14) {
  TraceOptions options;
  options.end = end;
  options.tolerance = tolerance;
  return options;
}

struct Trace {
  std::vector<Segment<double>> segments;
  TraceSummary summary;
};

template <FrictionModel F>
Trace TraceOf(const Pendulum<F, double>& pendulum, const Start<double>& start, const TraceOptions& options) {
  Trace trace;
  trace.summary = TraceTrajectory(pendulum, start, options,
                                  [&](const Segment<double>& segment) { trace.segments.push_back(segment); });
  return trace;
}

/// Linear gravity, ω0 = 5 rad/s, dry friction alone. Released at 0.43 it turns at -0.37, 0.31, ..., 0.07, -0.01. Each
/// half swing reduces the amplitude by 2 τ_c. At the end |θ| < τ_c = 0.03 and friction holds the pendulum.
const std::vector<double> kStaircase = {0.04, 0, 0.03};
constexpr double kHalfSwing = kPi / 5;  // s

Trajectory Staircase(const Start<double>& start, const TraceOptions& options) {
  return MakeTrajectory(kLinearCoulomb, kStaircase, start, options).value();
}

// ---- The hold ----------------------------------------------------------------------------------------------------

TEST(Trajectory, IsConstantUntilTheRelease) {
  TraceOptions options = Until(10);
  options.begin = -1;
  const Trajectory trajectory = Staircase({StartKind::kRelease, 1.9, 0.43, 0}, options);
  for (const double time : {-1.0, 0.0, 1.0, 1.8999, 1.9}) {
    EXPECT_EQ(trajectory.Angle(time), 0.43) << time;
    EXPECT_EQ(trajectory.Rate(time), 0) << time;
  }
  EXPECT_LT(trajectory.Angle(1.91), 0.43);
  EXPECT_THAT(trajectory.Angle(1.9 + kHalfSwing), DoubleNear(-0.37, 1e-12));
}

TEST(Trajectory, HasNoHoldIfReleasedAtTheStart) {
  const Pendulum<ViscousFriction, double> pendulum{Gravity::kSine, 0.04, {0.001}};
  const Trace trace = TraceOf(pendulum, {StartKind::kRelease, 0, 0.4, 0}, Until(1));
  ASSERT_FALSE(trace.segments.empty());
  EXPECT_GT(trace.segments.front().order, 0);
}

TEST(Trajectory, IsHeldIfTheReleaseIsAfterTheEnd) {
  const Pendulum<ViscousFriction, double> pendulum{Gravity::kSine, 0.04, {0.001}};
  const Trace trace = TraceOf(pendulum, {StartKind::kRelease, 5, 0.4, 0}, Until(3));
  ASSERT_EQ(trace.segments.size(), 1);
  EXPECT_EQ(trace.segments[0].order, 0);
  EXPECT_EQ(trace.segments[0].angle[0], 0.4);
  EXPECT_EQ(trace.segments[0].start, 0);
  EXPECT_EQ(trace.segments[0].end, 3);
  EXPECT_EQ(trace.summary.reversals, 0);
}

// ---- Rest --------------------------------------------------------------------------------------------------------

TEST(Trajectory, ReachesRestWhereTheStaircaseEnds) {
  const Trajectory trajectory = Staircase({StartKind::kRelease, 0, 0.43, 0}, Until(10));
  const TraceSummary& summary = trajectory.summary();
  EXPECT_EQ(summary.outcome, Outcome::kComplete);
  EXPECT_EQ(summary.reversals, 7);
  EXPECT_THAT(summary.stop_time, DoubleNear(7 * kHalfSwing, 1e-12));
  EXPECT_THAT(summary.smallest_reversal_margin,
              DoubleNear(0.02, 1e-12));  // ||-0.01| - 0.03|; other reversals have larger margins
  for (const double time : {7 * kHalfSwing + 1e-9, 5.0, 9.9, 10.0}) {
    EXPECT_THAT(trajectory.Angle(time), DoubleNear(-0.01, 1e-12)) << time;
    EXPECT_EQ(trajectory.Rate(time), 0) << time;
  }
}

TEST(Trajectory, NeverStopsWithoutDryFriction) {
  const Trajectory trajectory = MakeTrajectory({"viscous", "viscous", Gravity::kSine}, std::array{0.04, 0.01},
                                               {StartKind::kRelease, 0, 0.4, 0}, Until(60))
                                    .value();
  EXPECT_EQ(trajectory.summary().stop_time, kInfinity);
  EXPECT_GT(trajectory.summary().reversals, 90);
}

TEST(Trajectory, HasTheSmallestMarginOfAllReversals) {
  // The pendulum turns at 0.31 (margin 0.28). The trace ends on the way to the next turning point at -0.25.
  const Trajectory trajectory = Staircase({StartKind::kRelease, 0, -0.37, 0}, Until(1.5 * kHalfSwing));
  EXPECT_EQ(trajectory.summary().reversals, 1);
  EXPECT_THAT(trajectory.summary().smallest_reversal_margin, DoubleNear(0.28, 1e-12));
}

// The last half swings of a staircase from 1e-6 rad at a tolerance of 1e-8 rad, where accuracy would permit any step.
TEST(Trajectory, MissesNoReversalBecauseStepsAreLimited) {
  const Pendulum<CoulombFriction, double> pendulum{Gravity::kLinear, 0.04, {0, 3e-8}};
  const Trace trace = TraceOf(pendulum, {StartKind::kRelease, 0, 1e-6, 0}, Until(20, 1e-8));
  for (const Segment<double>& segment : trace.segments) {
    const double step = segment.order == 0 ? 0 : segment.end - segment.start;
    EXPECT_THAT(step, Le(0.5 * kHalfSwing * (1 + 1e-12)));
  }
  EXPECT_EQ(trace.summary.reversals, 17);
  EXPECT_THAT(trace.summary.stop_time, DoubleNear(17 * kHalfSwing, 1e-6));
  EXPECT_THAT(trace.segments.back().angle[0], DoubleNear(2e-8, 1e-12));  // -(1e-6 - 34 · 3e-8)
}

TEST(Rest, HoldsAtAnAngleWhereGravityDoesNotExceedDryFriction) {
  const Pendulum<CoulombFriction, double> pendulum{Gravity::kSine, 0.04, {0, 0.25}};
  const double limit = std::asin(0.25);
  for (const double angle : {0.0, 0.1, -0.1, limit, -limit, kPi - 0.2}) {
    const Trace trace = TraceOf(pendulum, {StartKind::kRelease, 0.5, angle, 0}, Until(2));
    EXPECT_EQ(trace.summary.outcome, Outcome::kNeverMoved) << angle;
    for (const Segment<double>& segment : trace.segments) {
      EXPECT_EQ(segment.order, 0) << angle;
      EXPECT_EQ(segment.angle[0], angle);
    }
  }
  for (const double angle : {limit + 1e-6, -limit - 1e-6, kPi - limit - 1e-6}) {
    const Trace trace = TraceOf(pendulum, {StartKind::kRelease, 0.5, angle, 0}, Until(2));
    EXPECT_EQ(trace.summary.outcome, Outcome::kComplete) << angle;
    EXPECT_GT(trace.segments.back().order + trace.summary.reversals, 0) << angle;
  }
}

// The turning points are 0.09 and -0.03. At -0.03, |θ| = τ_c up to rounding, and the pendulum must stay.
TEST(Rest, HoldsAtEqualityDespiteRounding) {
  const Trajectory trajectory = Staircase({StartKind::kRelease, 0, 0.09, 0}, Until(5, 1e-17));
  EXPECT_EQ(trajectory.summary().reversals, 1);
  EXPECT_THAT(trajectory.Angle(5), DoubleNear(-0.03, 1e-15));
}

TEST(MovingStart, FollowsItsAccelerationAtRateZero) {
  for (const double angle : {0.3, -0.3}) {
    const Trajectory trajectory = Staircase({StartKind::kMoving, 0, angle, 0}, Until(10));
    EXPECT_LT(trajectory.Rate(0.01) * angle, 0);
    EXPECT_LT(std::abs(trajectory.Angle(0.01)), 0.3);
  }
}

TEST(MovingStart, NeverMovesAtRateZeroInsideTheRestBand) {
  const Pendulum<CoulombFriction, double> pendulum{Gravity::kLinear, 0.04, {0, 0.03}};
  EXPECT_EQ(TraceOf(pendulum, {StartKind::kMoving, 0, 0.02, 0}, Until(1)).summary.outcome, Outcome::kNeverMoved);
}

// In a half swing θ - x and θ' / ω0 move on a circle. In an upward half swing x = -τ_c = -0.03, so the pendulum turns
// at -0.03 + sqrt(0.23² + 0.3²).
TEST(MovingStart, ContinuesInTheDirectionOfItsRate) {
  const Trajectory trajectory = Staircase({StartKind::kMoving, 0, 0.2, 1.5}, Until(10));
  const double turn = std::atan2(0.3, 0.23) / 5;
  EXPECT_EQ(trajectory.Angle(0), 0.2);
  EXPECT_EQ(trajectory.Rate(0), 1.5);
  EXPECT_THAT(trajectory.Angle(turn), DoubleNear(std::hypot(0.23, 0.3) - 0.03, 1e-12));
  EXPECT_THAT(trajectory.Rate(turn), DoubleNear(0, 1e-11));
}

TEST(MovingStart, MovesInsideTheRestBandWithARate) {
  const Trajectory trajectory = Staircase({StartKind::kMoving, 0, 0.0, 0.05}, Until(3));
  // θ + 0.03 and θ' / ω0 move on a circle of radius hypot(0.03, 0.05 / 5). The pendulum stops where θ + 0.03 equals
  // this radius, which is within the band.
  EXPECT_EQ(trajectory.summary().reversals, 1);
  EXPECT_THAT(trajectory.Angle(3), DoubleNear(std::hypot(0.03, 0.01) - 0.03, 1e-12));
}

TEST(MovingStart, GoesOverTheTopIfFastEnough) {
  const Trajectory trajectory = MakeTrajectory({"viscous", "viscous", Gravity::kSine}, std::array{1.0, 0.0},
                                               {StartKind::kMoving, 0, 0.0, 3.0}, Until(20, 1e-16))
                                    .value();
  EXPECT_EQ(trajectory.summary().reversals, 0);
  EXPECT_GT(trajectory.Angle(20), 4 * kPi);
  // Energy: ω² = 9 - 2 (1 - cos θ).
  for (double time = 0; time < 20; time += 0.1) {
    const double rate = trajectory.Rate(time);
    ASSERT_THAT(rate * rate, DoubleNear(7 + 2 * std::cos(trajectory.Angle(time)), 1e-12));
  }
}

// ---- Dense output ------------------------------------------------------------------------------------------------

TEST(Trajectory, HasContiguousSegmentsFromStartToEnd) {
  TraceOptions options = Until(20);
  options.begin = 0.5;
  const Pendulum<CoulombFriction, double> pendulum{Gravity::kSine, kReferenceInertia, {0.0017, 0.02}};
  const Trace trace = TraceOf(pendulum, {StartKind::kRelease, 1.9, 0.423, 0}, options);
  EXPECT_EQ(trace.segments.front().start, 0.5);
  EXPECT_EQ(trace.segments.back().end, 20);
  for (std::size_t i = 1; i < trace.segments.size(); ++i) {
    EXPECT_EQ(trace.segments[i].start, trace.segments[i - 1].end);
    EXPECT_GT(trace.segments[i].end, trace.segments[i].start);
  }
  EXPECT_LT(trace.summary.stop_time, 20);
}

TEST(Trajectory, AngleAndRateAreContinuousAcrossSegmentsAndReversals) {
  const Start<double> start{StartKind::kRelease, 0.2, 1.2, 0};
  const std::vector<double> parameters = {kReferenceInertia, 0.0017, 0.02};
  const Pendulum<CoulombFriction, double> pendulum{Gravity::kSine, kReferenceInertia, {0.0017, 0.02}};
  const Trace trace = TraceOf(pendulum, start, Until(20));
  const Trajectory trajectory = MakeTrajectory(kCoulombModel, parameters, start, Until(20)).value();
  for (const Segment<double>& segment : trace.segments) {
    const double after = segment.end, before = std::nextafter(after, 0.0);
    EXPECT_THAT(trajectory.Angle(after), DoubleNear(trajectory.Angle(before), 1e-13)) << "at " << after;
    EXPECT_THAT(trajectory.Rate(after), DoubleNear(trajectory.Rate(before), 1e-11)) << "at " << after;
  }
}

TEST(Trajectory, HasARateThatIsTheDerivativeOfTheAngle) {
  const Trajectory trajectory = Staircase({StartKind::kMoving, 0, 0.4, -0.5}, Until(2));
  for (double time = 0.0101; time < 2; time += 0.0731) {
    const double slope = (trajectory.Angle(time + 1e-5) - trajectory.Angle(time - 1e-5)) / 2e-5;
    EXPECT_THAT(trajectory.Rate(time), DoubleNear(slope, 1e-8)) << time;
  }
}

// The motion does not depend on the origin of time.
TEST(Trajectory, DoesNotDependOnTheClock) {
  const Trajectory early = Staircase({StartKind::kRelease, 0, 0.43, 0}, Until(3));
  TraceOptions options = Until(1027);
  options.begin = 1024;
  const Trajectory late = Staircase({StartKind::kRelease, 1024, 0.43, 0}, options);
  for (double time = 0; time < 3; time += 0.01) {
    EXPECT_THAT(late.Angle(1024 + time), DoubleNear(early.Angle(time), 1e-11)) << time;
  }
}

// ---- Invalid input -----------------------------------------------------------------------------------------------

TEST(MakeTrajectory, RefusesAWrongNumberOfParameters) {
  const Result<Trajectory> trajectory =
      MakeTrajectory(kCoulombModel, std::array{0.04, 0.001}, {StartKind::kRelease, 0, 0.4, 0}, Until(1));
  ASSERT_FALSE(trajectory);
  EXPECT_EQ(trajectory.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(trajectory.error().message(), HasSubstr("model coulomb takes 3 parameters, not 2"));
}

TEST(MakeTrajectory, RefusesANonPositiveInertia) {
  for (const double inertia : {0.0, -0.04, kNan}) {
    const Result<Trajectory> trajectory =
        MakeTrajectory(kCoulombModel, std::array{inertia, 0.0, 0.0}, {StartKind::kRelease, 0, 0.4, 0}, Until(1));
    ASSERT_FALSE(trajectory) << inertia;
    EXPECT_EQ(trajectory.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(trajectory.error().message(), HasSubstr("inertia"));
    EXPECT_THAT(trajectory.error().message(), HasSubstr("must be positive"));
  }
}

TEST(MakeTrajectory, RefusesAPendulumHeldByFriction) {
  const Result<Trajectory> trajectory =
      MakeTrajectory(kCoulombModel, std::array{0.04, 0.0, 0.5}, {StartKind::kRelease, 0, 0.4, 0}, Until(1));
  ASSERT_FALSE(trajectory);
  EXPECT_EQ(trajectory.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(trajectory.error().message(), HasSubstr("never moves"));
}

// 2e10 small-angle periods in 20 s.
TEST(MakeTrajectory, RefusesAnAbsurdTimeScale) {
  TraceOptions options = Until(20);
  options.max_steps = 1000;
  const Result<Trajectory> trajectory = MakeTrajectory({"viscous", "viscous", Gravity::kSine}, std::array{2.5e-20, 0.0},
                                                       {StartKind::kRelease, 0, 0.4, 0}, options);
  ASSERT_FALSE(trajectory);
  EXPECT_EQ(trajectory.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(trajectory.error().message(), HasSubstr("cannot be computed"));
  EXPECT_THAT(trajectory.error().message(), HasSubstr("time scale is too short"));
}

TEST(TraceTrajectory, StopsAtTheStepLimit) {
  TraceOptions options = Until(1e6);
  options.max_steps = 100;
  const Trace trace =
      TraceOf(Pendulum<ViscousFriction, double>{Gravity::kSine, 0.04, {0}}, {StartKind::kMoving, 0, 0.4, 0}, options);
  EXPECT_EQ(trace.summary.outcome, Outcome::kNotTraceable);
  EXPECT_THAT(trace.segments.size(), Le(100));
}

TEST(TraceTrajectory, RefusesNonFiniteNumbers) {
  for (const double bad : {kNan, kInfinity, 1e300}) {
    const Pendulum<ViscousFriction, double> pendulum{Gravity::kSine, 0.04, {bad}};
    EXPECT_EQ(TraceOf(pendulum, {StartKind::kMoving, 0, 0.4, 1.0}, Until(1)).summary.outcome, Outcome::kNotTraceable)
        << bad;
  }
}

}  // namespace
}  // namespace pendulum::trajectory_test
