// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/torque_response.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::torque_response_test {
namespace {

/// The motion of a run at its samples.
MotionStates StatesOf(const SyntheticOptions& run, const Eigen::VectorXd& time) {
  Start<double> start;
  start.kind = run.start;
  start.time = run.start == StartKind::kRelease ? run.release_time : 0;
  start.angle = run.start == StartKind::kRelease ? run.release_angle : run.initial_angle;
  start.rate = run.start == StartKind::kRelease ? 0 : run.initial_rate;
  TraceOptions options;
  options.end = time[time.size() - 1] + 1e-9;
  options.tolerance = 1e-13;
  const Trajectory motion = Must(MakeTrajectory(run.model, run.parameters, start, options));
  MotionStates states;
  for (Eigen::VectorXd& column : states.value) column.resize(time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    states.value[0][i] = motion.Angle(time[i]);
    states.value[1][i] = motion.Rate(time[i]);
    states.value[2][i] = motion.Acceleration(time[i]);
  }
  return states;
}

Eigen::VectorXd EvenTimes(double rate, double duration) {
  const auto samples = static_cast<Eigen::Index>(rate * duration) + 1;
  return Eigen::VectorXd::LinSpaced(samples, 0, duration);
}

constexpr int Column(Disturbance disturbance) { return static_cast<int>(disturbance); }

/// A run of a model that begins to swing at once at 0.5 rad.
SyntheticOptions SwingOf(std::string_view model, std::vector<double> parameters) {
  SyntheticOptions run;
  run.model = Must(FindMotionModel(model));
  run.parameters = std::move(parameters);
  run.start = StartKind::kMoving;
  run.initial_angle = 0.5;
  return run;
}

TEST(TorqueResponse, OfALinearPendulumIsThatOfAHarmonicOscillator) {
  const double inertia = 0.04;
  const double omega = 1 / std::sqrt(inertia);
  const SyntheticOptions run = SwingOf("linear", {inertia, 0.0});
  const Eigen::VectorXd time = EvenTimes(50, 10);
  const DisturbedMotion response = RespondToDisturbances(
      time, StatesOf(run, time), 0, std::numeric_limits<double>::infinity(), run.model, run.parameters);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const double phase = omega * time[i];
    EXPECT_NEAR(response.angle(i, Column(Disturbance::kPush)), std::sin(phase) / omega, 2e-3 / omega);
    EXPECT_NEAR(response.angle(i, Column(Disturbance::kConstant)), std::cos(phase) - 1, 4e-3);
    EXPECT_NEAR(response.rate(i, Column(Disturbance::kPush)), std::cos(phase), 2e-3);
  }
}

/// The change of the motion by a small change of one friction parameter, per unit, by differences of traced motions.
Eigen::VectorXd ChangeBy(SyntheticOptions run, std::size_t parameter, const Eigen::VectorXd& time) {
  constexpr double kStep = 1e-6;
  const Eigen::VectorXd before = StatesOf(run, time).value[0];
  run.parameters[parameter] += kStep;
  return (StatesOf(run, time).value[0] - before) / kStep;
}

TEST(TorqueResponse, EqualsDifferencesOfTracedMotionsThroughReversals) {
  const SyntheticOptions run = SwingOf("drag", {0.04, 0.001, 0.01, 0.0});
  const Eigen::VectorXd time = EvenTimes(100, 8);
  const MotionStates states = StatesOf(run, time);
  const DisturbedMotion response =
      RespondToDisturbances(time, states, 0, std::numeric_limits<double>::infinity(), run.model, run.parameters);
  const double largest_rate = states.value[1].cwiseAbs().maxCoeff();
  const Eigen::VectorXd by_dry = ChangeBy(run, 2, time);
  const Eigen::VectorXd by_drag = ChangeBy(run, 3, time) / (largest_rate * largest_rate);
  constexpr double kAccuracy = 0.05;
  EXPECT_LT((response.angle.col(Column(Disturbance::kDry)) - by_dry).norm(), kAccuracy * by_dry.norm());
  EXPECT_LT((response.angle.col(Column(Disturbance::kSquare)) - by_drag).norm(), kAccuracy * by_drag.norm());
}

/// The response of a run that swings to a disturbance, at 400 Hz.
struct Responded {
  Eigen::VectorXd time = EvenTimes(400, 6);
  MotionStates states;
  DisturbedMotion response;

  explicit Responded(const SyntheticOptions& run)
      : states(StatesOf(run, time)),
        response(RespondToDisturbances(time, states, 0, std::numeric_limits<double>::infinity(), run.model,
                                       run.parameters)) {}

  void ExpectNear(Disturbance disturbance, const Eigen::VectorXd& expected, double accuracy) const {
    const Eigen::VectorXd error = response.angle.col(Column(disturbance)) - expected;
    EXPECT_LT(error.norm(), accuracy * expected.norm()) << Column(disturbance);
  }
};

TEST(TorqueResponse, OfStickingEqualsDifferencesOfTracedStribeckMotions) {
  const Responded coulomb(SwingOf("coulomb", {0.04, 0.001, 0.01}));
  const double largest_rate = coulomb.states.value[1].cwiseAbs().maxCoeff();
  const auto change_by_stiction = [&](double width) {
    return ChangeBy(SwingOf("stribeck", {0.04, 0.001, 0.01, 0.01, width * largest_rate}), 3, coulomb.time);
  };
  coulomb.ExpectNear(Disturbance::kNarrowStick, change_by_stiction(0.1), 0.15);
  coulomb.ExpectNear(Disturbance::kWideStick, change_by_stiction(0.35), 0.05);
}

// After a reversal Dahl's torque is that of dry friction less 2 s τ_c exp(-x / θ_p).
TEST(TorqueResponse, OfBristlesEqualsTheDifferenceOfTracedDahlAndCoulombMotions) {
  constexpr double kDry = 1e-5;
  const SyntheticOptions run = SwingOf("coulomb", {0.04, 0.001, kDry});
  const Responded coulomb(run);
  const double largest_angle = coulomb.states.value[0].cwiseAbs().maxCoeff();
  const auto change_by_bristles = [&](double reach) -> Eigen::VectorXd {
    const SyntheticOptions dahl = SwingOf("dahl", {0.04, 0.001, kDry, reach * largest_angle});
    return (StatesOf(dahl, coulomb.time).value[0] - coulomb.states.value[0]) / (-2 * kDry);
  };
  coulomb.ExpectNear(Disturbance::kShortBristle, change_by_bristles(0.05), 0.1);
  coulomb.ExpectNear(Disturbance::kLongBristle, change_by_bristles(0.2), 0.05);
}

TEST(TorqueResponse, BeginsAtTheReleaseAndEndsAtTheStop) {
  SyntheticOptions run = SwingOf("coulomb", {0.04, 0.001, 0.05});
  run.start = StartKind::kRelease;
  run.release_angle = 0.4;
  run.release_time = 1;
  const Eigen::VectorXd time = EvenTimes(100, 6);
  const double stop = 4;
  const DisturbedMotion response =
      RespondToDisturbances(time, StatesOf(run, time), run.release_time, stop, run.model, run.parameters);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const bool is_held = time[i]<run.release_time, is_at_rest = time[i]> stop;
    EXPECT_TRUE(!is_held || response.angle(i, Column(Disturbance::kDry)) == 0);
    EXPECT_TRUE(!is_at_rest || response.rate(i, Column(Disturbance::kDry)) == 0);
  }
  EXPECT_GT(response.angle(120, Column(Disturbance::kDry)), 0);  // 0.2 s after the release: it moves back less far
  EXPECT_EQ(response.angle(time.size() - 1, Column(Disturbance::kDry)),
            response.angle(time.size() - 100, Column(Disturbance::kDry)));
}

}  // namespace
}  // namespace pendulum::torque_response_test
