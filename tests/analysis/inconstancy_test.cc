// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/inconstancy.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit_jointly.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::inconstancy_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Ge;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;

const Constancy kUntested;

SyntheticOptions NoisyTextbookRun(std::string_view model) {
  SyntheticOptions run = TextbookRun(model);
  run.noise = 0.002;
  return run;
}

FitOptions WithLinearGravity(const std::optional<Rig>& rig) {
  FitOptions options = ModelOptions("viscous");
  options.gravity = Gravity::kLinear;
  options.rig = rig;
  return options;
}

/// The fit with the inconstancy error added.
FitOfRun FitWithInconstancy(const SyntheticOptions& simulated, const FitOptions& options) {
  FitOfRun run = FitTo(Must(SimulateRecording(simulated)), options);
  const Constancy constancy = TestConstancy(run.recording, run.fit, options);
  AddInconstancyError({Alone(run.fit, constancy)}, {}, run.fit);
  return run;
}

double SystematicError(const FitReport& fit, std::string_view name) {
  return fit.Find(name)->systematic.Total().value_or(0);
}

TEST(Inconstancy, IsZeroForTheRightLaw) {
  const FitOfRun run = FitWithInconstancy(NoisyTextbookRun("coulomb"), ModelOptions("coulomb"));
  EXPECT_FALSE(run.fit.HasWarning("not_constant"));
  EXPECT_THAT(run.fit.systematic_names, IsEmpty());
  EXPECT_FALSE(run.fit.Find("inertia")->systematic.Total());
}

// Linear gravity gives each window the inertia I_O (1 + A²/8) of its amplitude A.
TEST(Inconstancy, IsTheScatterOfWindowsAboutTheWholeFit) {
  const FitOptions options = WithLinearGravity({});
  FitOfRun run = FitTo(Must(SimulateRecording(NoisyTextbookRun("viscous"))), options);
  const ParameterEstimate whole = *run.fit.Find("inertia");
  const Constancy constancy = TestConstancy(run.recording, run.fit, options);
  double sum_of_squares = 0;
  for (const AmplitudeRow& row : constancy.windows) {
    const double inertia = 0.079 / kTextbookTorque * (1 + row.amplitude * row.amplitude / 8);
    sum_of_squares += std::pow(inertia - whole.estimate, 2);
  }
  const double expected = std::sqrt(sum_of_squares / static_cast<double>(constancy.windows.size() - 1));
  AddInconstancyError({Alone(run.fit, constancy)}, {}, run.fit);
  EXPECT_THAT(SystematicError(run.fit, "inertia"), AllOf(Gt(0.9 * expected), Lt(1.1 * expected)));
  EXPECT_THAT(expected, Gt(5 * *whole.std_error));  // so that the scatter is significant
  EXPECT_EQ(run.fit.Find("inertia")->std_error, whole.std_error);
}

// The added error must explain the difference to a run with another amplitude. With the same wrong law, the inertia of
// the two runs differs by many standard errors, but the difference must be within the combined total errors.
TEST(Inconstancy, ExplainsDifferencesBetweenAmplitudes) {
  const FitOptions options = WithLinearGravity({});
  const ParameterEstimate first = *FitWithInconstancy(NoisyTextbookRun("viscous"), options).fit.Find("inertia");
  for (const double amplitude : {0.6, 0.8, 1.2}) {
    SyntheticOptions run = NoisyTextbookRun("viscous");
    run.release_angle *= amplitude;
    const ParameterEstimate second = *FitWithInconstancy(run, options).fit.Find("inertia");
    const double difference = std::abs(second.estimate - first.estimate);
    const double std_error = std::hypot(*first.std_error, *second.std_error);
    EXPECT_THAT(difference, Gt(4 * std_error)) << amplitude;
    EXPECT_THAT(difference, Lt(3 * std::hypot(std_error, *first.systematic.Total(), *second.systematic.Total())))
        << amplitude;
  }
}

TEST(Inconstancy, IsReportedWithItsSize) {
  const FitOfRun run = FitWithInconstancy(NoisyTextbookRun("viscous"), WithLinearGravity({}));
  ASSERT_TRUE(run.fit.HasWarning("not_constant"));
  EXPECT_THAT(MessageText(run.fit.warnings.back()), HasSubstr("by more than their errors: inertia by 0.000"));
}

// The rig's error is a factor common to all torques; the inconstancy belongs to inertia alone.
TEST(Inconstancy, AddsInQuadratureToTheRigsError) {
  FitReport fit = FitTo(NoisyTextbookRun("viscous"), "viscous", TextbookRig()).fit;
  const double of_rig = *fit.Find("inertia")->systematic.Total();
  const Eigen::MatrixXd before = fit.systematic_covariance;
  const auto names = fit.systematic_names;
  Constancy constancy;
  constancy.windows = {{0, 5, 0.4, 0.078, 1e-5, 0.003, 1e-5},
                       {5, 10, 0.3, 0.079, 1e-5, 0.003, 1e-5},
                       {10, 15, 0.2, 0.080, 1e-5, 0.003, 1e-5}};
  constancy.trends = {{"inertia", "kg m^2", -0.002 / 0.12, 1e-4, 0.025, 1e-9}, {"viscous", "N m s", 0, 0.1, 0, 1}};
  const double whole = fit.Find("inertia")->estimate;
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  // Three values with the same error of 1e-5.
  const double expected =
      (std::pow(0.078 - whole, 2) + std::pow(0.079 - whole, 2) + std::pow(0.080 - whole, 2)) / 2 - 1e-10;
  EXPECT_NEAR(*fit.Find("inertia")->systematic.Total(), std::sqrt(of_rig * of_rig + expected), 1e-9);
  EXPECT_EQ(fit.systematic_names, names);
  EXPECT_NEAR(fit.systematic_covariance(0, 0) - before(0, 0), expected, 1e-12);
  EXPECT_EQ(fit.systematic_covariance(0, 1), before(0, 1));
}

// Two recordings with standard errors of 1 and 2 have the weights 4 : 1. With a change of s in the first and none in
// the second the mean square is 4/5 s².
TEST(Inconstancy, OfRecordingsIsTheirWeightedRootMeanSquare) {
  FitReport first = FitTo(NoisyTextbookRun("viscous"), "viscous", {}).fit;
  ParameterEstimate& inertia = *std::ranges::find(
      first.parameters, "inertia", [](const ParameterEstimate& parameter) { return parameter.info.name; });
  inertia.std_error = 1e-5;
  FitReport second = first;
  second.parameters[0].std_error = 2e-5;
  JointFit joint;
  joint.whole = first;
  joint.runs = {first, second};
  Constancy changing;
  changing.halves = {{"inertia", "s^2", inertia.estimate - 0.03, inertia.estimate + 0.03, 1e-6, 1e-6, 1414}};
  const double change = std::hypot(0.03, 0.03);  // sum of squares over 2 - 1
  Constancy constant;
  constant.halves = {{"inertia", "s^2", inertia.estimate, inertia.estimate, 1e-6, 1e-6, 0}};
  AddInconstancyError({Alone(first, changing), Alone(second, constant)}, {}, joint.whole, joint.runs);
  EXPECT_NEAR(SystematicError(joint.whole, "inertia"), change * std::sqrt(4.0 / 5), 1e-8);
  EXPECT_NEAR(SystematicError(joint.runs[1], "inertia"), change * std::sqrt(4.0 / 5), 1e-8);
  EXPECT_TRUE(joint.whole.HasWarning("not_constant"));
}

SharedParameter Between(double p, double between) {
  SharedParameter shared;
  shared.name = "inertia";
  shared.p = p;
  shared.scatter.between = between;
  return shared;
}

// Short recordings show no change within them, but they can differ. Differences that chance explains are no change.
TEST(Inconstancy, OfShortRecordingsIsTheirScatter) {
  const FitReport alone = FitTo(NoisyTextbookRun("viscous"), "viscous", {}).fit;
  Constancy untested;
  for (const auto& [p, expected] : {std::pair(1e-6, 0.002), std::pair(0.3, 0.0)}) {
    JointFit joint;
    joint.whole = alone;
    joint.runs = {alone, alone};
    AddInconstancyError({Alone(alone, untested), Alone(alone, untested)}, {Between(p, 0.002)}, joint.whole, joint.runs);
    EXPECT_EQ(SystematicError(joint.whole, "inertia"), expected);
    EXPECT_EQ(SystematicError(joint.runs[0], "inertia"), expected);
    EXPECT_EQ(joint.whole.HasWarning("not_constant"), expected > 0);
  }
}

// A window that shows a friction of -0.01 shows that there is little, not that it may be as much as 0.01 larger.
TEST(Inconstancy, DoesNotCountFrictionBelowZero) {
  FitReport fit = FitTo(NoisyTextbookRun("coulomb"), "coulomb", {}).fit;
  const double friction = fit.Find("coulomb")->estimate;
  Constancy constancy;
  constancy.windows = {{0, 5, 0.4, 0.0438, 1e-5, friction, 1e-6},
                       {5, 10, 0.3, 0.0438, 1e-5, friction, 1e-6},
                       {10, 15, 0.2, 0.0438, 1e-5, -0.01, 1e-6}};
  constancy.trends = {{"inertia", "s^2", 0, 0.1, 0, 1}, {"coulomb", "1", 0, 0.1, 0, 1, 1e-9}};
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  EXPECT_NEAR(SystematicError(fit, "coulomb"), friction / std::sqrt(2.0), 1e-3 * friction);
}

TEST(Inconstancy, UsesTheHalvesIfThereAreNoWindows) {
  FitReport fit = FitTo(NoisyTextbookRun("viscous"), "viscous", {}).fit;
  Constancy constancy;
  // Friction differs by two standard errors, which may be chance.
  constancy.halves = {{"inertia", "s^2", 0.044, 0.046, 1e-6, 1e-6, 1414}, {"viscous", "s", 0.001, 0.03, 0.01, 0.01, 2}};
  const double whole = fit.Find("inertia")->estimate;
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  EXPECT_NEAR(SystematicError(fit, "inertia"), std::hypot(0.044 - whole, 0.046 - whole), 1e-8);
  EXPECT_THAT(fit.systematic_names, ElementsAre("inertia"));
  EXPECT_THAT(MessageText(fit.warnings.back()), HasSubstr("s^2 between halves; another run"));
}

// A zero that moves in the middle of a recording makes the halves differ and gives the windows no trend. A recording
// with halves that differ by 158 ppm (p 1e-18) had a total error of 5 ppm.
TEST(Inconstancy, CountsHalvesThatDifferWhereWindowsDoNot) {
  FitReport fit = FitTo(NoisyTextbookRun("viscous"), "viscous", {}).fit;
  const double whole = fit.Find("inertia")->estimate;
  Constancy constancy;
  for (const double from : {0.0, 5.0, 10.0, 15.0})
    constancy.windows.push_back({from, from + 5, 0.4 - 0.02 * from, whole, 1e-4 * whole, 0.003, 1e-4});
  constancy.trends = {{"inertia", "s^2", 0, 1, 0, 1}, {"viscous", "s", 0, 1, 0, 1}};
  const double first = whole * (1 - 79e-6), second = whole * (1 + 79e-6);
  constancy.halves = {{"inertia", "s^2", first, second, 1e-6 * whole, 1e-6 * whole, 112}};
  constancy.halves_p = 1e-18;
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  const double expected = std::hypot(79e-6 * whole, 79e-6 * whole);  // sum of squares over 2 - 1, less 1e-6 each
  EXPECT_NEAR(SystematicError(fit, "inertia"), expected, 1e-3 * expected);
  EXPECT_TRUE(fit.HasWarning("not_constant"));
}

// Estimates of viscous and dry friction compensate for each other: each alone differs by less than its error, both
// together by much more.
TEST(Inconstancy, CountsHalvesThatDifferOnlyTogether) {
  FitReport fit = FitTo(NoisyTextbookRun("coulomb"), "coulomb", {}).fit;
  Constancy constancy;
  constancy.halves = {{"viscous", "s", 0.0010, 0.0014, 0.0002, 0.0002, 1.4},
                      {"coulomb", "1", 0.0020, 0.0024, 0.0003, 0.0003, 0.9}};
  constancy.halves_p = 1e-9;
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  EXPECT_THAT(SystematicError(fit, "viscous"), Ge(0.0002 * (1 - 1e-9)));  // half the difference
  EXPECT_TRUE(fit.HasWarning("not_constant"));
}

// The covariance of the windows may show a trend that is smaller than the error of each window: their common error
// cancels. The line rises by 2e-5 over the windows; its standard deviation is that of a uniform distribution.
TEST(Inconstancy, IsAtLeastTheTrend) {
  FitReport fit = FitTo(NoisyTextbookRun("viscous"), "viscous", {}).fit;
  const double whole = fit.Find("inertia")->estimate;
  Constancy constancy;
  constancy.windows = {{0, 5, 0.4, whole - 1e-5, 1e-4, 0.003, 1e-4},
                       {5, 10, 0.3, whole, 1e-4, 0.003, 1e-4},
                       {10, 15, 0.2, whole + 1e-5, 1e-4, 0.003, 1e-4}};
  const double range = 0.4 * 0.4 - 0.2 * 0.2;
  constancy.trends = {{"inertia", "s^2", -2e-5 / range, 1e-7, -2e-5 / whole, 1e-12}, {"viscous", "s", 0, 1, 0, 1}};
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  EXPECT_NEAR(SystematicError(fit, "inertia"), 2e-5 / std::sqrt(12.0), 1e-9);
  EXPECT_TRUE(fit.HasWarning("not_constant"));
}

// Estimates that alternate between windows have no trend. A parameter that the windows hold fixed may differ between
// the halves.
TEST(Inconstancy, NeedsNoTrend) {
  FitReport fit = FitTo(NoisyTextbookRun("coulomb"), "coulomb", {}).fit;
  Constancy constancy;
  constancy.windows = {{0, 5, 0.4, 0.0438, 1e-5, 0.00222, 1e-7},
                       {5, 10, 0.3, 0.0438, 1e-5, 0.00232, 1e-7},
                       {10, 15, 0.2, 0.0438, 1e-5, 0.00222, 1e-7}};
  constancy.trends = {{"inertia", "s^2", 0, 0.1, 0, 1}, {"coulomb", "1", 0, 0.1, 0, 1, 1e-9}};
  constancy.halves = {{"inertia", "s^2", 0.0438, 0.0438, 1e-5, 1e-5, 0},
                      {"viscous", "s", 0.001, 0.003, 0.0001, 0.0001, 14},
                      {"coulomb", "1", 0.00225, 0.00225, 1e-5, 1e-5, 0}};
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  EXPECT_FALSE(constancy.constant());
  EXPECT_THAT(fit.systematic_names, ElementsAre("viscous", "coulomb"));
  // The error of coulomb is the scatter of the windows (the middle one differs by 1e-4); the error of viscous is the
  // scatter of the halves.
  EXPECT_THAT(SystematicError(fit, "coulomb"), AllOf(Gt(5e-5), Lt(2e-4)));
  EXPECT_THAT(SystematicError(fit, "viscous"), AllOf(Gt(0.001), Lt(0.003)));
}

// ---- Friction of another law ----------------------------------------------------------------------------------------

/// A converged fit of the inertia alone, with 3e-5 by friction that was named and 4e-5 by friction that is suggested.
FitReport FitWithOtherFriction() {
  FitReport fit;
  fit.termination = Termination::kConverged;
  ParameterEstimate inertia;
  inertia.info = kInertia;
  inertia.unit = "s^2";
  inertia.estimate = 0.05;
  inertia.std_error = 1e-5;
  inertia.named_friction = 3e-5;
  inertia.hidden_friction = 4e-5;
  fit.parameters.push_back(inertia);
  return fit;
}

TEST(FrictionLawError, ContainsWhatIsOnlySuggestedInAShortRecording) {
  for (const auto& [half_swings, expected] : {std::pair(18, 3e-5), std::pair(17, 4e-5)}) {
    FitReport fit = FitWithOtherFriction();
    Constancy constancy;
    constancy.half_swings = half_swings;
    AddFrictionLawError({Alone(fit, constancy)}, fit);
    EXPECT_DOUBLE_EQ(fit.parameters[0].systematic.Of(ErrorSource::kFrictionLaw), expected);
    EXPECT_DOUBLE_EQ(fit.systematic_covariance(0, 0), expected * expected);
  }
}

// A law that lacks friction makes the windows differ: this is one error, not two.
TEST(FrictionLawError, IsWhatExceedsTheChangeDuringTheRecording) {
  for (const auto& [change, expected] : {std::pair(0.0, 3e-5), std::pair(1.8e-5, 2.4e-5), std::pair(6e-5, 0.0)}) {
    FitReport fit = FitWithOtherFriction();
    fit.parameters[0].systematic.Add(ErrorSource::kInconstancy, change);
    AddFrictionLawError({Alone(fit, kUntested)}, fit);
    EXPECT_NEAR(fit.parameters[0].systematic.Of(ErrorSource::kFrictionLaw), expected, 1e-12);
  }
}

TEST(FrictionLawError, NeedsAStandardError) {
  FitReport fit = FitWithOtherFriction();
  fit.parameters[0].std_error.reset();
  AddFrictionLawError({Alone(fit, kUntested)}, fit);
  EXPECT_FALSE(fit.parameters[0].systematic.Total());
}

// Two recordings with standard errors of 1 and 2 have the weights 4 : 1.
TEST(FrictionLawError, OfRecordingsIsTheirWeightedRootMeanSquare) {
  const FitReport first = FitWithOtherFriction();
  FitReport second = first;
  second.parameters[0].std_error = 2e-5;
  second.parameters[0].named_friction = 0;
  JointFit joint;
  joint.whole = first;
  joint.runs = {first, second};
  const Constancy constant;
  AddFrictionLawError({Alone(first, constant), Alone(second, constant)}, joint.whole, joint.runs);
  const double expected = 3e-5 * std::sqrt(4.0 / 5);
  EXPECT_NEAR(joint.whole.parameters[0].systematic.Of(ErrorSource::kFrictionLaw), expected, 1e-12);
  EXPECT_NEAR(joint.runs[1].parameters[0].systematic.Of(ErrorSource::kFrictionLaw), expected, 1e-12);
}

}  // namespace
}  // namespace pendulum::inconstancy_test
