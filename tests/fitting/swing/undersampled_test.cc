// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/undersampled.h"

#include <cmath>
#include <optional>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "tests/base/warning_matchers.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::undersampled_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;
using testing::Lt;
using testing::Not;

constexpr double kInertiaTruth = 0.079;  // kg m^2, as published
constexpr double kGeometric = 0.0761;    // kg m^2, m l²/3 + M l²
constexpr double kFrequency = 0.76034;   // Hz, sqrt(1.803 / 0.079) / 2π
constexpr double kSlowInertia = 0.36;    // kg m^2: with the same torque a pendulum of 2 m, 0.356 Hz

Rig TextbookRig() {
  Rig rig;
  rig.gravity_torque = {kTextbookTorque, 0};
  rig.inertia = RigValue{kGeometric, 0};
  return rig;
}

/// The textbook pendulum in motion at a random phase: viscous friction, 30 s, noise of one count.
SyntheticOptions Swing(double rate_hz, double amplitude, std::uint64_t seed, double inertia = kInertiaTruth) {
  std::mt19937_64 generator(1000 + seed);
  const double phase = 2 * kPi * static_cast<double>(generator() >> 11) * 0x1p-53;
  SyntheticOptions options;
  options.model = Must(FindMotionModel("viscous"));
  options.parameters = {inertia / kTextbookTorque, 0.003 / kTextbookTorque};
  options.start = StartKind::kMoving;
  options.initial_angle = amplitude * std::cos(phase);
  options.initial_rate = -amplitude * std::sin(phase) * std::sqrt(kTextbookTorque / inertia);
  options.duration = 30;
  options.sample_rate = rate_hz;
  options.zero = 0.012;
  options.noise = 0.2 * kRadFromDeg;
  options.resolution = kCount;
  options.seed = seed;
  return options;
}

SwingFit FitAsTheToolDoes(const Recording& recording, const std::optional<Rig>& rig, FitOptions options = {}) {
  options.rig = rig;
  const ChosenSwings swings = Must(ChooseSwings(recording, {}, rig));
  return Must(FitSwing(recording, swings.found[static_cast<std::size_t>(swings.chosen.at(0) - 1)], options));
}

SwingFit FitSimulated(const SyntheticOptions& options, const std::optional<Rig>& rig, std::string_view model) {
  return FitAsTheToolDoes(Must(SimulateRecording(options)), rig, ModelOptions(model));
}

double InertiaOf(const SwingFit& result) { return result.fit.Find("inertia")->estimate; }

auto HasWarning(const std::string& code) { return Contains(CodeIs(code)); }

/// Deviations from the truth in standard errors.
struct Scatter {
  int far = 0;  ///< Number of deviations beyond 4 standard errors.
  double std_dev = 0;
};

Scatter ScatterOf(double rate_hz, double amplitude, std::string_view model, int seeds) {
  double sum = 0;
  Scatter scatter;
  for (int seed = 1; seed <= seeds; ++seed) {
    const SwingFit result =
        FitSimulated(Swing(rate_hz, amplitude, static_cast<std::uint64_t>(seed)), TextbookRig(), model);
    EXPECT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
    const double z = (InertiaOf(result) - kInertiaTruth) / result.fit.Find("inertia")->std_error.value_or(1e-99);
    sum += z * z;
    scatter.far += std::abs(z) > 4 ? 1 : 0;
  }
  scatter.std_dev = std::sqrt(sum / seeds);
  return scatter;
}

// ---- With the rig's geometry ---------------------------------------------------------------------------------------

TEST(FitUndersampled, FindsTheInertiaOfATextbookRunSampledOnceASecond) {
  // z with 24 degrees of freedom has a standard deviation of 1.04, which 60 seeds determine to 9 %: 0.8 and 1.25 are 2
  // to 3 of these errors.
  const Scatter scatter = ScatterOf(1, 0.423, "viscous", 60);
  EXPECT_THAT(scatter.far, Le(1));
  EXPECT_THAT(std::abs(std::log(scatter.std_dev)), Lt(std::log(1.25)));
}

TEST(FitUndersampled, FindsSwingsOfAnyAmplitudeAndWithDryFriction) {
  EXPECT_EQ(ScatterOf(1, 0.1, "viscous", 12).far, 0);
  EXPECT_EQ(ScatterOf(1, 1.2, "viscous", 6).far, 0);
  EXPECT_EQ(ScatterOf(1, 0.423, "coulomb", 12).far, 0);
}

TEST(FitUndersampled, FindsASwingSampledAtFiveThirdsOfItsFrequency) {
  EXPECT_EQ(ScatterOf(kFrequency * 5 / 3, 0.423, "viscous", 12).far, 0);
}

// A start value says where a fit begins, not which alias is right: the rig does.
TEST(FitUndersampled, KeepsTheRangeOfTheRigWithAStartValue) {
  const SwingFit expected = FitSimulated(Swing(1, 0.423, 1), TextbookRig(), "viscous");
  for (const double inertia : {0.078, 0.2}) {
    FitOptions options = ModelOptions("viscous");
    options.initial = {{"inertia", inertia}};
    const SwingFit result = FitAsTheToolDoes(Must(SimulateRecording(Swing(1, 0.423, 1))), TextbookRig(), options);
    EXPECT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
    EXPECT_EQ(InertiaOf(result), InertiaOf(expected)) << inertia;
  }
}

TEST(FitUndersampled, ExcludesTheHold) {
  SyntheticOptions run = Swing(1, 0.423, 1);
  run.start = StartKind::kRelease;
  run.release_angle = 0.423;
  run.release_time = 1.9;
  const SwingFit result = FitSimulated(run, TextbookRig(), "viscous");
  EXPECT_THAT(result.used.time[0], AllOf(Ge(2), Le(3)));  // at 2 s the angle has changed by less than a tenth
  EXPECT_EQ(result.fit.start, StartKind::kMoving);
  EXPECT_THAT(Sentence(result.swing.begins), HasSubstr("without the constant readings"));
  EXPECT_NEAR(InertiaOf(result), kInertiaTruth, 4 * *result.fit.Find("inertia")->std_error);
}

TEST(FitUndersampled, FitsAGyro) {
  SyntheticOptions run = Swing(1, 0.423, 2);
  run.quantity = Quantity::kRate;
  const SwingFit result = FitSimulated(run, TextbookRig(), "viscous");
  ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_NEAR(InertiaOf(result), kInertiaTruth, 4 * *result.fit.Find("inertia")->std_error);
}

TEST(FitUndersampled, UsesTheStampsOfUnevenSamples) {
  // Once per cycle on average: even samples carry no information, uneven ones do.
  SyntheticOptions run = Swing(kFrequency, 0.423, 3);
  run.jitter = 0.2;
  const SwingFit result = FitSimulated(run, TextbookRig(), "viscous");
  ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_NEAR(InertiaOf(result), kInertiaTruth, 4 * *result.fit.Find("inertia")->std_error);
}

TEST(FitUndersampled, ExplainsTheApparentPeriod) {
  const SwingFit result = FitSimulated(Swing(1, 0.423, 1), TextbookRig(), "viscous");
  EXPECT_THAT(result.fit.warnings, HasWarning("aliased"));
  EXPECT_THAT(result.fit.warnings, Not(HasWarning("ambiguous_frequency")));
  EXPECT_THAT(Sentence(result.swing.begins), HasSubstr("sampled too slowly to see half swings: the whole recording"));
  EXPECT_NEAR(result.swing.half_period, 0.5 / kFrequency, 1e-3);
  EXPECT_FALSE(result.fit.Find("inertia")->closed_form);
}

TEST(FitUndersampled, IsNotIdentifiableAtOneOrTwoSamplesPerCycle) {
  for (const double samples : {1.0, 2.0}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const SwingFit result = FitSimulated(Swing(samples * kFrequency, 0.423, seed), TextbookRig(), "viscous");
      EXPECT_EQ(result.fit.termination, Termination::kNotIdentifiable) << result.fit.reason;
      EXPECT_FALSE(result.fit.Find("inertia")->std_error);
      EXPECT_EQ(result.fit.covariance.size(), 0);
      EXPECT_THAT(result.fit.warnings, HasWarning("ambiguous_frequency"));
      EXPECT_THAT(result.fit.warnings, HasWarning("samples_near_period"));
    }
  }
}

// Once a period, which is a rate that the swing itself determines.
TEST(FitUndersampled, IsNotTriedWithATableOfMaxima) {
  Recording maxima;
  maxima.time = Eigen::VectorXd::LinSpaced(40, 0, 39 * 1.43);
  maxima.value = 0.5 * (-0.05 * maxima.time.array()).exp();
  const auto chosen = ChooseSwings(maxima, {}, std::nullopt);
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().message(), testing::HasSubstr("the maxima of a swing, one of each period"));
}

TEST(FitUndersampled, RejectsReadingsWithNoiseOnly) {
  Recording noise = Must(SimulateRecording(Swing(1, 0.423, 1)));
  std::mt19937_64 generator(5);
  for (double& value : noise.value) value = static_cast<double>(generator() >> 11) * 0x1p-53;
  const SwingFit result = FitAsTheToolDoes(noise, TextbookRig());
  EXPECT_EQ(result.fit.termination, Termination::kNotConverged);
  EXPECT_THAT(result.fit.reason, HasSubstr("cannot distinguish noise from another motion"));
}

TEST(FitUndersampled, RefusesARelease) {
  const Recording recording = Must(SimulateRecording(Swing(1, 0.423, 1)));
  FitOptions options;
  options.start = StartKind::kRelease;
  const auto refused = FitUndersampled(recording, WholeRecording(recording), options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(refused.error().message(), HasSubstr("--start moving"));
}

TEST(FitUndersampled, RefusesAConstantReading) {
  Recording recording = Must(SimulateRecording(Swing(1, 0.423, 1)));
  recording.value.setConstant(0.1);
  const auto refused = FitUndersampled(recording, WholeRecording(recording), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(refused.error().message(), HasSubstr("constant"));
}

// ---- Without the rig's geometry ------------------------------------------------------------------------------------

TEST(FitUndersampled, GivesNoConfidentAnswerWithoutARig) {
  for (const double rate : {0.6, 1.0, 1.267, 2.0, 3.5}) {
    const SwingFit result = FitSimulated(Swing(rate, 0.423, 1), std::nullopt, "viscous");
    EXPECT_EQ(result.fit.termination, Termination::kNotIdentifiable) << rate << " Hz";
    EXPECT_FALSE(result.fit.Find("inertia")->std_error);
  }
}

TEST(FitUndersampled, FitsASlowPendulumWithoutAPlausibleAlias) {
  const SwingFit result = FitSimulated(Swing(4, 0.423, 1, kSlowInertia), std::nullopt, "viscous");
  ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_NEAR(InertiaOf(result), kSlowInertia / kTextbookTorque, 4 * *result.fit.Find("inertia")->std_error);
  EXPECT_FALSE(result.swing.undersampled);
}

// Milliseconds and microseconds interpreted as seconds, and seconds interpreted as milliseconds.
TEST(FitSwing, AsksAboutAnImplausiblePeriod) {
  for (const double factor : {1e3, 1e6, 1e-3}) {
    Recording recording = Must(SimulateRecording(Swing(50, 0.423, 1)));
    recording.time *= factor;
    const ChosenSwings swings = Must(ChooseSwings(recording, {}, {}));
    const Result<SwingFit> result = FitSwing(recording, swings.found.front(), ModelOptions("viscous"));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, StatusCode::kFailedPrecondition);
    EXPECT_THAT(result.error().message(), HasSubstr("the periods of pendulums are 0.1 s to 20 s"));
    EXPECT_THAT(result.error().message(), HasSubstr(factor > 1 ? "--time_column NAME:ms" : "--time_column NAME:s"));
    EXPECT_THAT(result.error().message(), HasSubstr("--gravity linear"));
  }
}

TEST(FitSwing, AcceptsAnyPeriodIfTheInertiaIsKnown) {
  Recording recording = Must(SimulateRecording(Swing(50, 0.1, 1)));
  recording.time *= 1e3;
  const double inertia = 1e6 * kInertiaTruth / kTextbookTorque;
  FitOptions options = ModelOptions("viscous");
  options.bounds["inertia"] = {0.5 * inertia, 2 * inertia};
  const SwingFit result = FitAsTheToolDoes(recording, std::nullopt, options);
  ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_NEAR(InertiaOf(result), inertia, 4 * *result.fit.Find("inertia")->std_error);
}

// A frequency of 0.2 Hz sampled at 3 Hz: a swing of 2.8 Hz has the same samples if it is small.
TEST(FitSwing, AssumesTheFrequencyThatFifteenSamplesAPeriodShow) {
  SyntheticOptions run = Swing(3, 0.1, 1, kTextbookTorque / std::pow(2 * kPi * 0.2, 2));
  run.duration = 100;
  const SwingFit result = FitSimulated(run, std::nullopt, "viscous");
  ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_NEAR(InertiaOf(result), run.parameters[0], 4 * *result.fit.Find("inertia")->std_error);
  EXPECT_THAT(result.fit.warnings, HasWarning("ambiguous_frequency"));
}

// 0.76 Hz sampled at 0.7 Hz seems to be 0.06 Hz, but its period depends on the amplitude twelve times as much.
TEST(FitSwing, SeesThatASmoothCurveIsAFasterSwing) {
  SyntheticOptions run = Swing(0.7, 0.6, 1);
  run.duration = 150;
  const SwingFit result = FitSimulated(run, std::nullopt, "viscous");
  EXPECT_NE(result.fit.termination, Termination::kConverged);
  EXPECT_FALSE(result.fit.Find("inertia")->std_error);
}

TEST(FitUndersampled, NamesFirstTheFrequencyThatTheSamplesShow) {
  const SwingFit result = FitSimulated(Swing(3.5, 0.05, 1), std::nullopt, "viscous");
  ASSERT_EQ(result.fit.termination, Termination::kNotIdentifiable);
  const std::size_t first = result.fit.reason.find("(0.76");
  EXPECT_THAT(result.fit.reason.find(" Hz)"), AllOf(Ge(first), Le(first + 10))) << result.fit.reason;
}

// ---- Sensors of unknown scale --------------------------------------------------------------------------------------

TEST(FitUndersampled, FindsTheScaleOfAnySensor) {
  for (const SyntheticOptions& measured :
       {MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.001),
        MeasuredSwing(Quantity::kPosition, SensorKind::kCoordinate, {0.01, 0.3, 0.4}, 0.0005),
        MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, 0.02, 0.3}, 0.02)}) {
    // The window may begin after the first sample, so the state at its beginning is not compared.
    for (const double per_period : {5.5, 6.5}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(measured.quantity)) + ", " + std::to_string(per_period));
      SyntheticOptions run = measured;
      run.sample_rate = per_period * std::sqrt(22.0) / (2 * kPi);
      run.duration = 40;
      const SwingFit result = FitSimulated(run, std::nullopt, "coulomb");
      EXPECT_TRUE(result.swing.undersampled);
      ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
      for (std::size_t i = 0; i < run.parameters.size(); ++i) {
        const ParameterEstimate& parameter = result.fit.parameters[i];
        ASSERT_TRUE(parameter.std_error) << parameter.info.name;
        EXPECT_LE(std::abs(parameter.estimate - run.parameters[i]), 4.5 * *parameter.std_error) << parameter.info.name;
      }
    }
  }
}

TEST(FitUndersampled, AsksForTheOtherAxisOfAnAccelerationAlongTheRod) {
  SyntheticOptions run =
      MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, kPi / 2, 0.3}, 0.02);
  run.sample_rate = 4;
  const Recording recording = Must(SimulateRecording(run));
  const auto refused = FitUndersampled(recording, WholeRecording(recording), ModelOptions("coulomb"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("choose the axis across the rod with --value_column"));
}

TEST(FitUndersampled, RefusesAFrequencyFarFromThePredictionOfTheRig) {
  const SwingFit result = FitSimulated(Swing(1.3, 0.423, 1, 0.13), TextbookRig(), "viscous");
  EXPECT_EQ(result.fit.termination, Termination::kNotIdentifiable) << result.fit.reason;
  EXPECT_THAT(result.fit.reason, HasSubstr("check the rig"));
}

TEST(FitUndersampled, AcceptsBoundsInsteadOfARig) {
  FitOptions options = ModelOptions("viscous");
  options.bounds["inertia"] = {0.8 * kInertiaTruth / kTextbookTorque, 1.2 * kInertiaTruth / kTextbookTorque};
  const SwingFit result = FitAsTheToolDoes(Must(SimulateRecording(Swing(1, 0.423, 1))), std::nullopt, options);
  ASSERT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_NEAR(InertiaOf(result), kInertiaTruth / kTextbookTorque, 4 * *result.fit.Find("inertia")->std_error);
}

// ---- IsUndersampled ------------------------------------------------------------------------------------------------

TEST(IsUndersampled, IsTrueBelowSevenSamplesPerPeriodWithAMarginOfFifteenPercent) {
  const double limit = 7 * 1.15 * std::sqrt(kTextbookTorque / kGeometric) / (2 * kPi);
  const auto at = [](double rate) { return Must(SimulateRecording(Swing(rate, 0.423, 1))); };
  EXPECT_TRUE(IsUndersampled(at(0.99 * limit), TextbookRig()));
  EXPECT_FALSE(IsUndersampled(at(1.01 * limit), TextbookRig()));
}

TEST(IsUndersampled, IsTrueIfAFasterPendulumWouldLookTheSame) {
  Rig torque_alone = TextbookRig();
  torque_alone.inertia.reset();
  const auto at = [](double rate) { return Must(SimulateRecording(Swing(rate, 0.423, 1))); };
  for (const std::optional<Rig>& rig : {std::optional<Rig>(), std::optional<Rig>(torque_alone)}) {
    EXPECT_TRUE(IsUndersampled(at(3.7), rig));   // 2.94 Hz would look the same
    EXPECT_TRUE(IsUndersampled(at(5.1), rig));   // 6.7 samples per period
    EXPECT_FALSE(IsUndersampled(at(5.9), rig));  // 7.8 samples per period, and no pendulum swings at 5.1 Hz
  }
}

TEST(ChooseSwings, UsesAnUndersampledRecordingAsAWhole) {
  const Recording recording = Must(SimulateRecording(Swing(1, 0.423, 1)));
  const ChosenSwings swings = Must(ChooseSwings(recording, {}, TextbookRig()));
  ASSERT_EQ(swings.found.size(), 1U);
  EXPECT_TRUE(swings.found[0].undersampled);
  EXPECT_EQ(swings.found[0].from, 0);
  EXPECT_EQ(swings.found[0].to, 29);
  const auto second = ChooseSwings(recording, {.release = 2}, TextbookRig());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message(), HasSubstr("there is no free swing 2"));
  EXPECT_EQ(Must(ChooseSwings(recording, {.from = 5, .to = 25}, TextbookRig())).found[0].from, 5);
}

}  // namespace
}  // namespace pendulum::undersampled_test
