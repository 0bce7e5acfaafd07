// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/lost_counts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::lost_counts_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::Lt;
using testing::SizeIs;

/// The textbook rig's sensor with noise of `noise` counts.
SyntheticOptions CountingRun(double noise) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.resolution = kCount;
  run.noise = noise * kCount;
  run.seed = 11;
  return run;
}

SwingFit Fit(const Recording& recording, std::string_view model = "coulomb") {
  const ChosenSwings swings = Must(ChooseSwings(recording, {}));
  FitOptions options;
  options.model = model;
  return Must(FitSwing(recording, swings.found[static_cast<std::size_t>(swings.chosen.at(0) - 1)], options));
}

std::string MessageOf(const FitReport& fit, std::string_view code) {
  for (const Warning& warning : fit.warnings) {
    if (warning.code == code) return MessageText(warning);
  }
  throw std::runtime_error("no warning " + std::string(code));
}

/// The largest |estimate - truth| divided by its standard error.
double LargestDeviation(const FitReport& fit, const SyntheticOptions& run) {
  const std::vector<double> truth = TrueParameters(run);
  double largest = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    largest = std::max(largest, std::abs(fit.parameters[i].estimate - truth[i]) / fit.parameters[i].std_error.value());
  }
  return largest;
}

TEST(FindOffsetJumps, FindsNothingWithoutJumps) {
  for (const double noise : {0.1, 1.0}) {
    EXPECT_FALSE(FindOffsetJumps(Must(SimulateRecording(CountingRun(noise))), {}));
  }
}

TEST(FindOffsetJumps, RestoresTheReadingsBeforeLostCounts) {
  SyntheticOptions run = CountingRun(0.25);
  const Recording whole = Must(SimulateRecording(run));
  run.lost_counts = {{5.2, 2}, {11.7, -1}};
  const auto jumps = FindOffsetJumps(Must(SimulateRecording(run)), {});
  ASSERT_TRUE(jumps);
  EXPECT_THAT(jumps->lost, ElementsAre(Field(&LostCounts::counts, 2), Field(&LostCounts::counts, -1)));
  const Eigen::ArrayXd levels = (jumps->corrected.value - whole.value).array() / kCount;
  // With noise, the position of a jump is known to a few samples.
  EXPECT_LE((levels.round().abs() > 0).count(), 6);
  EXPECT_EQ(levels.round().matrix().tail<1>()[0], 0);
}

TEST(FitSwing, CorrectsAndReportsLostCounts) {
  SyntheticOptions run = CountingRun(0.5);
  run.lost_counts = {{6.5, -3}};
  const SwingFit result = Fit(Must(SimulateRecording(run)));
  EXPECT_EQ(result.fit.termination, Termination::kConverged);
  EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("the zero jumps by -3 counts at 6.5"));
  EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("were corrected by its size"));
  EXPECT_EQ(KeptAttempts(result.fit).front(), "offset_jumps");
  EXPECT_FALSE(result.fit.HasWarning("lack_of_fit") || result.fit.HasWarning("correlated_residuals"));
  EXPECT_THAT(LargestDeviation(result.fit, run), Lt(4));
}

TEST(FitSwing, CorrectsOneLostCountBelowTheNoise) {
  SyntheticOptions run = CountingRun(1);
  run.lost_counts = {{9.1, 1}};
  const SwingFit result = Fit(Must(SimulateRecording(run)));
  EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("by 1 count at "));
  EXPECT_THAT(LargestDeviation(result.fit, run), Lt(4));
}

TEST(FitSwing, FindsLostCountsForAnyRequestedLaw) {
  SyntheticOptions run = CountingRun(0.5);
  run.lost_counts = {{6.5, 4}};
  const SwingFit result = Fit(Must(SimulateRecording(run)), "viscous");
  EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("by 4 counts at 6.5"));
  EXPECT_TRUE(result.fit.HasWarning("lack_of_fit"));  // the data contain dry friction
}

TEST(FitSwing, LocatesCountsLostWithinAGap) {
  for (const int counts : {1, 2, 5}) {
    SyntheticOptions run = CountingRun(0.5);
    run.lost_counts = {{9.5, counts}};
    Recording recording = Must(SimulateRecording(run));
    const Eigen::Index gap = 900, size = 100;  // 9 s to 10 s
    const Eigen::Index behind = recording.size() - gap - size;
    recording.time.segment(gap, behind) = recording.time.tail(behind).eval();
    recording.value.segment(gap, behind) = recording.value.tail(behind).eval();
    recording.time.conservativeResize(gap + behind);
    recording.value.conservativeResize(gap + behind);
    const SwingFit result = Fit(recording);
    EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("at 10 s")) << counts;
    EXPECT_THAT(LargestDeviation(result.fit, run), Lt(4)) << counts;
  }
}

/// Events of an encoder whose counter loses one count at some turning points, and once four counts during the motion,
/// when a busy logger missed rows.
TEST(FitSwing, CorrectsCountsLostByAnEventEncoder) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.start = StartKind::kMoving;
  run.initial_angle = -0.3;
  run.initial_rate = 0.5;
  run.rows = RowTiming::kEvents;
  run.sample_rate = 1000;
  run.resolution = 0.0026;
  run.hysteresis = 0.35 * run.resolution;
  run.noise = 0.05 * run.resolution;
  for (int k = 0; k < 14; ++k) run.lost_counts.push_back({1.3 + 1.297 * k, k % 3 == 0 ? -1 : 1});
  run.lost_counts.push_back({12.4, -4});
  std::ranges::sort(run.lost_counts, {}, &LostCounts::time);
  const Recording edges = WithEdges(Must(SimulateRecording(run)), {});
  const SwingFit result = Fit(edges);
  EXPECT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
  EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("and at 10 more times"));
  EXPECT_FALSE(result.fit.HasWarning("lack_of_fit"));
  EXPECT_THAT(LargestDeviation(result.fit, run), Lt(4));
}

TEST(FitSwing, KeepsAJumpNearTheEndInTheWindow) {
  SyntheticOptions run = CountingRun(0.5);
  run.lost_counts = {{19.2, 2}};
  const SwingFit result = Fit(Must(SimulateRecording(run)));
  EXPECT_THAT(MessageOf(result.fit, "lost_counts"), HasSubstr("by 2 counts at 19.2"));
  EXPECT_THAT(result.swing.to, DoubleNear(19.99, 1e-9));
}

TEST(FitSwing, DoesNotConvergeForASlippingZero) {
  SyntheticOptions run = CountingRun(0.5);
  for (const double resolution : {0.0, kCount}) {
    run.resolution = resolution;
    Recording recording = Must(SimulateRecording(run));
    recording.value.tail(1100).array() += 2.5 * kCount;  // from 9 s on
    const SwingFit result = Fit(recording);
    EXPECT_EQ(result.fit.termination, Termination::kNotConverged);
    // 2.5 counts are 0.00866 rad.
    EXPECT_THAT(MessageOf(result.fit, "offset_jumps"), HasSubstr("the zero jumps by 0.008"));
    EXPECT_THAT(MessageOf(result.fit, "offset_jumps"), HasSubstr("choose a window before or after the jump"));
    EXPECT_EQ(result.fit.reason, MessageOf(result.fit, "offset_jumps"));
    EXPECT_FALSE(result.fit.parameters[1].std_error);
  }
}

TEST(MayHaveOffsetJump, DetectsAChangeOfTheMean) {
  FitReport fit;
  fit.fitted = Eigen::ArrayXd::LinSpaced(1000, 0, 99).sin();
  fit.residual = 0.01 * Eigen::ArrayXd::LinSpaced(1000, 0, 12345).sin();
  EXPECT_FALSE(MayHaveOffsetJump(fit));
  fit.residual.tail(400).array() += 0.005;
  EXPECT_TRUE(MayHaveOffsetJump(fit));
  fit.residual *= 1e-8;  // floating-point rounding error
  EXPECT_FALSE(MayHaveOffsetJump(fit));
}

}  // namespace
}  // namespace pendulum::lost_counts_test
