// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/fit_models.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "tests/analysis/whole_swing.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::fit_models_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

FittedRecording FitAll(const Recording& recording, const std::vector<std::string>& models,
                       const FitOptions& options = {}) {
  return Must(FitModels(recording, Whole(recording), options, models));
}

TEST(FitModels, KeepsTheRequestedOrder) {
  const FittedRecording fitted = FitAll(Must(SimulateRecording(NoisyRun())), {"drag", "viscous", "coulomb"});
  ASSERT_THAT(fitted.fits, SizeIs(3));
  EXPECT_EQ(fitted.fits[0].model.name, "drag");
  EXPECT_EQ(fitted.fits[1].model.name, "viscous");
  EXPECT_EQ(fitted.fits[2].model.name, "coulomb");
}

TEST(FitModels, GivesTheResultOfFitRecordingForOneModel) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitReport alone = Fit(recording, ModelOptions("coulomb"));
  const FittedRecording fitted = FitAll(recording, {"coulomb"});
  ASSERT_THAT(fitted.fits, SizeIs(1));
  EXPECT_EQ(fitted.fits[0].Find("inertia")->estimate, alone.Find("inertia")->estimate);
}

// Viscous friction alone leaves residuals of more than a count; coulomb leaves a quarter of a count. Both fits must use
// one family.
TEST(FitModels, UsesTheNoiseFamilyOfTheSmallestResidualsForAllModels) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.duration = 60;
  run.noise = 0.25 * kCount;
  run.resolution = kCount;
  const Recording recording = Must(SimulateRecording(run));
  EXPECT_EQ(Fit(recording, ModelOptions("viscous")).noise.family, NoiseFamily::kGaussian);
  const FittedRecording fitted = FitAll(recording, {"viscous", "coulomb"});
  for (const FitReport& fit : fitted.fits) EXPECT_EQ(fit.noise.family, NoiseFamily::kQuantized) << fit.model.name;
}

TEST(FitModels, UsesTheSameStartForAllModels) {
  const FittedRecording fitted = FitAll(Must(SimulateRecording(NoisyRun())), {"viscous", "coulomb", "drag"});
  for (const FitReport& fit : fitted.fits) {
    EXPECT_EQ(fit.start, StartKind::kRelease) << fit.model.name;
    EXPECT_EQ(fit.residual.size(), fitted.used.size()) << fit.model.name;
  }
}

TEST(FitModels, CorrectsTheReadingsOfALawAloneButNotOfSeveral) {
  SyntheticOptions run = NoisyRun();
  run.duration = 30;
  Recording recording = Must(SimulateRecording(run));
  recording.value *= 1.02;
  recording.sensor_errors.Of(SensorEffect::kGain) = {0.01, "assumed"};
  EXPECT_EQ(FitAll(recording, {"coulomb"}).fits[0].correction.size(), recording.size());
  for (const FitReport& fit : FitAll(recording, {"coulomb", "drag"}).fits) EXPECT_EQ(fit.correction.size(), 0);
}

// Sampled once per second at 0.76 Hz: every model must search the aliased frequency itself.
TEST(FitModels, FindsOneFrequencyForAnUndersampledSwing) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.sample_rate = 1;
  run.duration = 60;
  run.noise = 0.2 * kRadFromDeg;
  run.resolution = kCount;
  const Recording recording = Must(SimulateRecording(run));
  FitOptions options;
  options.rig = Rig{};
  options.rig->gravity_torque = {kTextbookTorque, 0};
  options.rig->inertia = RigValue{0.0761, 0};  // kg m^2, from the geometry: 4 % off
  const ChosenSwings swings = Must(ChooseSwings(recording, {}, options.rig));
  const FreeSwing& swing = swings.found.at(static_cast<std::size_t>(swings.chosen.at(0) - 1));
  ASSERT_TRUE(swing.undersampled);
  const FittedRecording fitted = Must(FitModels(recording, swing, options, {"viscous", "coulomb", "drag"}));
  ASSERT_THAT(fitted.fits, SizeIs(3));
  const double truth = run.parameters[0] * kTextbookTorque;
  for (const FitReport& fit : fitted.fits) {
    ASSERT_EQ(fit.termination, Termination::kConverged) << fit.model.name << ": " << fit.reason;
    EXPECT_NEAR(fit.Find("inertia")->estimate / truth, 1, 0.01) << fit.model.name;
    EXPECT_EQ(fit.noise.family, fitted.fits[0].noise.family) << fit.model.name;
  }
  const ParameterEstimate& inertia = *fitted.fits[1].Find("inertia");
  EXPECT_NEAR(inertia.estimate, truth, 4 * inertia.std_error.value_or(0));
}

TEST(FitModels, IgnoresAndReportsParametersOfOtherModels) {
  FitOptions options;
  options.fixed = {{"coulomb", 0.002}};
  const FittedRecording fitted = FitAll(Must(SimulateRecording(NoisyRun())), {"viscous", "coulomb"}, options);
  const auto warns = [](const FitReport& fit) { return fit.HasWarning("ignored_parameter"); };
  EXPECT_TRUE(warns(fitted.fits[0]));
  EXPECT_FALSE(warns(fitted.fits[1]));
  EXPECT_TRUE(fitted.fits[1].Find("coulomb")->fixed);
}

TEST(FitModels, RefusesAnUnknownParameter) {
  FitOptions options;
  options.fixed = {{"lubrication", 1}};
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const auto fitted = FitModels(recording, Whole(recording), options, {"viscous", "coulomb"});
  ASSERT_FALSE(fitted);
  EXPECT_EQ(fitted.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(fitted.error().message(), HasSubstr("lubrication"));
}

TEST(ForModel, KeepsOptionsTheModelHas) {
  FitOptions options;
  options.fixed = {{"drag", 0}, {"viscous", 0.1}};
  options.priors = {{"coulomb", {1, 2}}};
  const OptionsForModel viscous = ForModel(options, "viscous", {"viscous", "drag"});
  EXPECT_EQ(viscous.options.model, "viscous");
  EXPECT_THAT(viscous.ignored, ElementsAre("coulomb", "drag"));
  EXPECT_EQ(viscous.options.fixed.size(), 1);
  EXPECT_THAT(viscous.options.priors, IsEmpty());
  EXPECT_THAT(ForModel(options, "drag", {"viscous", "drag"}).ignored, IsEmpty());
}

}  // namespace
}  // namespace pendulum::fit_models_test
