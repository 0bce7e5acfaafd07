// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_runs.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::fit_runs_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Options for a recording of the textbook's rig, held until 1.9 s, with the true values I_O = 0.079 kg m² and G =
/// 1.8033 N m.
FitPendulumOptions TextbookOptions() {
  FitPendulumFlags flags;
  flags.data = "datasets/textbook_rig.csv";
  flags.rig = "datasets/textbook_rig.json";
  return *MakeFitPendulumOptions(flags);
}

Result<Identification> OnlyRun(FitPendulumOptions options) {
  const auto setup = ReadSetup(options);
  if (!setup) return tl::unexpected(setup.error());
  auto runs = FitAll(options, *setup);
  if (!runs) return tl::unexpected(runs.error());
  EXPECT_EQ(runs->size(), 1);
  return runs->front();
}

TEST(FitAll, AddsClosedFormsAndTheirCheckToAFit) {
  const auto run = OnlyRun(TextbookOptions());
  ASSERT_TRUE(run) << run.error().message();
  const Identification& report = *run;
  ASSERT_EQ(report.fits.size(), 1);
  ASSERT_TRUE(report.recordings.front().closed_forms);
  EXPECT_EQ(report.recordings.front().closed_forms_model, "coulomb");
  ASSERT_EQ(report.recordings.front().checks.size(), 1);
  EXPECT_FALSE(report.recordings.front().checks[0].rows.empty());
  EXPECT_EQ(report.recordings.front().checks[0].overlay.linear.size(), report.recordings.front().used.size());
  ASSERT_TRUE(report.recordings.front().sampling);
  EXPECT_NEAR(report.recordings.front().sampling->rate_hz, 100, 1e-6);
}

TEST(FitAll, SkipsFitsForClosedFormsOnly) {
  FitPendulumOptions options = TextbookOptions();
  options.closed_form_only = true;
  const auto run = OnlyRun(options);
  ASSERT_TRUE(run) << run.error().message();
  const Identification& report = *run;
  EXPECT_TRUE(report.fits.empty());
  EXPECT_TRUE(report.recordings.front().checks.empty());
  EXPECT_EQ(report.recordings.front().data.used_samples, 2000);
  ASSERT_TRUE(report.recordings.front().closed_forms && report.recordings.front().closed_forms->decrement);
  const Estimate inertia = report.recordings.front().closed_forms->decrement->inertia;
  EXPECT_NEAR(1.8033 * inertia.value, 0.079, 4 * 1.8033 * inertia.std_error);
}

// The rig's masses and lengths predict sqrt(1.8033 / 0.0761) / 2π = 0.775 Hz. The recorded swing, at up to 24 deg, is
// slower.
TEST(FitAll, ComparesTheFrequencyWithThePredictionOfTheRig) {
  FitPendulumOptions options = TextbookOptions();
  options.closed_form_only = true;
  const auto run = OnlyRun(options);
  ASSERT_TRUE(run && run->recordings.front().sampling);
  EXPECT_NEAR(run->recordings.front().sampling->expected_frequency_hz.value_or(0), 0.775, 0.001);
  EXPECT_NEAR(run->recordings.front().sampling->frequency_hz, 0.755, 0.01);
}

TEST(FitAll, ExplainsMissingClosedForms) {
  FitPendulumOptions options = TextbookOptions();
  options.closed_form_only = true;
  options.swing.from = 1.9;
  options.swing.to = 2.9;  // one turning point
  const auto run = OnlyRun(options);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(run.error().message(), HasSubstr("turn"));
}

TEST(CheckNumberedOutputs, RefusesStandardOutputForSeveralRuns) {
  FitPendulumOptions options = TextbookOptions();
  options.series = "-";
  EXPECT_TRUE(CheckNumberedOutputs(options, {}, 1));
  const auto checked = CheckNumberedOutputs(options, {}, 2);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message(),
            "--series - takes one fit, but there are 2; give a file name, to which the number is added");
}

// ---- Joint fits -----------------------------------------------------------------------------------------------------

/// Options for two recordings of one rig from src/docs/examples.md: I_O = 0.079 kg m², b = 0.002 N m s/rad, τ_c = 0.004
/// N m, released at 0.2 and 0.45 rad.
FitPendulumOptions TwoRunsOptions() {
  FitPendulumFlags flags;
  flags.data = "datasets/runs_1.csv,datasets/runs_2.csv";
  flags.rig = "datasets/textbook_rig.json";
  return *MakeFitPendulumOptions(flags);
}

TEST(FitAll, CombinesSeveralRecordingsInOneRun) {
  const auto run = OnlyRun(TwoRunsOptions());
  ASSERT_TRUE(run) << run.error().message();
  const Identification& report = *run;
  ASSERT_TRUE(report.is_joint());
  ASSERT_EQ(report.recordings.size(), 2);
  EXPECT_GT(report.recordings[1].used.size(), 0);
  ASSERT_EQ(report.across.size(), 1);
  EXPECT_EQ(report.recordings[0].data.path, "datasets/runs_1.csv");
  EXPECT_EQ(report.recordings[1].data.path, "datasets/runs_2.csv");
  EXPECT_EQ(report.unit, "rad");
  EXPECT_EQ(report.fits[0].termination, Termination::kConverged);
  EXPECT_THAT(report.across[0].shared, ElementsAre("inertia", "viscous", "coulomb"));
  EXPECT_THAT(report.across[0].separate, ElementsAre("converged", "converged"));
  const std::vector<std::pair<std::string, double>> truth = {
      {"inertia", 0.079}, {"viscous", 0.002}, {"coulomb", 0.004}};
  for (const auto& [name, value] : truth) {
    const ParameterEstimate* const estimate = report.fits[0].Find(name);
    ASSERT_NE(estimate, nullptr) << name;
    EXPECT_NEAR(estimate->estimate, value, 4 * estimate->std_error.value()) << name;
    for (const IdentifiedRecording& own : report.recordings) {
      EXPECT_EQ(own.own_fits[0].Find(name)->estimate, estimate->estimate) << name;
      EXPECT_EQ(own.own_fits[0].Find(name)->std_error, estimate->std_error) << name;
    }
  }
}

// A shared parameter has at most the standard error of either recording alone.
TEST(FitAll, EstimatesSharedParametersBetterJointly) {
  const auto together = OnlyRun(TwoRunsOptions());
  ASSERT_TRUE(together);
  for (const char* path : {"datasets/runs_1.csv", "datasets/runs_2.csv"}) {
    FitPendulumOptions options = TwoRunsOptions();
    options.data = {path};
    const auto alone = OnlyRun(options);
    ASSERT_TRUE(alone) << alone.error().message();
    EXPECT_FALSE(alone->is_joint());
    for (const char* name : {"inertia", "viscous", "coulomb"}) {
      EXPECT_LT(together->fits[0].Find(name)->std_error.value(), alone->fits[0].Find(name)->std_error.value())
          << path << " " << name;
    }
  }
}

TEST(FitAll, AddsClosedFormsAndSamplingToEachRecording) {
  const auto run = OnlyRun(TwoRunsOptions());
  ASSERT_TRUE(run);
  for (std::size_t k = 0; k < 2; ++k) {
    const IdentifiedRecording& own = run->recordings[k];
    EXPECT_TRUE(own.closed_forms) << own.no_closed_forms;
    EXPECT_EQ(own.checks.size(), 1);
    EXPECT_EQ(own.constancy.size(), 1);
    ASSERT_TRUE(own.sampling);
    EXPECT_NEAR(own.sampling->rate_hz, 100, 1e-6);
    EXPECT_EQ(own.data.used_samples, own.used.size());
    EXPECT_EQ(own.own_fits[0].residual.size(), own.used.size());
  }
}

TEST(FitAll, FitsRecordingsSeparatelyIfNothingIsShared) {
  FitPendulumOptions options = TwoRunsOptions();
  options.sharing = Sharing::kNothing;
  const auto setup = ReadSetup(options);
  ASSERT_TRUE(setup);
  const auto runs = FitAll(options, *setup);
  ASSERT_TRUE(runs);
  ASSERT_EQ(runs->size(), 2);
  for (const auto& run : *runs) EXPECT_FALSE(run.value().is_joint());
}

TEST(FitAll, MakesNoJointFitIfOneRecordingFails) {
  FitPendulumOptions options = TwoRunsOptions();
  options.data.emplace_back("datasets/nowhere.csv");
  const auto run = OnlyRun(options);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kNotFound);
  EXPECT_EQ(run.error().message(), "datasets/nowhere.csv: there is no such file; check the path");
}

TEST(FitAll, RefusesToShareParametersOfOneSwing) {
  FitPendulumFlags flags;
  flags.data = "datasets/runs_1.csv";
  flags.shared = "all";
  const auto run = OnlyRun(*MakeFitPendulumOptions(flags));
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(
      run.error().message(),
      "--shared is for several recordings, or several releases of one (--release all), but there is only one swing");
}

TEST(CheckNumberedOutputs, AllowsAJointResultOnStandardOutput) {
  FitPendulumOptions options = TwoRunsOptions();
  options.json = "-";
  const auto setup = ReadSetup(options);
  ASSERT_TRUE(setup);
  EXPECT_TRUE(CheckNumberedOutputs(options, *setup, 2));
  options.json.clear();
  options.residuals = "-";  // residuals of each recording
  const auto checked = CheckNumberedOutputs(options, *setup, 2);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(checked.error().message(),
            "--residuals - takes one recording, but there are 2; give a file name, to which the number is added");
}

}  // namespace
}  // namespace pendulum::fit_runs_test
