// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/synthetic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/trajectory/synthetic_support.h"

namespace pendulum::synthetic_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Each;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;
using testing::Not;

/// Small-angle pendulum with viscous friction, in motion from the first sample.
SyntheticOptions LinearPendulum() {
  SyntheticOptions options;
  options.model = {"linear", "viscous", Gravity::kLinear};
  options.parameters = {0.04, 0.002};  // ω_n = 5 rad/s, ζ = 0.005
  options.start = StartKind::kMoving;
  options.initial_angle = 0.3;
  options.initial_rate = -0.7;
  return options;
}

/// θ and θ' of LinearPendulum at t s after its first sample: the damped oscillation of the textbooks.
std::pair<double, double> LinearSolution(double t) {
  const double natural = 5.0, zeta = 0.005;
  const double damped = natural * std::sqrt(1 - zeta * zeta), decay = zeta * natural;
  const double p = 0.3, q = (-0.7 + decay * 0.3) / damped;
  const double c = std::cos(damped * t), s = std::sin(damped * t), envelope = std::exp(-decay * t);
  return {envelope * (p * c + q * s), envelope * ((q * damped - decay * p) * c - (p * damped + decay * q) * s)};
}

/// Time and height of each maximum above `least`, from the parabola through its three highest samples.
std::vector<std::pair<double, double>> Peaks(const Recording& recording, double least) {
  std::vector<std::pair<double, double>> peaks;
  const Eigen::VectorXd& y = recording.value;
  for (Eigen::Index i = 1; i + 1 < recording.size(); ++i) {
    if (y[i] < least || y[i] <= y[i - 1] || y[i] < y[i + 1]) continue;
    const double slope = 0.5 * (y[i + 1] - y[i - 1]), curvature = y[i + 1] - 2 * y[i] + y[i - 1];
    const double step = recording.time[i + 1] - recording.time[i];
    peaks.emplace_back(recording.time[i] - step * slope / curvature, y[i] - 0.5 * slope * slope / curvature);
  }
  return peaks;
}

// ---- The motion --------------------------------------------------------------------------------------------------

TEST(SimulateRecording, ReproducesTheTextbookRigsFrequencyAndDamping) {
  const Result<Recording> recording = SimulateRecording(TextbookRig());
  ASSERT_TRUE(recording) << recording.error().message();
  const std::vector<std::pair<double, double>> peaks = Peaks(*recording, 0.05);
  ASSERT_THAT(peaks.size(), Ge(6));
  const double period = (peaks[5].first - peaks[0].first) / 5;
  const double decrement = std::log(peaks[0].second / peaks[5].second) / 5;
  EXPECT_THAT(2 * kPi / period, DoubleNear(4.8, 0.1));                                 // published: about 4.8 rad/s
  EXPECT_THAT(decrement / std::hypot(2 * kPi, decrement), DoubleNear(0.004, 0.0001));  // published: about 0.004
}

TEST(SimulateRecording, IsHeldUntilTheRelease) {
  SyntheticOptions options = TextbookRig();
  options.zero = 0.012;
  const Result<Recording> recording = SimulateRecording(options);
  ASSERT_TRUE(recording) << recording.error().message();
  ASSERT_EQ(recording->size(), 2000);
  EXPECT_EQ(recording->time[0], 0);
  EXPECT_EQ(recording->time[1999], 19.99);
  const std::vector<double> held(recording->value.begin(), recording->value.begin() + 190);
  EXPECT_THAT(held, Each(0.423 + 0.012));
  EXPECT_LT(recording->value[192], 0.423 + 0.012);
}

TEST(SimulateRecording, MayBeReleasedBeforeTheFirstSample) {
  SyntheticOptions early = TextbookRig();
  early.start_time = 5;
  const Result<Recording> whole = SimulateRecording(TextbookRig());
  const Result<Recording> later = SimulateRecording(early);
  ASSERT_TRUE(whole && later);
  EXPECT_THAT(Deviations(later->value.head(1000), whole->value.segment(500, 1000)), Each(DoubleNear(0, 1e-12)));
}

TEST(SimulateRecording, FollowsTheClosedFormOfTheLinearPendulum) {
  SyntheticOptions options = LinearPendulum();
  options.start_time = 100;
  const Result<Recording> angle = SimulateRecording(options);
  options.quantity = Quantity::kRate;
  options.zero = 0.25;
  const Result<Recording> rate = SimulateRecording(options);
  ASSERT_TRUE(angle && rate);
  EXPECT_EQ(angle->unit, "rad");
  EXPECT_EQ(rate->unit, "rad/s");
  EXPECT_EQ(angle->value[0], 0.3);
  EXPECT_EQ(rate->value[0], -0.7 + 0.25);
  for (Eigen::Index i = 0; i < angle->size(); ++i) {
    const auto [expected_angle, expected_rate] = LinearSolution(angle->time[i] - 100);
    ASSERT_THAT(angle->value[i], DoubleNear(expected_angle, 1e-12)) << "sample " << i;
    ASSERT_THAT(rate->value[i], DoubleNear(expected_rate + 0.25, 1e-11)) << "sample " << i;
  }
}

// sin(θ/2) = k cd(ω0 t, k), k = sin(A/2): Abramowitz & Stegun, Handbook of Mathematical Functions, chapter 16.
TEST(SimulateRecording, FollowsTheEllipticFunctionsOfTheUndampedPendulum) {
  for (const double amplitude : {0.423, 1.5, 2.5}) {
    SyntheticOptions options;
    options.model = {"viscous", "viscous", Gravity::kSine};
    options.parameters = {0.04, 0};
    options.release_angle = amplitude;
    const Result<Recording> recording = SimulateRecording(options);
    ASSERT_TRUE(recording) << recording.error().message();
    const double modulus = std::sin(amplitude / 2);
    for (Eigen::Index i = 0; i < recording->size(); ++i) {
      const double expected = 2 * std::asin(modulus * boost::math::jacobi_cd(modulus, 5 * recording->time[i]));
      ASSERT_THAT(recording->value[i], DoubleNear(expected, 2e-12)) << "amplitude " << amplitude << ", sample " << i;
    }
  }
}

// Dry friction alone reduces the amplitude of the linear pendulum by 2 τ_c/G per half swing: 0.43, -0.37, ..., 0.07,
// -0.01. At the last angle |θ| < τ_c/G = 0.03, and friction holds the pendulum.
TEST(SimulateRecording, StopsAtTheEndOfTheDryFrictionStaircase) {
  SyntheticOptions options;
  options.model = {"coulomb", "coulomb", Gravity::kLinear};
  options.parameters = {0.04, 0, 0.03};
  options.release_angle = 0.43;
  options.zero = 0.5;
  const Result<Recording> recording = SimulateRecording(options);
  ASSERT_TRUE(recording) << recording.error().message();
  // Seven half swings of π/ω_n = π/5 s each.
  const auto first_at_rest = static_cast<Eigen::Index>(std::ceil(100 * 7 * kPi / 5));
  const Eigen::VectorXd rest = recording->value.tail(recording->size() - first_at_rest);
  EXPECT_THAT(std::vector<double>(rest.begin(), rest.end()), Each(DoubleNear(0.5 - 0.01, 1e-12)));
  EXPECT_THAT(recording->value[first_at_rest - 10], Not(DoubleNear(0.5 - 0.01, 1e-3)));
}

// ---- The sensor --------------------------------------------------------------------------------------------------

TEST(SensorReading, IsUnchangedWithoutLevelsAndRange) { EXPECT_EQ(SensorReading(0.123, 0, {}), 0.123); }

TEST(SensorReading, RoundsToTheNearestMultipleWithoutARange) {
  EXPECT_EQ(SensorReading(0.37, 0.25, {}), 0.25);
  EXPECT_EQ(SensorReading(0.38, 0.25, {}), 0.5);
  EXPECT_EQ(SensorReading(-0.38, 0.25, {}), -0.5);
}

TEST(SensorReading, AnchorsItsLevelsAtTheLowEndOfTheRange) {
  const SensorRange range = {-0.625, 0.625};
  EXPECT_EQ(SensorReading(0.01, 0.25, range), 0.125);
  EXPECT_EQ(SensorReading(-0.01, 0.25, range), -0.125);
}

TEST(SensorReading, SaturatesAtTheOutermostLevelsOfTheRange) {
  const SensorRange range = {-0.5, 0.6};
  EXPECT_EQ(SensorReading(-7, 0.25, range), -0.5);
  EXPECT_EQ(SensorReading(7, 0.25, range), 0.5);
  EXPECT_EQ(SensorReading(7, 0, range), 0.6);
}

// 1023 steps of 0.1985 deg from -49.6077 deg end at 153.4578 deg, but not exactly in binary arithmetic.
TEST(SensorReading, ReachesTheTopOfARangeOfWholeLevelsDespiteRounding) {
  for (const double unit : {1.0, kRadFromDeg}) {
    const SensorRange range = {-49.6077 * unit, 153.4578 * unit};
    EXPECT_THAT(SensorReading(7e3, 0.1985 * unit, range), DoubleNear(153.4578 * unit, 1e-9 * unit));
  }
}

TEST(SimulateRecording, ShowsOnlyLevelsWithinTheRange) {
  SyntheticOptions options = TextbookRig();
  const double step = 0.1985 * kRadFromDeg;
  options.resolution = step;
  options.noise = 3 * step;
  options.range = SensorRange{-15 * kRadFromDeg, -15 * kRadFromDeg + 180 * step};
  const Result<Recording> recording = SimulateRecording(options);
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_EQ(recording->resolution, step);
  int at_the_bottom = 0;
  int at_the_top = 0;
  for (const double value : recording->value) {
    const double level = (value - options.range->low) / step;
    ASSERT_THAT(level, DoubleNear(std::round(level), 1e-9));
    ASSERT_THAT(std::round(level), AllOf(Ge(0), Le(180)));
    at_the_bottom += std::round(level) == 0 ? 1 : 0;
    at_the_top += std::round(level) == 180 ? 1 : 0;
  }
  EXPECT_THAT(at_the_bottom, Ge(100));  // the swing reaches about -24 deg and is clipped at -15 deg
  EXPECT_THAT(at_the_top, Ge(100));     // the hold at 24.2 deg is clipped at 20.7 deg
}

// ---- Sampling ----------------------------------------------------------------------------------------------------

TEST(SimulateRecording, EvaluatesAJitteredSampleAtItsStamp) {
  SyntheticOptions options = LinearPendulum();
  options.jitter = 0.001;
  const Result<Recording> recording = SimulateRecording(options);
  ASSERT_TRUE(recording) << recording.error().message();
  std::vector<double> offsets;
  for (Eigen::Index i = 1; i < recording->size(); ++i) {
    ASSERT_THAT(recording->value[i], DoubleNear(LinearSolution(recording->time[i]).first, 1e-12)) << "sample " << i;
    offsets.push_back(recording->time[i] - 0.01 * static_cast<double>(i));
  }
  ExpectStandardDeviation(offsets, 0.001);
}

TEST(SimulateRecording, KeepsStampsIncreasingUnderLargeJitter) {
  SyntheticOptions options = LinearPendulum();
  options.jitter = 0.05;
  options.start_time = 3;
  const Result<Recording> recording = SimulateRecording(options);
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_EQ(recording->time[0], 3);
  EXPECT_TRUE(std::is_sorted(recording->time.begin(), recording->time.end(), std::less_equal<>()));
}

TEST(SimulateRecording, IsReproducibleForTheSameSeedOnly) {
  SyntheticOptions options = TextbookRig();
  options.noise = 0.01;
  options.jitter = 0.001;
  const Result<Recording> once = SimulateRecording(options);
  const Result<Recording> again = SimulateRecording(options);
  options.seed = 2;
  const Result<Recording> other = SimulateRecording(options);
  ASSERT_TRUE(once && again && other);
  EXPECT_EQ(once->value, again->value);
  EXPECT_EQ(once->time, again->time);
  EXPECT_NE(once->value, other->value);
  EXPECT_NE(once->time, other->time);
}

TEST(SimulateRecording, KeepsTheNoiseOfASeedUnderJitter) {
  SyntheticOptions options = TextbookRig();
  options.noise = 0.01;
  const Result<Recording> steady = SimulateRecording(options);
  options.jitter = 0.001;
  const Result<Recording> jittered = SimulateRecording(options);
  ASSERT_TRUE(steady && jittered);
  EXPECT_EQ(steady->value.head(180), jittered->value.head(180));  // still held
}

// ---- Invalid options ---------------------------------------------------------------------------------------------

// An encoder that misses edges shows readings shifted by whole levels from then on.
TEST(SimulateRecording, LosesCountsFromAGivenTime) {
  SyntheticOptions options = TextbookRig();
  options.resolution = 0.0078125;  // 2^-7, so sums of levels are exact
  const Recording whole = *SimulateRecording(options);
  options.lost_counts = {{whole.time[700], -3}, {whole.time[1200] - 1e-9, 1}};
  const Recording lost = *SimulateRecording(options);
  const Eigen::VectorXd levels = (lost.value - whole.value) / options.resolution;
  EXPECT_TRUE((levels.head(700).array() == 0).all());
  EXPECT_TRUE((levels.segment(700, 500).array() == -3).all());
  EXPECT_TRUE((levels.tail(levels.size() - 1200).array() == -2).all());
}

struct Refusal {
  StatusCode code;
  std::string message;
  void (*spoil)(SyntheticOptions&);
};

TEST(SimulateRecording, RefusesAndNamesInvalidOptions) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto invalid = StatusCode::kInvalidArgument;
  const auto unusable = StatusCode::kFailedPrecondition;
  const std::vector<Refusal> refusals = {
      {invalid, "no friction law 'tar'", [](SyntheticOptions& o) { o.model.friction = "tar"; }},
      {invalid, "takes 2 parameters, not 0", [](SyntheticOptions& o) { o.parameters.clear(); }},
      {invalid, "inertia is 0; it must be positive", [](SyntheticOptions& o) { o.parameters[0] = 0; }},
      {invalid, "viscous is -1; it must be at least 0", [](SyntheticOptions& o) { o.parameters[1] = -1; }},
      {invalid, "viscous is nan; it must be finite", [](SyntheticOptions& o) { o.parameters[1] = kNan; }},
      {invalid, "release_angle is nan", [](SyntheticOptions& o) { o.release_angle = kNan; }},
      {invalid, "duration is 0; it must be positive", [](SyntheticOptions& o) { o.duration = 0; }},
      {invalid, "sample rate is -5; it must be positive", [](SyntheticOptions& o) { o.sample_rate = -5; }},
      {invalid, "more than 20000000 samples", [](SyntheticOptions& o) { o.duration = 1e300; }},
      {invalid, "jitter is -1; it must be 0 or more", [](SyntheticOptions& o) { o.jitter = -1; }},
      {invalid, "zero_angle is nan", [](SyntheticOptions& o) { o.zero = kNan; }},
      {invalid, "noise is -1; it must be 0 or more", [](SyntheticOptions& o) { o.noise = -1; }},
      {invalid, "noise_correlation is 1; it must be between", [](SyntheticOptions& o) { o.noise_correlation = 1; }},
      {invalid, "noise_correlation is nan", [](SyntheticOptions& o) { o.noise_correlation = kNan; }},
      {invalid, "noise_freedom is 2; it must be 0 or above 2", [](SyntheticOptions& o) { o.noise_freedom = 2; }},
      {invalid, "noise_freedom is -3", [](SyntheticOptions& o) { o.noise_freedom = -3; }},
      {invalid, "noise_freedom is nan", [](SyntheticOptions& o) { o.noise_freedom = kNan; }},
      {invalid, "resolution is nan; it must be finite", [](SyntheticOptions& o) { o.resolution = kNan; }},
      {invalid, "the range is 1 to -1",
       [](SyntheticOptions& o) {
         o.range = {1, -1};
       }},
      {invalid, "no wider than the range",
       [](SyntheticOptions& o) {
         (o.range = {0, 1}, o.resolution = 2);
       }},
      {invalid, "a sensor with discrete levels loses counts; give a resolution",
       [](SyntheticOptions& o) {
         o.lost_counts = {{5, 1}};
       }},
      {invalid, "the time of lost counts is nan",
       [](SyntheticOptions& o) {
         (o.resolution = 0.01, o.lost_counts = {{kNan, 1}});
       }},
      {invalid, "the time of lost counts is 500; it must be before the recording ends",
       [](SyntheticOptions& o) {
         (o.resolution = 0.01, o.lost_counts = {{500, 1}});
       }},
      {unusable, "7 samples; at least 8", [](SyntheticOptions& o) { o.duration = 0.07; }},
      {unusable, "it never moves", [](SyntheticOptions& o) { o.release_angle = 0; }},
      {unusable, "the release at 20 s comes after", [](SyntheticOptions& o) { o.release_time = 20; }},
      {unusable, "cannot be computed", [](SyntheticOptions& o) { o.parameters[0] = 1e-320; }},
  };
  for (const Refusal& refusal : refusals) {
    SyntheticOptions options = TextbookRig();
    refusal.spoil(options);
    const Result<Recording> recording = SimulateRecording(options);
    ASSERT_FALSE(recording) << refusal.message;
    EXPECT_EQ(recording.error().code, refusal.code) << refusal.message;
    EXPECT_THAT(recording.error().message(), HasSubstr(refusal.message));
  }
}

}  // namespace
}  // namespace pendulum::synthetic_test
