// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::fit_runs_test {
namespace {

using testing::HasSubstr;

/// Options for a recording of the textbook's rig, held until 1.9 s, whose truth is I_O = 0.079 kg m² and G = 1.8033 N
/// m.
FitPendulumOptions TextbookOptions() {
  FitPendulumFlags flags;
  flags.data = "datasets/textbook_rig.csv";
  flags.rig = "datasets/textbook_rig.json";
  return *MakeFitPendulumOptions(flags);
}

Result<FitRun> OnlyRun(FitPendulumOptions options) {
  const auto setup = ReadSetup(options);
  if (!setup) return tl::unexpected(setup.error());
  auto runs = FitAll(options, *setup);
  if (!runs) return tl::unexpected(runs.error());
  EXPECT_EQ(runs->size(), 1);
  return runs->front();
}

TEST(FitAll, PutsClosedFormsAndTheirCheckBesideAFit) {
  const auto run = OnlyRun(TextbookOptions());
  ASSERT_TRUE(run) << run.error().message;
  const RunReport& report = run->report;
  ASSERT_EQ(report.fits.size(), 1);
  ASSERT_TRUE(report.closed_forms);
  EXPECT_EQ(report.closed_forms_model, "coulomb");
  ASSERT_EQ(report.checks.size(), 1);
  EXPECT_FALSE(report.checks[0].rows.empty());
  EXPECT_EQ(report.checks[0].overlay.linear.size(), run->used.size());
  ASSERT_TRUE(report.sampling);
  EXPECT_NEAR(report.sampling->rate_hz, 100, 1e-6);
}

TEST(FitAll, MakesNoFitForClosedFormsOnly) {
  FitPendulumOptions options = TextbookOptions();
  options.closed_form_only = true;
  const auto run = OnlyRun(options);
  ASSERT_TRUE(run) << run.error().message;
  const RunReport& report = run->report;
  EXPECT_TRUE(report.fits.empty());
  EXPECT_TRUE(report.checks.empty());
  EXPECT_EQ(report.data.used_samples, 2000);
  ASSERT_TRUE(report.closed_forms && report.closed_forms->decrement);
  const Estimate inertia = report.closed_forms->decrement->inertia;
  EXPECT_NEAR(1.8033 * inertia.value, 0.079, 4 * 1.8033 * inertia.std_error);
}

// sqrt(1.8033 / 0.0761) / 2π = 0.775 Hz from the rig's masses and lengths; seen, at up to 24 deg, is a slower swing.
TEST(FitAll, ComparesTheSwingWithWhatTheRigLetsExpect) {
  FitPendulumOptions options = TextbookOptions();
  options.closed_form_only = true;
  const auto run = OnlyRun(options);
  ASSERT_TRUE(run && run->report.sampling);
  EXPECT_NEAR(run->report.sampling->expected_frequency_hz.value_or(0), 0.775, 0.001);
  EXPECT_NEAR(run->report.sampling->frequency_hz, 0.755, 0.01);
}

TEST(FitAll, SaysWhyThereAreNoClosedForms) {
  FitPendulumOptions options = TextbookOptions();
  options.closed_form_only = true;
  options.swing.from = 1.9;
  options.swing.to = 2.9;  // one turning point
  const auto run = OnlyRun(options);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(run.error().message, HasSubstr("turn"));
}

TEST(CheckNumberedOutputs, RefusesStandardOutputForSeveralRuns) {
  FitPendulumOptions options = TextbookOptions();
  options.series = "-";
  EXPECT_TRUE(CheckNumberedOutputs(options, {}, 1));
  const auto checked = CheckNumberedOutputs(options, {}, 2);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message, "--series - takes one fit, and there are 2; name a file, and they are numbered");
}

}  // namespace
}  // namespace pendulum::fit_runs_test
