// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/not_a_pendulum.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::not_a_pendulum_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::vector<std::string> Codes(const FitReport& report) {
  std::vector<std::string> codes;
  for (const Warning& warning : report.warnings) codes.emplace_back(warning.code.text());
  return codes;
}

SwingFit FitLongest(const Recording& recording, const FitOptions& options) {
  const ChosenSwings swings = Must(ChooseSwings(recording, {}));
  return Must(FitSwing(recording, swings.found[static_cast<std::size_t>(swings.chosen.at(0) - 1)], options));
}

/// Expects that all results are withdrawn and the warning gives the reason.
void ExpectWithdrawn(const FitReport& fit) {
  EXPECT_EQ(fit.termination, Termination::kNotConverged);
  EXPECT_THAT(fit.reason, StartsWith("this is not a free pendulum's swing: "));
  EXPECT_THAT(Codes(fit), Contains("not_a_pendulum"));
  for (const ParameterEstimate& parameter : fit.parameters) {
    SCOPED_TRACE(parameter.info.name);
    EXPECT_FALSE(parameter.std_error || parameter.lower95 || parameter.upper95);
    EXPECT_EQ(parameter.reason, parameter.fixed ? "fixed" : "not a pendulum");
  }
  for (const DerivedQuantity& quantity : fit.derived) EXPECT_FALSE(quantity.std_error) << quantity.name;
  EXPECT_TRUE(fit.covariance_names.empty());
  EXPECT_EQ(fit.covariance.size(), 0);
}

void ExpectAPendulum(const FitReport& fit) {
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_THAT(Codes(fit), Not(Contains("not_a_pendulum")));
}

// ---- A mass on a spring -------------------------------------------------------------------------------------------

/// The textbook rig with linear gravity, and therefore a constant period.
Recording LinearOscillator(double degrees, std::string_view friction, std::uint64_t seed) {
  SyntheticOptions run = NoisyRun(friction, seed);
  run.model.gravity = Gravity::kLinear;
  run.release_angle = degrees * kRadFromDeg;
  run.duration = 20;
  return Must(SimulateRecording(run));
}

/// The number after `before` in a sentence.
double NumberAfter(const std::string& sentence, const std::string& before) {
  const std::size_t at = sentence.find(before);
  if (at == std::string::npos) throw std::runtime_error("no '" + before + "' in: " + sentence);
  return std::stod(sentence.substr(at + before.size()));
}

TEST(FitSwing, ReportsALinearOscillatorWithNumbers) {
  for (const auto& [degrees, friction] :
       {std::pair(40.0, "viscous"), std::pair(80.0, "coulomb"), std::pair(40.0, "drag")}) {
    SCOPED_TRACE(std::to_string(degrees) + " deg, " + std::string(friction));
    const FitReport fit = FitLongest(LinearOscillator(degrees, friction, 1), ModelOptions("coulomb")).fit;
    ExpectWithdrawn(fit);
    // A pendulum's period is longer by the share 2 / π K(sin(A / 2)) - 1.
    const double longer = 2 / kPi * std::comp_ellint_1(std::sin(0.5 * degrees * kRadFromDeg)) - 1;
    EXPECT_THAT(NumberAfter(fit.reason, "whose period is "), DoubleNear(100 * longer, 0.15 * 100 * longer));
    EXPECT_THAT(NumberAfter(fit.reason, "longer at "), DoubleNear(degrees * kRadFromDeg, 0.05 * degrees * kRadFromDeg));
    EXPECT_THAT(NumberAfter(fit.reason, "a linear oscillator leaves "), DoubleNear(0.002, 2e-4));
    EXPECT_THAT(NumberAfter(fit.reason, "(rms), a pendulum "), testing::Gt(0.004));
    EXPECT_THAT(fit.reason, HasSubstr("; give --gravity linear for a spring or wire"));
    EXPECT_THAT(fit.reason, HasSubstr("or correct the unit to deg (--unit deg, or in the column's name)"));
  }
}

FitOptions OptionsWithoutGravity() {
  FitOptions options = ModelOptions("coulomb");
  options.may_be_spring = true;
  return options;
}

/// Readings on the levels of an encoder with so many levels in a turn, printed with five decimals.
Recording OnLevels(Recording recording, double levels) {
  recording.resolution = 2 * kPi / levels;
  for (double& value : recording.value) {
    const double level = std::round(value / recording.resolution) * recording.resolution;
    value = std::round(level * 1e5) / 1e5;
  }
  return recording;
}

void ExpectASpring(const FitReport& fit, const std::vector<double>& truth) {
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_EQ(fit.model.name, "linear_coulomb");
  EXPECT_THAT(Codes(fit), Contains("linear_restoring_torque"));
  EXPECT_THAT(Codes(fit), Not(Contains("not_a_pendulum")));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    ASSERT_TRUE(parameter.std_error) << parameter.info.name;
    EXPECT_THAT(parameter.estimate, DoubleNear(truth[i], 4 * *parameter.std_error)) << parameter.info.name;
  }
}

TEST(FitSwing, TakesASpringIfTheUnitIsCertain) {
  const std::vector<double> truth = TextbookParameters(Must(FindMotionModel("coulomb")));
  Recording degrees = LinearOscillator(60, "coulomb", 1);
  degrees.unit = "deg";
  const FitReport fit = FitLongest(degrees, OptionsWithoutGravity()).fit;
  ExpectASpring(fit, truth);
  EXPECT_THAT(MessageText(fit.warnings.at(0)),
              AllOf(HasSubstr("a restoring torque proportional to the angle is assumed"),
                    HasSubstr("the file says deg"), HasSubstr("give --gravity sin")));
  const Recording levels = OnLevels(LinearOscillator(60, "coulomb", 2), 578);
  const FitReport encoder = FitLongest(levels, OptionsWithoutGravity()).fit;
  ExpectASpring(encoder, truth);
  EXPECT_THAT(MessageText(encoder.warnings.at(0)), HasSubstr("their levels are 1/578 of a turn"));
}

TEST(FitSwing, DoesNotTakeASpringIfTheUserChoseTheModel) {
  Recording degrees = LinearOscillator(60, "coulomb", 1);
  degrees.unit = "deg";
  ExpectWithdrawn(FitLongest(degrees, ModelOptions("coulomb")).fit);
}

// A pendulum that swings by 1.8 deg, with degrees taken for rad, has a period that does not depend on the amplitude.
TEST(FitSwing, DoesNotTakeDegreesLabelledRadForASpring) {
  for (const double step_deg : {0.0, 0.01, 0.05, 360.0 / 4096, 360.0 / 8192, 360.0 / 16384}) {
    SCOPED_TRACE(step_deg);
    SyntheticOptions run = NoisyRun("coulomb", 5);
    run.release_angle = 1.8 * kRadFromDeg;
    run.zero = 0;
    run.noise = 0.02 * kRadFromDeg;
    run.parameters[2] = 1e-4;
    run.duration = 20;
    Recording recording = Must(SimulateRecording(run));
    recording.value /= kRadFromDeg;
    recording.resolution = step_deg;
    if (step_deg > 0) recording.value = (recording.value.array() / step_deg).round() * step_deg;
    EXPECT_FALSE(ReasonForUnit(recording));
    const FitReport fit = FitLongest(recording, OptionsWithoutGravity()).fit;
    ExpectWithdrawn(fit);
    EXPECT_THAT(fit.reason, HasSubstr("if this is a pendulum with an amplitude of"));
  }
}

TEST(FitSwing, AcceptsALinearOscillatorForTheLinearModel) {
  for (const double degrees : {40.0, 80.0}) {
    const Recording recording = LinearOscillator(degrees, "viscous", 1);
    const FitReport fit = FitLongest(recording, ModelOptions("linear")).fit;
    ExpectAPendulum(fit);
    EXPECT_FALSE(FindLinearMotion(recording, fit));
  }
}

TEST(FindLinearMotion, IsMissingForSmallSwings) {
  const Recording recording = LinearOscillator(10, "coulomb", 1);
  EXPECT_FALSE(FindLinearMotion(recording, Fit(recording, ModelOptions("coulomb"))));
}

TEST(FindLinearMotion, IsMissingForAFailedFit) {
  FitReport failed;
  failed.termination = Termination::kFailed;
  EXPECT_FALSE(FindLinearMotion(LinearOscillator(40, "coulomb", 1), failed));
  EXPECT_FALSE(TwoModesReason(LinearOscillator(40, "coulomb", 1), failed));
}

// ---- Two modes ----------------------------------------------------------------------------------------------------

/// A pendulum with a second mode: `share` of its amplitude at `ratio` of its natural frequency.
Recording TwoModes(double share, double ratio, double duration = 25) {
  SyntheticOptions run = NoisyRun("viscous");
  run.duration = duration;
  Recording recording = Must(SimulateRecording(run));
  const double frequency = ratio / std::sqrt(run.parameters[0]);
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double t = recording.time[i] - run.release_time;
    if (t > 0) recording.value[i] += share * run.release_angle * std::exp(-0.02 * t) * std::sin(frequency * t);
  }
  return recording;
}

TEST(FitSwing, ReportsTwoModesWithTheirPeriods) {
  const double period = 2 * kPi * std::sqrt(0.079 / kTextbookTorque);
  for (const double ratio : {0.5, 1.7, 2.4}) {
    SCOPED_TRACE(ratio);
    const FitReport fit = FitLongest(TwoModes(0.12, ratio), ModelOptions("coulomb")).fit;
    ExpectWithdrawn(fit);
    // 25 s resolve frequencies that are 1 / 25 s apart.
    EXPECT_THAT(1 / NumberAfter(fit.reason, "with a period of "), DoubleNear(ratio / period, 1.0 / 25));
    EXPECT_THAT(NumberAfter(fit.reason, "beside the pendulum's "), DoubleNear(period, 0.02 * period));
    EXPECT_THAT(NumberAfter(fit.reason, "swing: "), testing::AllOf(testing::Ge(40), testing::Le(101)));
    EXPECT_THAT(fit.reason, HasSubstr(" s: two modes, of a second pendulum, a string or a loose support"));
  }
}

TEST(FitSwing, ReportsBeatingModesOfNearlyOneFrequency) {
  const FitReport fit = FitLongest(TwoModes(0.6, 1.2, 60), ModelOptions("coulomb")).fit;
  ExpectWithdrawn(fit);
  EXPECT_EQ(fit.reason, "this is not a free pendulum's swing: its amplitude grows repeatedly, as in coupled pendulums");
}

// ---- A pendulum ---------------------------------------------------------------------------------------------------

/// 20 s of a pendulum of 5 rad/s released at 1 rad. Its friction, torque(rate) in units of the restoring torque G, is
/// in no model. Classical Runge-Kutta steps of 1 ms; noise as in NoisyRun.
template <typename Friction>
Recording PendulumWith(const Friction& torque) {
  Recording recording = Must(SimulateRecording([] {
    SyntheticOptions run = NoisyRun("viscous");
    run.duration = 20;
    return run;
  }()));
  SyntheticOptions silent = NoisyRun("viscous");
  silent.duration = 20;
  silent.noise = 0;
  recording.value -= Must(SimulateRecording(silent)).value;
  const auto rate_of = [&](const Eigen::Array2d& x) {
    return Eigen::Array2d(x[1], -25 * (std::sin(x[0]) + torque(x[1])));
  };
  Eigen::Array2d x(1.0, 0.0);
  constexpr double h = 1e-3;
  for (double& value : recording.value) {
    value += x[0];
    for (int step = 0; step < 10; ++step) {
      const Eigen::Array2d k1 = rate_of(x), k2 = rate_of(x + 0.5 * h * k1);
      const Eigen::Array2d k3 = rate_of(x + 0.5 * h * k2), k4 = rate_of(x + h * k3);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return recording;
}

TEST(FitSwing, AcceptsAPendulumWithAnotherFrictionLaw) {
  const Recording recordings[] = {
      PendulumWith([](double rate) { return 0.0004 * rate * rate * rate; }),
      PendulumWith([](double rate) { return 0.006 * rate / std::sqrt(std::abs(rate) + 1e-3); }),
      PendulumWith([](double rate) { return 0.004 * rate * std::abs(rate); })};
  for (const Recording& recording : recordings) {
    for (const std::string_view model : {"viscous", "coulomb"}) {
      SCOPED_TRACE(std::string(model) + ", recording " + std::to_string(&recording - recordings));
      const FitReport fit = FitLongest(recording, ModelOptions(model)).fit;
      ExpectAPendulum(fit);
      EXPECT_FALSE(FindLinearMotion(recording, fit));
      EXPECT_FALSE(TwoModesReason(recording, fit));
    }
  }
}

}  // namespace
}  // namespace pendulum::not_a_pendulum_test
