// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/amplitude_trend.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/turning_points.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::amplitude_trend_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::Ge;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Lt;
using testing::SizeIs;

constexpr double kInertia0 = 0.079 / kTextbookTorque;  // s²
constexpr double kViscous0 = 0.003 / kTextbookTorque;  // s

SyntheticOptions RunOf(std::string_view model, double noise) {
  SyntheticOptions run = TextbookRun(model);
  run.noise = noise;
  return run;
}

/// The release and the turning points: M + 1 ends of the first M half swings.
std::vector<double> FirstEnds(const Recording& recording, std::size_t half_swings) {
  std::vector<double> ends;
  const TurningPointTable table = Must(FindTurningPoints(recording));
  for (const TurningPoint& turn : table.points) ends.push_back(turn.time);
  EXPECT_THAT(ends.size(), Gt(half_swings));
  ends.resize(half_swings + 1);
  return ends;
}

struct Trends {
  std::string reason;
  Constancy found;
};

Trends TrendsOf(const FitOfRun& run, const FitOptions& options, std::size_t half_swings = 24) {
  Trends trends;
  const Parts parts(run.recording, run.fit, options);
  const std::vector<double> ends = FirstEnds(run.recording, half_swings);
  trends.reason = CompareWindows(run.recording, parts, ends, run.fit, options, trends.found);
  return trends;
}

Trends TrendsOf(const SyntheticOptions& run, const FitOptions& options) {
  return TrendsOf(FitTo(Must(SimulateRecording(run)), options), options);
}

TEST(CompareWindows, FindsNoTrendForTheRightLaw) {
  for (const char* model : {"linear", "viscous", "coulomb", "drag"}) {
    const Trends trends = TrendsOf(RunOf(model, 0.002), ModelOptions(model));
    EXPECT_THAT(trends.reason, IsEmpty()) << model;
    EXPECT_THAT(trends.found.trends, AllOf(SizeIs(2), Each(Field(&AmplitudeTrend::p, Gt(kNotConstant))))) << model;
  }
}

// T = T_0 (1 + A²/16 + 11 A⁴/3072 + ...). Linear gravity can give this period only with a larger inertia, I (1 + A²/8 +
// ...).
TEST(CompareWindows, FindsInertiaRisingIfGravityIsTakenAsLinear) {
  FitOptions options = ModelOptions("viscous");
  options.gravity = Gravity::kLinear;
  const Trends trends = TrendsOf(RunOf("viscous", 2e-4), options);
  ASSERT_THAT(trends.found.trends, SizeIs(2)) << trends.reason;
  const AmplitudeTrend& inertia = trends.found.trends[0];
  EXPECT_EQ(inertia.name, "inertia");
  EXPECT_THAT(inertia.slope, DoubleNear(kInertia0 / 8, 0.05 * kInertia0 / 8));
  EXPECT_THAT(inertia.p, Lt(1e-6));
  const double first = trends.found.windows.front().amplitude, last = trends.found.windows.back().amplitude;
  EXPECT_THAT(inertia.span, DoubleNear((first * first - last * last) / 8, 0.002));
  for (const AmplitudeRow& row : trends.found.windows) {
    const double stretched = 1 + row.amplitude * row.amplitude / 8;
    EXPECT_THAT(row.inertia, DoubleNear(kInertia0 * stretched, 5e-4 * kInertia0));
  }
}

// Sine gravity fitted to a linear swing needs a smaller inertia.
TEST(CompareWindows, FindsInertiaFallingWithAmplitudeForLinearGravity) {
  FitOptions options = ModelOptions("linear");
  options.gravity = Gravity::kSine;
  const Trends trends = TrendsOf(RunOf("linear", 2e-4), options);
  ASSERT_THAT(trends.found.trends, SizeIs(2)) << trends.reason;
  EXPECT_THAT(trends.found.trends[0].slope, DoubleNear(-kInertia0 / 8, 0.05 * kInertia0 / 8));
}

// Per swing, drag c ω² dissipates the energy 8/3 c ω² A³ and viscous friction π b ω A². A viscous fit therefore finds b
// + 8 / (3π) c ω A (in this swing ω falls by about 1 % below its small-angle value).
TEST(CompareWindows, FindsViscousFrictionRisingWithAmplitudeForDrag) {
  const double drag = 0.0005 / kTextbookTorque;
  SyntheticOptions run = RunOf("drag", 1e-4);
  ASSERT_THAT(run.parameters, SizeIs(4));
  run.parameters[2] = 0;  // no dry friction
  const Trends trends = TrendsOf(run, ModelOptions("viscous"));
  ASSERT_THAT(trends.found.trends, SizeIs(2)) << trends.reason;
  EXPECT_EQ(trends.found.trends[1].name, "viscous");
  EXPECT_THAT(trends.found.trends[1].slope, Gt(0));
  EXPECT_THAT(trends.found.trends[1].p, Lt(1e-6));
  for (const AmplitudeRow& row : trends.found.windows) {
    const double expected = kViscous0 + 8 / (3 * kPi) * drag * row.amplitude / std::sqrt(kInertia0);
    EXPECT_THAT(row.friction, DoubleNear(expected, 0.02 * expected));
  }
}

// One of the two friction parameters is held at the whole fit's estimate, and all windows share its error. Slopes over
// their standard errors must have a variance of 1: for 40 runs 0.52 to 1.67 in 99 of 100 cases (χ² of 40). Of 80 tests
// at p < 0.05, more than 10 alarms happen once in 500 times (binomial).
TEST(CompareWindows, HasErrorsThatMatchTheScatterOfSlopes) {
  std::vector<double> variance = {0, 0};
  int alarms = 0;
  SyntheticOptions run = RunOf("coulomb", 0.002);
  run.sample_rate = 40;
  for (run.seed = 1; run.seed <= 40; ++run.seed) {
    const Trends trends = TrendsOf(run, ModelOptions("coulomb"));
    ASSERT_THAT(trends.found.trends, SizeIs(2)) << trends.reason;
    for (std::size_t i = 0; i < 2; ++i) {
      variance[i] += std::pow(trends.found.trends[i].slope / trends.found.trends[i].slope_std_error, 2) / 40;
      alarms += trends.found.trends[i].p < 0.05 ? 1 : 0;
    }
  }
  EXPECT_THAT(variance, Each(AllOf(Ge(0.52), Le(1.67))));
  EXPECT_THAT(alarms, Le(10));
}

// Friction near 0: many windows' estimates are at the bound 0. The estimates without bounds average to the true value
// over 20 recordings.
TEST(CompareWindows, IgnoresTheBoundOfFriction) {
  SyntheticOptions run = RunOf("viscous", 0.002);
  run.parameters[1] = 1e-5;
  std::vector<double> friction;
  for (run.seed = 1; run.seed <= 20; ++run.seed) {
    for (const AmplitudeRow& row : TrendsOf(run, ModelOptions("viscous")).found.windows) {
      if (std::isnan(row.friction)) continue;  // the whole fit's friction is at its bound
      friction.push_back((row.friction - 1e-5) / row.friction_std_error);
    }
  }
  ASSERT_THAT(friction, SizeIs(Gt(50u)));
  EXPECT_THAT(*std::ranges::min_element(friction), Lt(-1.5));
  EXPECT_THAT(std::accumulate(friction.begin(), friction.end(), 0.0) / static_cast<double>(friction.size()),
              DoubleNear(0, 0.4));  // 3.5 / sqrt(80)
}

TEST(CompareWindows, UsesThreePeriodsPerWindow) {
  const FitOfRun run = FitTo(RunOf("viscous", 0.002), "viscous", {});
  EXPECT_THAT(TrendsOf(run, ModelOptions("viscous"), 18).found.windows, SizeIs(3));
  EXPECT_THAT(TrendsOf(run, ModelOptions("viscous"), 25).found.windows, SizeIs(4));
  const Trends none = TrendsOf(run, ModelOptions("viscous"), 17);
  EXPECT_EQ(none.reason, "17 half swings are too few for windows of three periods; 18 are needed");
  EXPECT_THAT(none.found.windows, IsEmpty());
}

TEST(CompareWindows, UsesAtMostEightWindows) {
  SyntheticOptions run = RunOf("viscous", 0.002);
  run.duration = 50;
  run.sample_rate = 50;
  const FitOfRun fitted = FitTo(run, "viscous", {});
  const Trends trends = TrendsOf(fitted, ModelOptions("viscous"), 70);
  ASSERT_THAT(trends.found.windows, SizeIs(8)) << trends.reason;
  for (std::size_t w = 1; w < 8; ++w)
    EXPECT_THAT(trends.found.windows[w].from, DoubleNear(trends.found.windows[w - 1].to + 0.02, 1e-9));
}

TEST(CompareWindows, TestsFreeParametersOnly) {
  const Recording recording = Must(SimulateRecording(RunOf("viscous", 0.002)));
  FitOptions options = ModelOptions("viscous");
  options.fixed = {{"viscous", kViscous0}};
  const Trends trends = TrendsOf(FitTo(recording, options), options);
  EXPECT_THAT(trends.found.trends, ElementsAre(Field(&AmplitudeTrend::name, "inertia")));
  for (const AmplitudeRow& row : trends.found.windows) EXPECT_TRUE(std::isnan(row.friction));
  options.fixed.emplace("inertia", kInertia0);
  EXPECT_THAT(TrendsOf(FitTo(recording, options), options).reason, HasSubstr("there is no trend to test"));
}

// The zero moves by 0.02 rad. Windows that all started at a zero of 0.012 rad would give other values of inertia and
// friction.
TEST(CompareWindows, IncludesADriftingZero) {
  Recording recording = Must(SimulateRecording(RunOf("viscous", 0.002)));
  recording.value += 0.001 * recording.time;
  FitOptions options = ModelOptions("viscous");
  options.initial = {{"zero_drift", 0.0}};
  const Trends trends = TrendsOf(FitTo(recording, options), options);
  EXPECT_THAT(trends.found.trends, AllOf(SizeIs(2), Each(Field(&AmplitudeTrend::p, Gt(kNotConstant)))));
  for (const AmplitudeRow& row : trends.found.windows) {
    EXPECT_THAT(row.inertia, DoubleNear(kInertia0, 4 * row.inertia_std_error));
    EXPECT_THAT(row.friction, DoubleNear(kViscous0, 4 * row.friction_std_error));
  }
}

// The reading stays constant for four half swings of the second window.
TEST(CompareWindows, NamesTheWindowWithoutAFit) {
  FitOfRun run = FitTo(RunOf("viscous", 0.002), "viscous", {});
  const std::vector<double> ends = FirstEnds(run.recording, 24);
  Recording spoiled = run.recording;
  for (Eigen::Index i = 0; i < spoiled.size(); ++i)
    if (spoiled.time[i] > ends[7] && spoiled.time[i] < ends[11]) spoiled.value[i] = spoiled.value[0];
  Constancy found;
  const Parts parts(spoiled, run.fit, ModelOptions("viscous"));
  const std::string reason = CompareWindows(spoiled, parts, ends, run.fit, ModelOptions("viscous"), found);
  EXPECT_THAT(reason, HasSubstr("the fit to window 2 of 4 did not converge: "));
  EXPECT_THAT(found.trends, IsEmpty());
}

}  // namespace
}  // namespace pendulum::amplitude_trend_test
