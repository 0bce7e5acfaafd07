// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/constancy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/fitted_run.h"

namespace pendulum::constancy_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;
using testing::SizeIs;

SyntheticOptions NoisyTextbookRun(std::string_view model) {
  SyntheticOptions run = TextbookRun(model);
  run.noise = 0.002;
  return run;
}

Constancy TestFit(const FitOfRun& run, FitOptions options) {
  options.rig = run.rig;
  return TestConstancy(run.recording, run.fit, options);
}

Constancy TestRun(const SyntheticOptions& run, std::string_view model, const std::optional<Rig>& rig = {}) {
  return TestFit(FitTo(run, model, rig), ModelOptions(model));
}

/// 30 s whose readings are all 2 % too large, by a sensor whose gain is known to 1 %.
Recording TooLarge() {
  SyntheticOptions run = NoisyTextbookRun("coulomb");
  run.duration = 30;
  Recording recording = Must(SimulateRecording(run));
  recording.value *= 1.02;
  recording.sensor_errors.Of(SensorEffect::kGain) = {0.01, "assumed"};
  return recording;
}

/// Two recordings joined; the second has `second_inertia` times the inertia.
Recording JoinedAt(double second_inertia) {
  SyntheticOptions run = NoisyTextbookRun("viscous");
  run.duration = 12;
  Recording first = Must(SimulateRecording(run));
  // The state at 12 s, from the noise-free trajectory.
  Start<double> start{StartKind::kRelease, run.release_time, run.release_angle, 0};
  TraceOptions trace;
  trace.end = 12;
  const Trajectory motion = Must(MakeTrajectory(run.model, run.parameters, start, trace));
  run.start = StartKind::kMoving;
  run.start_time = 12;
  run.initial_angle = motion.Angle(12);
  run.initial_rate = motion.Rate(12);
  run.parameters[0] *= second_inertia;
  run.seed = 2;
  const Recording second = Must(SimulateRecording(run));
  Recording joined = first;
  joined.time.resize(first.size() + second.size());
  joined.value.resize(joined.time.size());
  joined.time << first.time, second.time;
  joined.value << first.value, second.value;
  return joined;
}

// The first half hardly shows static friction, so that its estimate is far from that of the second half in some
// recordings, while the likelihood hardly differs.
TEST(TestConstancy, ComparesHalvesByTheirLikelihood) {
  int different_by_errors = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Constancy result = TestRun(StickingRun(0.1, seed), "stribeck");
    if (!result.halves_p) continue;
    EXPECT_GT(*result.halves_p, kNotConstant) << result.verdict;
    const auto stiction = std::ranges::find(result.halves, "stiction", &HalvesRow::name);
    different_by_errors += std::abs(stiction->second - stiction->first) > 0.5 * stiction->second;
  }
  EXPECT_GT(different_by_errors, 2);
}

// Readings that are too large make the period depend on amplitude in another way than that of the model.
TEST(TestConstancy, TestsTheCorrectedReadings) {
  const FitOptions options = ModelOptions("coulomb");
  const FitOfRun run = FitTo(TooLarge(), options);
  ASSERT_GT(run.fit.correction.size(), 0);
  const Constancy corrected = TestFit(run, options);
  EXPECT_TRUE(corrected.constant()) << corrected.verdict;
  FitOptions as_recorded = options;
  as_recorded.search.may_correct = false;
  EXPECT_FALSE(TestFit(FitTo(TooLarge(), as_recorded), as_recorded).constant());
}

TEST(Constancy, IsConfirmedForTheRightLaw) {
  for (const char* model : {"linear", "viscous", "coulomb", "drag"}) {
    const Constancy constancy = TestRun(NoisyTextbookRun(model), model, TextbookRig());
    EXPECT_TRUE(constancy.constant()) << model << constancy.verdict;
    EXPECT_THAT(constancy.reason, IsEmpty()) << model;
    EXPECT_THAT(constancy.verdict, HasSubstr("inertia and friction are constants of the recording: halves agree"));
    EXPECT_THAT(constancy.trends, SizeIs(2)) << model;
  }
}

// The recording has I_O = 0.079 kg m²; rows are in SI.
TEST(Constancy, HasRowsInTheUnitsOfTheFit) {
  const Constancy constancy = TestRun(NoisyTextbookRun("viscous"), "viscous", TextbookRig());
  ASSERT_THAT(constancy.halves, ElementsAre(Field(&HalvesRow::name, "inertia"), Field(&HalvesRow::name, "viscous")));
  const HalvesRow& inertia = constancy.halves[0];
  EXPECT_EQ(inertia.unit, "kg m^2");
  EXPECT_THAT(inertia.first, DoubleNear(0.079, 5 * inertia.first_std_error));
  EXPECT_THAT(inertia.second, DoubleNear(0.079, 5 * inertia.second_std_error));
  EXPECT_EQ(constancy.halves_dof, 2);
  double last_amplitude = 0.423;  // rad, the release
  for (const AmplitudeRow& row : constancy.windows) {
    EXPECT_THAT(row.inertia, DoubleNear(0.079, 5 * row.inertia_std_error));
    EXPECT_THAT(row.friction, DoubleNear(0.003, 5 * row.friction_std_error));
    EXPECT_THAT(row.to - row.from, Gt(2.9 * 1.315));  // three periods, less a sample
    EXPECT_THAT(row.amplitude, Lt(last_amplitude));
    last_amplitude = row.amplitude;
  }
}

// Equal information: the errors of the halves' inertia differ by less than a factor of 1.5 although the amplitude
// falls.
TEST(Constancy, HasHalvesOfEqualInformation) {
  const Constancy constancy = TestRun(NoisyTextbookRun("viscous"), "viscous");
  const HalvesRow& inertia = constancy.halves.at(0);
  EXPECT_THAT(std::abs(std::log(inertia.first_std_error / inertia.second_std_error)), Lt(std::log(1.5)));
}

TEST(Constancy, RejectsAnInertiaThatChangesHalfway) {
  const Recording joined = JoinedAt(1.01);
  const Constancy constancy = TestFit(FitTo(joined, ModelOptions("viscous")), ModelOptions("viscous"));
  EXPECT_FALSE(constancy.constant()) << constancy.verdict << constancy.reason;
  EXPECT_THAT(constancy.verdict, HasSubstr("inertia"));
  EXPECT_TRUE(TestFit(FitTo(JoinedAt(1), ModelOptions("viscous")), ModelOptions("viscous")).constant());
}

// A viscous fit to dry friction finds τ_c 4 / (π A ω), which is larger for smaller swings.
TEST(Constancy, RejectsFrictionOfAnotherLaw) {
  const Constancy constancy = TestRun(NoisyTextbookRun("coulomb"), "viscous");
  ASSERT_THAT(constancy.trends, SizeIs(2));
  EXPECT_THAT(constancy.trends[1].slope, Lt(0));
  EXPECT_THAT(constancy.trends[1].p, Lt(kNotConstant));
  EXPECT_THAT(constancy.verdict, HasSubstr("viscous rises by"));
}

// The period of linear gravity lacks the factor 1 + A²/16 of a real swing, so its inertia must grow by A²/8.
TEST(Constancy, RejectsAPeriodThatDependsOnAmplitude) {
  FitOptions options = ModelOptions("viscous");
  options.gravity = Gravity::kLinear;
  const Constancy constancy = TestFit(FitTo(Must(SimulateRecording(NoisyTextbookRun("viscous"))), options), options);
  ASSERT_THAT(constancy.trends, SizeIs(2));
  const double inertia = 0.079 / kTextbookTorque;
  EXPECT_THAT(constancy.trends[0].slope, DoubleNear(inertia / 8, 0.1 * inertia / 8));
  EXPECT_THAT(constancy.verdict, HasSubstr("inertia falls by"));
}

TEST(Constancy, IsTestedOnARateSensor) {
  SyntheticOptions run = NoisyTextbookRun("coulomb");
  run.quantity = Quantity::kRate;
  run.noise = 0.01;
  const Constancy constancy = TestRun(run, "coulomb");
  EXPECT_TRUE(constancy.constant()) << constancy.verdict;
  EXPECT_THAT(constancy.reason, IsEmpty());
}

TEST(Constancy, SkipsFixedParameters) {
  const Recording recording = Must(SimulateRecording(NoisyTextbookRun("coulomb")));
  FitOptions options = ModelOptions("coulomb");
  options.fixed = {{"viscous", 0.003 / kTextbookTorque}, {"coulomb", 0.004 / kTextbookTorque}};
  const Constancy constancy = TestFit(FitTo(recording, options), options);
  EXPECT_THAT(constancy.halves, ElementsAre(Field(&HalvesRow::name, "inertia")));
  EXPECT_THAT(constancy.trends, ElementsAre(Field(&AmplitudeTrend::name, "inertia")));
  for (const AmplitudeRow& row : constancy.windows) EXPECT_TRUE(std::isnan(row.friction));
  options.fixed.emplace("inertia", 0.079 / kTextbookTorque);
  const Constancy nothing = TestFit(FitTo(recording, options), options);
  EXPECT_THAT(nothing.reason, HasSubstr("inertia and friction are fixed"));
  EXPECT_FALSE(nothing.halves_p);
}

// A fixed release applies to the whole recording, not to its parts.
TEST(Constancy, AcceptsAFixedRelease) {
  FitOptions options = ModelOptions("viscous");
  options.fixed = {{"release_angle", 0.423}};
  const Constancy constancy = TestFit(FitTo(Must(SimulateRecording(NoisyTextbookRun("viscous"))), options), options);
  EXPECT_TRUE(constancy.halves_p);
  EXPECT_THAT(constancy.reason, IsEmpty());
}

TEST(Constancy, ReportsTooShortParts) {
  SyntheticOptions run = NoisyTextbookRun("viscous");
  run.duration = 12;
  const Constancy halves_only = TestRun(run, "viscous");
  EXPECT_TRUE(halves_only.halves_p);
  EXPECT_TRUE(halves_only.is_too_short_for_windows() && !halves_only.is_too_short_for_halves());
  EXPECT_THAT(halves_only.reason, HasSubstr("too few for windows of three periods"));
  run.duration = 6;
  const Constancy nothing = TestRun(run, "viscous");
  EXPECT_FALSE(nothing.halves_p);
  EXPECT_THAT(nothing.trends, IsEmpty());
  EXPECT_TRUE(nothing.is_too_short_for_windows() && nothing.is_too_short_for_halves());
  EXPECT_THAT(nothing.reason, HasSubstr("too few for halves"));
  EXPECT_THAT(nothing.verdict, HasSubstr("not tested"));
}

// An untested fit knows its half swings as well: 10 s after the release at 1.9 s of a pendulum of 0.66 s each.
TEST(Constancy, CountsTheHalfSwingsOfAnUntestedFit) {
  SyntheticOptions run = NoisyTextbookRun("viscous");
  run.duration = 12;
  const FitOfRun fitted = FitTo(run, "viscous", {});
  const Constancy untested = UntestedConstancy(fitted.recording, fitted.fit, {}, "not asked for");
  EXPECT_EQ(untested.half_swings, TestConstancy(fitted.recording, fitted.fit, ModelOptions("viscous")).half_swings);
  EXPECT_TRUE(untested.half_swings == 15U || untested.half_swings == 14U) << *untested.half_swings;
  EXPECT_EQ(untested.reason, "not asked for");
}

TEST(Constancy, IsNotTestedWithoutConvergence) {
  FitOfRun run = FitTo(NoisyTextbookRun("viscous"), "viscous", {});
  run.fit.termination = Termination::kNotConverged;
  EXPECT_THAT(TestFit(run, ModelOptions("viscous")).reason, HasSubstr("did not converge"));
}

TEST(Constancy, IsNotTestedWithoutTurningPoints) {
  SyntheticOptions run = NoisyTextbookRun("viscous");
  FitOfRun fitted = FitTo(run, "viscous", {});
  run.sample_rate = 3;  // 4 samples per period
  fitted.recording = Must(SimulateRecording(run));
  EXPECT_THAT(TestFit(fitted, ModelOptions("viscous")).reason, HasSubstr("sampled too slowly"));
}

// The pendulum stops at about 41 s; all half swings are before that.
TEST(Constancy, IsTestedBeforeThePendulumComesToRest) {
  SyntheticOptions run = NoisyTextbookRun("coulomb");
  run.duration = 60;
  run.sample_rate = 50;
  const Constancy constancy = TestRun(run, "coulomb");
  EXPECT_TRUE(constancy.halves_p) << constancy.reason;
  ASSERT_THAT(constancy.windows, SizeIs(8));
  EXPECT_THAT(constancy.windows.back().to, Lt(42));
}

// One second of the file is 1.02 true seconds; the results must not change.
TEST(Constancy, DoesNotDependOnTheClock) {
  FitOfRun run = FitTo(NoisyTextbookRun("viscous"), "viscous", {});
  const Constancy plain = TestFit(run, ModelOptions("viscous"));
  run.recording.time /= 1.02;
  run.recording.clock_scale = 1.02;
  const Constancy scaled = TestFit(FitTo(run.recording, ModelOptions("viscous")), ModelOptions("viscous"));
  EXPECT_THAT(*scaled.halves_p, DoubleNear(*plain.halves_p, 0.02));
  EXPECT_THAT(scaled.trends.at(0).p, DoubleNear(plain.trends.at(0).p, 0.02));
}

}  // namespace
}  // namespace pendulum::constancy_test
