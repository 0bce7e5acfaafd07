// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/hold_agreement.h"

#include <cmath>
#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::hold_agreement_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

constexpr double kOff = 0.4 * kRadFromDeg;  // rad: where the hand held the pendulum, or by how much it crept

/// The textbook rig for 20 s, held for 1.9 s.
SyntheticOptions HeldRun(std::uint64_t seed, bool is_quantized) {
  SyntheticOptions run = NoisyRun("coulomb", seed);
  run.duration = 20;
  if (is_quantized) run.resolution = kCount;
  return run;
}

/// The run with its hold moved by offset + creep · (share of the hold that is left), before the sensor rounds.
Recording WithHold(SyntheticOptions run, double offset, double creep) {
  const double resolution = run.resolution;
  run.resolution = 0;
  Recording recording = Must(SimulateRecording(run));
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double left = 1 - recording.time[i] / run.release_time;
    if (left > 0) recording.value[i] += offset + creep * left;
    if (resolution > 0) recording.value[i] = std::round(recording.value[i] / resolution) * resolution;
  }
  recording.resolution = resolution;
  return recording;
}

SwingFit FitChosen(const Recording& recording, const FitOptions& options) {
  const ChosenSwings swings = Must(ChooseSwings(recording, {}));
  return Must(FitSwing(recording, swings.found.front(), options));
}

std::optional<HoldDisagreement> DisagreementOf(const Recording& recording) {
  const FitOptions options = ModelOptions("coulomb");
  return FindHoldDisagreement(recording, Must(FitRecording(recording, options)), options);
}

TEST(FindHoldDisagreement, FindsNothingInACleanHold) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_FALSE(DisagreementOf(WithHold(HeldRun(seed, false), 0, 0)));
    EXPECT_FALSE(DisagreementOf(WithHold(HeldRun(seed, true), 0, 0)));
  }
}

TEST(FindHoldDisagreement, FindsNothingInAHoldWithSlowNoise) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    SyntheticOptions run = HeldRun(seed, false);
    run.noise_correlation = 0.9;
    EXPECT_FALSE(DisagreementOf(WithHold(run, 0, 0)));
  }
}

TEST(FindHoldDisagreement, MeasuresOffsetAndCreep) {
  for (const bool is_quantized : {false, true}) {
    SCOPED_TRACE(is_quantized);
    const auto offset = DisagreementOf(WithHold(HeldRun(1, is_quantized), kOff, 0));
    ASSERT_TRUE(offset);
    EXPECT_THAT(offset->offset, DoubleNear(kOff, 0.3 * kOff));
    const auto creep = DisagreementOf(WithHold(HeldRun(1, is_quantized), 0, kOff));
    ASSERT_TRUE(creep);
    EXPECT_THAT(creep->creep, DoubleNear(-kOff, 0.3 * kOff));
  }
}

TEST(FindHoldDisagreement, HasASentence) {
  Recording angle;
  EXPECT_EQ(Sentence({0.007, 0.0002, -0.002, 0.0001}, angle),
            "its readings are 0.007 rad above those that the swing after it predicts, and they creep by 0.002 rad");
  EXPECT_EQ(Sentence({-0.007, 0.0002, 0, 0.0001}, angle),
            "its readings are 0.007 rad below those that the swing after it predicts");
}

/// Whether the fit is corrected for a hand that moved, and its inertia is right within the total error.
void ExpectCorrected(const FitReport& fit, const SyntheticOptions& run) {
  EXPECT_EQ(fit.start, StartKind::kRelease);
  EXPECT_TRUE(fit.HasWarning("suspected_hold") || fit.HasWarning("suspected_push"));
  EXPECT_FALSE(fit.HasWarning("lost_counts") || fit.HasWarning("offset_jumps"));
  const ParameterEstimate& inertia = fit.parameters[0];
  const auto total = TotalStdError(inertia.std_error, inertia.systematic);
  ASSERT_TRUE(total);
  EXPECT_LT(std::abs(inertia.estimate - run.parameters[0]), 4.5 * *total);
}

TEST(FitSwing, CorrectsAHoldAtAnotherAngleOrOneThatCreeps) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const SyntheticOptions run = HeldRun(seed, seed % 2 == 0);
    ExpectCorrected(FitChosen(WithHold(run, kOff, 0), ModelOptions("coulomb")).fit, run);
    ExpectCorrected(FitChosen(WithHold(run, 0, kOff), ModelOptions("coulomb")).fit, run);
  }
}

TEST(FitSwing, DoesNotTakeAMoveOfTheHandForLostCounts) {
  SyntheticOptions run = HeldRun(3, true);
  Recording recording = WithHold(run, 0, 0);
  for (Eigen::Index i = 0; recording.time[i] < 1; ++i) recording.value[i] += 2 * kCount;
  FitOptions options = ModelOptions("coulomb");
  options.start = StartKind::kRelease;  // so the hold stays
  const SwingFit result = FitChosen(recording, options);
  EXPECT_FALSE(result.fit.HasWarning("lost_counts"));
  EXPECT_FALSE(result.fit.HasWarning("offset_jumps"));
}

}  // namespace
}  // namespace pendulum::hold_agreement_test
