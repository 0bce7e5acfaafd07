// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/part_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/fitted_run.h"

namespace pendulum::part_fit_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::Le;

auto RelativelyNear(double expected, double tolerance) { return DoubleNear(expected, std::abs(tolerance * expected)); }

double EstimateOf(const PartFit& part, std::string_view name) { return part.fit.Find(name)->estimate; }

/// Noise of a millionth of the swing: the tolerances below are some hundred times its effect.
SyntheticOptions QuietRun(std::string_view model) {
  SyntheticOptions run = TextbookRun(model);
  run.noise = 4e-7;
  return run;
}

Trajectory MotionOf(const SyntheticOptions& run) {
  TraceOptions trace;
  trace.end = run.duration;
  return Must(MakeTrajectory(run.model, run.parameters, {StartKind::kRelease, run.release_time, run.release_angle, 0.0},
                             trace));
}

// ---- Parts ---------------------------------------------------------------------------------------------------------

TEST(Parts, RecoverTheTruthFromANoiseFreePart) {
  const SyntheticOptions run = QuietRun("coulomb");
  const FitOfRun whole = FitTo(run, "coulomb", {});
  const PartFit part = Parts(whole.recording, whole.fit, ModelOptions("coulomb")).Fit(7.125, 14, {});
  ASSERT_TRUE(part.converged()) << part.reason;
  const std::vector<double> truth = TextbookParameters(run.model);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_THAT(part.fit.parameters[i].estimate, RelativelyNear(truth[i], 1e-4)) << part.fit.parameters[i].info.name;
  // 7.13 s is the first sample inside the part, at 100 Hz.
  EXPECT_EQ(part.first, 713);
  EXPECT_EQ(part.part.size(), 688);
  EXPECT_THAT(EstimateOf(part, "initial_angle"), DoubleNear(MotionOf(run).Angle(7.13), 1e-6));
  EXPECT_THAT(EstimateOf(part, "initial_rate"), DoubleNear(MotionOf(run).Rate(7.13), 1e-5));
}

// AR(1) noise with 0.5, a quarter of a count: the residuals of rounded readings show 0.201 of its correlations, so the
// inflation is 1 + 2 * 0.201 = 1.4. Halves of 10 s are often too short to show it.
TEST(Parts, ShareTheAutocorrelationThatTheWholeRecordingHasShown) {
  constexpr int kSeeds = 20;
  SyntheticOptions run = TextbookRun("coulomb");
  run.resolution = kCount;
  run.noise = 0.25 * kCount;
  run.noise_correlation = 0.5;
  const FitOptions options = ModelOptions("coulomb");
  int shown = 0;
  double inflation = 0;
  for (int i = 0; i < kSeeds; ++i) {
    ++run.seed;
    const FitOfRun whole = FitTo(Must(SimulateRecording(run)), options);
    if (whole.fit.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite) continue;
    const Parts parts(whole.recording, whole.fit, options);
    std::vector<PartFit> halves;
    std::vector<LinearFit> linear;
    for (const double from : {3.0, 11.0}) {
      const PartFit& half = halves.emplace_back(parts.Fit(from, from + 7.995, {}));
      const ReadingTerms terms = TermsOf(parts.NoiseOf(half.fit), half.part.value, half.fit.fitted);
      linear.push_back(*LinearizeFit(half.part, half.fit, options.rig, terms, {}, false));
    }
    const Autocorrelation pooled = parts.PooledAutocorrelation(parts.PooledNoise(halves), halves, linear);
    EXPECT_NE(pooled.kind, Autocorrelation::Kind::kWhite) << run.seed;
    inflation += pooled.VarianceInflation();
    ++shown;
  }
  EXPECT_GE(shown, kSeeds / 2);
  EXPECT_THAT(inflation / shown, RelativelyNear(1.4, 0.15));
}

TEST(Parts, FixTheHeldParametersAndTheFixedParametersOfTheWholeFit) {
  FitOptions options = ModelOptions("coulomb");
  options.fixed = {{"viscous", 0.0016}};
  const FitOfRun whole = FitTo(Must(SimulateRecording(NoisyRun())), options);
  const PartFit part = Parts(whole.recording, whole.fit, options).Fit(3, 9, {"coulomb", "zero_angle"});
  for (const char* name : {"viscous", "coulomb", "zero_angle"}) {
    EXPECT_TRUE(part.fit.Find(name)->fixed) << name;
    EXPECT_THAT(EstimateOf(part, name), RelativelyNear(whole.fit.Find(name)->estimate, 1e-12)) << name;
  }
  EXPECT_FALSE(part.fit.Find("inertia")->fixed);
}

// The zero is 0.012 rad and drifts by 0.001 rad/s: at 8 s it is 0.020 rad.
TEST(Parts, StartADriftingZeroAtItsValueInThePart) {
  Recording recording = Must(SimulateRecording(QuietRun("viscous")));
  recording.value += 0.001 * recording.time;
  FitOptions options = ModelOptions("viscous");
  options.initial = {{"zero_drift", 0.0}};
  const FitOfRun whole = FitTo(recording, options);
  const Parts parts(whole.recording, whole.fit, options);
  EXPECT_THAT(EstimateOf(parts.Fit(8, 16, {}), "zero_angle"), DoubleNear(0.020, 1e-6));
  EXPECT_THAT(EstimateOf(parts.Fit(8, 16, {"zero_angle", "zero_drift"}), "zero_angle"), DoubleNear(0.020, 1e-6));
}

TEST(Parts, ExplainAFailedFit) {
  SyntheticOptions run = NoisyRun();
  run.duration = 60;  // at rest after 41 s
  const FitOfRun whole = FitTo(run, "coulomb", {});
  const Parts parts(whole.recording, whole.fit, ModelOptions("coulomb"));
  EXPECT_FALSE(parts.Fit(3, 3.02, {}).converged());
  EXPECT_THAT(parts.Fit(3, 3.02, {}).reason, HasSubstr("samples"));
  EXPECT_THAT(parts.Fit(45, 60, {}).reason, HasSubstr("swing"));
}

// A pendulum without friction keeps its amplitude A under either gravity, because energy is conserved.
TEST(Parts, GiveTheAmplitudeOfAnUndampedSwing) {
  for (const char* model : {"linear", "viscous"}) {
    SyntheticOptions run = QuietRun(model);
    run.parameters[1] = 0;
    run.release_angle = 1.2;
    FitOptions options = ModelOptions(model);
    options.fixed = {{"viscous", 0.0}};
    const FitOfRun whole = FitTo(Must(SimulateRecording(run)), options);
    const Parts parts(whole.recording, whole.fit, options);
    for (const double time : {1.0, 2.0, 2.2, 7.77, 19.5}) EXPECT_THAT(parts.Amplitude(time), DoubleNear(1.2, 1e-5));
  }
}

TEST(Parts, HaveZeroAmplitudeIfTheMotionCannotBeTraced) {
  FitOfRun whole = FitTo(NoisyRun(), "coulomb", {});
  whole.fit.parameters[0].estimate = -1;
  EXPECT_EQ(Parts(whole.recording, whole.fit, ModelOptions("coulomb")).Amplitude(3), 0);
}

TEST(Parts, UseTheSensorsRangeIfReadingsAreCut) {
  SyntheticOptions run = NoisyRun();
  const FitOfRun free = FitTo(run, "coulomb", {});
  EXPECT_EQ(Parts(free.recording, free.fit, ModelOptions("coulomb")).NoiseOf(free.fit).high, kInfinity);
  run.range = SensorRange{-0.3, 0.3};
  const FitOfRun cut = FitTo(run, "coulomb", {});
  const NoiseModel noise = Parts(cut.recording, cut.fit, ModelOptions("coulomb")).NoiseOf(cut.fit);
  // Inside the range by a millionth of it, so that rounding does not hide a clipped reading.
  EXPECT_THAT(noise.low, DoubleNear(-0.3, 2e-6));
  EXPECT_THAT(noise.high, DoubleNear(0.3, 2e-6));
  EXPECT_EQ(noise.sigma, cut.fit.noise.sigma);
}

// ---- CutEvenly -----------------------------------------------------------------------------------------------------

/// Linear gravity with viscous friction: A = A_0 exp(-t / τ), t after the release, τ = 2 I / b.
struct ExponentialDecay {
  explicit ExponentialDecay(double decay_time) {
    SyntheticOptions run = QuietRun("linear");
    run.parameters[1] = 2 * run.parameters[0] / decay_time;
    run.release_time = 0.5;
    whole = FitTo(run, "linear", {});
    half_swing = kPi / std::sqrt(1 / run.parameters[0] - 1 / (decay_time * decay_time));
    for (double end = 0.5; end < 19.9; end += half_swing) ends.push_back(end);
  }

  FitOfRun whole;
  double half_swing;
  std::vector<double> ends;
};

// ∫ A^(2/3) dt up to t is 1.5 τ (1 - exp(-t / (1.5 τ))). The test computes where this integral reaches thirds of its
// final value. Cuts are at ends of half swings.
TEST(CutEvenly, MakesEqualIntegralsOfAKnownDecay) {
  const double decay = 12;
  const ExponentialDecay swing(decay);
  const Parts parts(swing.whole.recording, swing.whole.fit, ModelOptions("linear"));
  const std::vector<std::size_t> cuts = CutEvenly(swing.ends, 3, parts);
  ASSERT_EQ(cuts.size(), 4u);
  const double total = 1 - std::exp((swing.ends.front() - swing.ends.back()) / (1.5 * decay));
  for (const std::size_t k : {1u, 2u}) {
    const double wanted = 0.5 - 1.5 * decay * std::log(1 - total * static_cast<double>(k) / 3);
    EXPECT_THAT(swing.ends[cuts[k]], DoubleNear(wanted, 0.55 * swing.half_swing)) << k;
  }
  EXPECT_EQ(cuts.front(), 0u);
  EXPECT_EQ(cuts.back(), swing.ends.size() - 1);
}

// In a decay within two periods, half of the integral is reached after one period. A part must still have three
// periods.
TEST(CutEvenly, GivesEachPartThreePeriods) {
  const ExponentialDecay swing(2.6);
  const Parts parts(swing.whole.recording, swing.whole.fit, ModelOptions("linear"));
  EXPECT_THAT(CutEvenly(swing.ends, 4, parts), ElementsAre(0, 6, 12, 18, swing.ends.size() - 1));
  const std::vector<double> fewest(swing.ends.begin(), swing.ends.begin() + 13);
  EXPECT_THAT(CutEvenly(fewest, 2, parts), ElementsAre(0, 6, 12));
}

// ---- Sentences and numbers -----------------------------------------------------------------------------------------

TEST(NextDoubleAfter, IsTheNextLargerDouble) {
  for (const double time : {0.0, 1.5, -3.0, 1e6}) {
    EXPECT_THAT(NextDoubleAfter(time), AllOf(Gt(time), Le(time + std::max(1e-9, std::abs(time) * 1e-15))));
    const double between = 0.5 * (time + NextDoubleAfter(time));
    EXPECT_TRUE(between == time || between == NextDoubleAfter(time));
  }
}

TEST(TooFewHalfSwings, CountsHalfSwingsNotTheirEnds) {
  EXPECT_EQ(TooFewHalfSwings({0, 1, 2, 3}, "halves", 12), "3 half swings are too few for halves; 12 are needed");
}

}  // namespace
}  // namespace pendulum::part_fit_test
