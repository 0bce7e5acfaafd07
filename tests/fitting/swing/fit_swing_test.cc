// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/fit_swing.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/likelihood/depth_table.h"
#include "pendulum/base/rounding.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "tests/base/warning_matchers.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::fit_swing_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Lt;
using testing::Not;

SwingFit FitChosen(const Recording& recording, const FitOptions& options, const SwingChoice& choice = {}) {
  const ChosenSwings swings = Must(ChooseSwings(recording, choice));
  return Must(FitSwing(recording, swings.found[static_cast<std::size_t>(swings.chosen.at(0) - 1)], options));
}

std::vector<std::string> Codes(const FitReport& report) {
  std::vector<std::string> codes;
  for (const Warning& warning : report.warnings) codes.emplace_back(warning.code.text());
  return codes;
}

constexpr double kHalfPeriod = 0.671;  // s, of the textbook rig at 0.4 rad: π sqrt(0.079 / G) (1 + 0.4² / 16)

/// A hand guides the pendulum through half swing `half` (from 0) after its release, then lets go at the state of free
/// motion.
Recording Guided(const SyntheticOptions& run, int half, double by = 0.05) {
  Recording recording = Must(SimulateRecording(run));
  const double from = run.release_time + half * kHalfPeriod;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double share = (recording.time[i] - from) / kHalfPeriod;
    if (share > 0 && share < 1) recording.value[i] += by * std::pow(std::sin(kPi * share), 2);
  }
  return recording;
}

void ExpectTruthOfThePendulum(const FitReport& fit, const SyntheticOptions& run) {
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  for (int k = 0; k < 3; ++k) {
    const ParameterEstimate& parameter = fit.parameters[static_cast<std::size_t>(k)];
    EXPECT_THAT(parameter.estimate, DoubleNear(run.parameters[static_cast<std::size_t>(k)], 4 * *parameter.std_error))
        << parameter.info.name;
  }
}

TEST(FitSwing, RemovesAFirstHalfSwingGuidedByHand) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    SyntheticOptions run = NoisyRun("coulomb", seed);
    run.duration = 20;
    const SwingFit result = FitChosen(Guided(run, 0), ModelOptions("coulomb"));
    EXPECT_THAT(result.swing.from, AllOf(Ge(1.9 + 0.9 * kHalfPeriod), Le(1.9 + 2.1 * kHalfPeriod)));
    EXPECT_EQ(result.swing.to, 19.99);
    EXPECT_EQ(Sentence(result.swing.begins), "the motion before does not fit: a touch, or another law");
    EXPECT_THAT(result.used.time[0] - result.swing.from, AllOf(Ge(0.0), Lt(0.01)));
    ExpectTruthOfThePendulum(result.fit, run);
  }
}

TEST(FitSwing, RemovesALastHalfSwingGuidedByHand) {
  SyntheticOptions run = NoisyRun("coulomb", 1);
  run.duration = 1.9 + 28.5 * kHalfPeriod;
  run.noise = 0.0005;
  const SwingFit result = FitChosen(Guided(run, 27, 0.015), ModelOptions("coulomb"));
  EXPECT_THAT(result.swing.to, AllOf(Ge(1.9 + 25 * kHalfPeriod), Le(1.9 + 27.2 * kHalfPeriod)));
  EXPECT_EQ(result.swing.from, 0);
  EXPECT_EQ(Sentence(result.swing.ends), "the motion after does not fit: a touch, or another law");
  ExpectTruthOfThePendulum(result.fit, run);
}

// A Pohl wheel with strong dry friction that a hand moves aside first: the motion of the hand is no oscillator's
// either, so only the rest shows that the restoring torque is proportional to the angle.
TEST(FitSwing, RejectsALinearOscillatorAfterAMotionByHand) {
  constexpr double kHand = 1;  // s
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SyntheticOptions options;
    options.model = FindMotionModel("linear_coulomb").value();
    options.parameters = {1 / 20.1, 0.03 / 20.1, 1.95 / 20.1};
    options.start = StartKind::kMoving;
    options.initial_angle = -2.3;
    options.start_time = kHand;
    options.sample_rate = 20;
    options.duration = 11;
    options.noise = 0.003;
    options.resolution = kPi / 180;
    options.seed = seed;
    const Recording free = Must(SimulateRecording(options));
    const auto by_hand = static_cast<Eigen::Index>(kHand * options.sample_rate);
    Recording recording = free;
    recording.time.resize(by_hand + free.size());
    recording.value.resize(by_hand + free.size());
    recording.time << Eigen::ArrayXd::LinSpaced(by_hand, 0, kHand - 1 / options.sample_rate).matrix(), free.time;
    const Eigen::ArrayXd aside =
        0.5 * options.initial_angle * (1 - (kPi * recording.time.head(by_hand).array() / kHand).cos());
    recording.value << ((aside / options.resolution).round() * options.resolution).matrix(), free.value;
    const SwingFit result = FitChosen(recording, ModelOptions("coulomb"));
    EXPECT_EQ(result.fit.termination, Termination::kNotConverged) << seed;
    EXPECT_THAT(result.fit.reason, HasSubstr("the period does not depend on the amplitude as in a pendulum")) << seed;
  }
}

TEST(FitSwing, ReportsTheRemovedEnds) {
  SyntheticOptions run = NoisyRun();
  run.duration = 20;
  const SwingFit result = FitChosen(Guided(run, 0), ModelOptions("coulomb"));
  ASSERT_THAT(Codes(result.fit), ElementsAre("ends_trimmed"));
  EXPECT_THAT(KeptAttempts(result.fit), ElementsAre("disturbed_ends"));
  ASSERT_TRUE(result.swing.left_out);
  EXPECT_TRUE(result.swing.left_out->is_largest);
  EXPECT_GT(result.swing.left_out->larger_errors, 1);
  EXPECT_EQ(MessageText(result.fit.warnings[0]),
            "disturbed ends were left out, because they do not fit the rest: the window is now " +
                FixedText(result.swing.from, 2) + " s to 19.99 s; choose another one with --from and --to");
}

TEST(FitSwing, KeepsTheWholeWindowOfACleanRecording) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const SyntheticOptions run = NoisyRun("coulomb", seed);
    const Recording recording = Must(SimulateRecording(run));
    const SwingFit result = FitChosen(recording, ModelOptions("coulomb"));
    EXPECT_EQ(result.used.time, recording.time);
    EXPECT_THAT(result.fit.solver.attempts, IsEmpty());
    EXPECT_THAT(Codes(result.fit), Not(Contains("ends_trimmed")));
    EXPECT_FALSE(result.swing.left_out);
    ExpectTruthOfThePendulum(result.fit, run);
  }
}

TEST(FitSwing, KeepsTheWindowIfOnlyTheModelIsWrong) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    SyntheticOptions run = NoisyRun("drag", seed);
    run.release_angle = 1.2;
    run.noise = 0.0005;
    const Recording recording = Must(SimulateRecording(run));
    const SwingFit result = FitChosen(recording, ModelOptions("viscous"));
    EXPECT_EQ(result.used.time, recording.time);
    EXPECT_THAT(Codes(result.fit), ElementsAre("lack_of_fit", "suspected_friction_law"));
  }
}

TEST(FitSwing, KeepsTheUsersBounds) {
  SyntheticOptions run = NoisyRun();
  run.duration = 20;
  const Recording recording = Guided(run, 0);
  const SwingFit from = FitChosen(recording, ModelOptions("coulomb"), {.from = 0.5});
  EXPECT_EQ(from.used.time[0], 0.5);
  EXPECT_THAT(Codes(from.fit), AllOf(Contains("lack_of_fit"), Not(Contains("ends_trimmed"))));
  const SwingFit both = FitChosen(recording, ModelOptions("coulomb"), {.from = 0.5, .to = 19});
  EXPECT_EQ(both.used.size(), 1851);
  const SwingFit to = FitChosen(recording, ModelOptions("coulomb"), {.to = 19});
  EXPECT_EQ(to.used.time[to.used.size() - 1], 19);
  EXPECT_THAT(to.used.time[0], Ge(1.9));
}

TEST(FitSwing, ReturnsTheErrorOfTheFit) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FreeSwing swing = Must(ChooseSwings(recording, {})).found.at(0);
  const auto refused = FitSwing(recording, swing, ModelOptions("columb"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.error().message(), HasSubstr("there is no model 'columb'"));
}

// A phone's "Linear Acceleration" that contains gravity, across the rod and along it, and an acceleration of which the
// phone has removed it.
TEST(FitSwing, FindsWhetherAnAccelerationContainsGravity) {
  for (const auto& [gravity, axis] : {std::pair{0.0, 0.3}, {kStandardGravity, 0.0}, {kStandardGravity, 0.5 * kPi}}) {
    SCOPED_TRACE(testing::Message() << gravity << ", " << axis);
    SyntheticOptions options =
        MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.03, 1, axis, 0.2}, 0.02);
    options.sensor.gravity = gravity;
    options.duration = 20;
    const Recording named = Must(SimulateRecording(options));
    EXPECT_FALSE(FitChosen(named, {}).fit.HasWarning("gravity_in_readings"));

    Recording misnamed = named;
    misnamed.shows_gravity = !named.shows_gravity;
    const SwingFit result = FitChosen(misnamed, {});
    const ParameterEstimate& radius = *result.fit.Find("radius");
    EXPECT_TRUE(result.fit.HasWarning("gravity_in_readings"));
    ASSERT_TRUE(radius.std_error) << result.fit.reason;
    EXPECT_NEAR(radius.estimate, 0.2, 4 * *radius.std_error);
    EXPECT_NEAR(result.fit.Find("inertia")->estimate, options.parameters[0], 1e-3 * options.parameters[0]);
  }
}

// Without dry friction both readings of a name describe the motion, at different radii: the name is believed.
TEST(FitSwing, BelievesTheNameOfAnAccelerationThatItsReadingsDoNotContradict) {
  for (const double radius : {0.1, 0.3}) {
    for (const double angle : {0.2, 0.5}) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SyntheticOptions options =
            MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, radius}, 0.05);
        options.model = FindMotionModel("viscous").value();
        options.parameters = {0.04, 0.002};
        options.initial_angle = angle;
        options.duration = 12;
        options.sample_rate = 50;
        options.seed = seed;
        const SwingFit result = FitChosen(Must(SimulateRecording(options)), ModelOptions("viscous"));
        EXPECT_FALSE(result.fit.HasWarning("gravity_in_readings")) << radius << ", " << angle << ", " << seed;
      }
    }
  }
}

TEST(FitSwing, RemovesWholeTurnsFromTheZero) {
  SyntheticOptions truth = NoisyRun("coulomb", 3);
  truth.start = StartKind::kMoving;
  truth.release_angle = truth.release_time = 0;
  truth.initial_rate = 3.2 / std::sqrt(truth.parameters[0]);  // 2 ω0 just reaches the top
  truth.duration = 40;
  const Recording recording = Must(SimulateRecording(truth));
  const FreeSwing swing = Must(ChooseSwings(recording, {})).found.front();
  EXPECT_EQ(Sentence(swing.begins), "after its whole turns");
  const SwingFit result = Must(FitSwing(recording, swing, ModelOptions("coulomb")));
  EXPECT_THAT(result.fit.Find("zero_angle")->estimate, DoubleNear(truth.zero, 0.01));
  EXPECT_THAT(result.fit.warnings, Contains(CodeIs("whole_turns_removed")));
}

}  // namespace
}  // namespace pendulum::fit_swing_test
