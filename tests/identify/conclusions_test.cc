// SPDX-License-Identifier: Apache-2.0
#include "identify/conclusions.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "pendulum/model/rig.h"
#include "tests/analysis/checked_run.h"

namespace pendulum::conclusions_test {
namespace {

/// 100 samples at 50 Hz on a clock whose second lasts `clock_scale` true seconds.
Recording EvenSamples(double clock_scale) {
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(100, 0, 1.98);
  recording.value = (5 * recording.time.array()).sin();
  recording.clock_scale = clock_scale;
  return recording;
}

TEST(AddConclusions, DerivesTheFrequencyFromTheHalfPeriod) {
  FreeSwing swing;
  swing.half_period = 0.625;
  Identification report;
  report.recordings.emplace_back();
  report.recordings.front().used = EvenSamples(1);
  AddConclusions(swing, std::nullopt, nullptr, {}, 0, report);
  ASSERT_TRUE(report.recordings.front().sampling);
  EXPECT_NEAR(report.recordings.front().sampling->rate_hz, 50, 1e-9);
  EXPECT_DOUBLE_EQ(report.recordings.front().sampling->frequency_hz, 0.8);  // 1 / (2 · 0.625)
  EXPECT_FALSE(report.recordings.front().sampling->expected_frequency_hz);
}

// sqrt(G / I_O) / 2π = sqrt(1.8 / 0.05) / 2π = 6 / 2π Hz in true seconds; 1.1 times as many cycles per second of the
// file's clock.
TEST(AddConclusions, PredictsTheFrequencyFromTheRigOnTheFilesClock) {
  FreeSwing swing;
  swing.half_period = 0.625;
  Identification report;
  report.recordings.emplace_back();
  report.rig = Rig{{1.8, 0}, RigValue{0.05, 0}, {}};
  report.recordings.front().used = EvenSamples(1.1);
  AddConclusions(swing, std::nullopt, nullptr, {}, 0, report);
  ASSERT_TRUE(report.recordings.front().sampling && report.recordings.front().sampling->expected_frequency_hz);
  EXPECT_NEAR(*report.recordings.front().sampling->expected_frequency_hz, 1.1 * 6 / (2 * 3.14159265358979), 1e-12);
}

TEST(AddConclusions, HasNoFrequencyWithoutTurningPoints) {
  Identification report;
  report.recordings.emplace_back();
  report.recordings.front().used = EvenSamples(1);
  AddConclusions(FreeSwing(), std::nullopt, nullptr, {}, 0, report);
  ASSERT_TRUE(report.recordings.front().sampling);
  EXPECT_EQ(report.recordings.front().sampling->frequency_hz, 0);
}

/// A recording with dry friction fitted without it, with only these warnings of the fit and no suspicions.
Identification FittedWithoutDryFriction(const std::vector<Warning>& warnings) {
  FitOfRun run = FitTo(NoisyTextbookRun("coulomb"), "viscous", std::nullopt);
  run.fit.warnings = warnings;
  run.fit.suspicions.clear();
  Identification report;
  report.recordings.emplace_back();
  report.recordings.front().used = std::move(run.recording);
  report.fits.push_back(std::move(run.fit));
  return report;
}

TEST(AddConclusions, WarnsIfClosedFormsDifferAndNothingElseSaysThatTheLawIsWrong) {
  for (const std::vector<Warning>& known : {std::vector<Warning>(), {{"lack_of_fit", "words"}}}) {
    Identification report = FittedWithoutDryFriction(known);
    const MotionModel model = report.fits[0].model;
    AddConclusions(
        FreeSwing(), model, [](std::size_t) { return true; }, {}, 0, report);
    EXPECT_EQ(report.fits[0].HasWarning("closed_forms_differ"), known.empty());
  }
}

// Closed forms use the readings as recorded, and the fit corrected ones.
TEST(AddConclusions, DoesNotWarnOfClosedFormsIfTheReadingsWereCorrected) {
  Identification report = FittedWithoutDryFriction({});
  report.fits[0].correction = Eigen::VectorXd::Constant(report.recordings.front().used.size(), 1e-6);
  const MotionModel model = report.fits[0].model;
  AddConclusions(
      FreeSwing(), model, [](std::size_t) { return true; }, {}, 0, report);
  EXPECT_FALSE(report.fits[0].HasWarning("closed_forms_differ"));
}

}  // namespace
}  // namespace pendulum::conclusions_test
