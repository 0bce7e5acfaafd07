// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/cramer_rao.h"
#include "pendulum/closed_form/half_swing_map.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::plan_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Eq;
using testing::HasSubstr;

constexpr double kFrequency = 5;  // rad/s
constexpr double kInertiaOverTorque = 1 / (kFrequency * kFrequency);

/// A swing that begins with the recording: 40 s at 100 Hz with white noise, 32 periods.
SyntheticOptions LightRun(std::string_view model, double viscous = 0) {
  SyntheticOptions run;
  run.model = Must(FindMotionModel(model));
  run.parameters = {kInertiaOverTorque, viscous};
  run.release_angle = 0.05;
  run.duration = 40;
  run.noise = 1e-3;
  return run;
}

/// The rows of one factor.
std::vector<PlanRow> Rows(const Plan& plan, std::string_view factor) {
  std::vector<PlanRow> rows;
  std::ranges::copy_if(plan.rows, std::back_inserter(rows), [&](const PlanRow& row) { return row.factor == factor; });
  return rows;
}

std::vector<double> Values(const Plan& plan, std::string_view factor) {
  std::vector<double> values;
  for (const PlanRow& row : Rows(plan, factor)) values.push_back(row.value);
  return values;
}

/// Ratios of the standard errors of parameter i between successive rows of a factor.
std::vector<double> Steps(const Plan& plan, std::string_view factor, std::size_t i) {
  const std::vector<PlanRow> rows = Rows(plan, factor);
  std::vector<double> steps;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    steps.push_back(rows[k].std_errors.at(i).value() / rows[k - 1].std_errors.at(i).value());
  }
  return steps;
}

const PlanRow& Base(const Plan& plan) { return *std::ranges::find_if(plan.rows, &PlanRow::is_base); }

std::vector<double> Errors(const PlanRow& row) {
  std::vector<double> errors;
  for (const std::optional<double>& error : row.std_errors) errors.push_back(error.value());
  return errors;
}

std::vector<double> BaseErrors(const SyntheticOptions& run) {
  const Plan plan = Must(MakePlan(run));
  return Errors(Base(plan));
}

double Bias(const SyntheticOptions& run) { return LinearInertiaBias(run, run.start_time + run.duration).value(); }

/// Squared ratio of an undamped pendulum's period to its small-angle period, minus 1.
double PeriodExcess(double amplitude) {
  const double ratio = 2 / kPi * std::comp_ellint_1(std::sin(0.5 * amplitude));
  return ratio * ratio - 1;
}

/// Smallest relative standard error of inertia: twice that of the frequency of a sinusoid in white noise over many
/// periods (S. M. Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, example 3.14).
double SinusoidError(const SyntheticOptions& run, double amplitude) {
  const double count = run.duration * run.sample_rate;
  return 2 * std::sqrt(24 / count) * run.noise / (amplitude * run.duration * kFrequency);
}

TEST(MakePlan, VariesOneFactorAtATime) {
  SyntheticOptions run = LightRun("viscous");
  run.release_angle = -0.4;
  run.resolution = 0.001;
  const Plan plan = Must(MakePlan(run));
  EXPECT_THAT(Values(plan, "release_angle"), ElementsAre(0.1, 0.2, 0.4, 0.8));
  EXPECT_THAT(Values(plan, "duration"), ElementsAre(20, 40, 80, 160));
  EXPECT_THAT(Values(plan, "rate"), ElementsAre(25, 100, 400));
  EXPECT_THAT(Values(plan, "resolution"), ElementsAre(0.00025, 0.001, 0.004));
  EXPECT_EQ(plan.rows.size(), 14);
  EXPECT_EQ(std::ranges::count_if(plan.rows, &PlanRow::is_base), 4);
  EXPECT_THAT(Base(plan).std_errors, Eq(CramerRaoBounds(run, Must(SimulateRecording(run)).time)));
  EXPECT_EQ(plan.truth, Truth(run));
  EXPECT_EQ(plan.parameters.size(), 5);
  EXPECT_EQ(plan.physical, 2);
}

// A range that cuts off one side gives different results for releases on the two sides.
TEST(MakePlan, HasRowsEqualToThePlansOfTheChangedRuns) {
  SyntheticOptions run = LightRun("viscous", 0.001);
  run.release_angle = -0.4;
  run.duration = 3;
  run.resolution = 0.001;
  run.range = SensorRange{-0.1, 1};
  const Plan plan = Must(MakePlan(run));
  SyntheticOptions closer = run, longer = run, faster = run, coarser = run;
  closer.release_angle = -0.1;
  longer.duration = 12;
  faster.sample_rate = 400;
  coarser.resolution = 0.004;
  EXPECT_EQ(Errors(Rows(plan, "release_angle").front()), BaseErrors(closer));
  EXPECT_EQ(Errors(Rows(plan, "duration").back()), BaseErrors(longer));
  EXPECT_EQ(Errors(Rows(plan, "rate").back()), BaseErrors(faster));
  EXPECT_EQ(Errors(Rows(plan, "resolution").back()), BaseErrors(coarser));
}

TEST(MakePlan, LimitsTheAmplitudesOfItsRows) {
  SyntheticOptions run = LightRun("viscous", 0.001);
  run.duration = 10;
  run.release_angle = 2;
  EXPECT_THAT(Values(Must(MakePlan(run)), "release_angle"), ElementsAre(0.5, 1, 2, 2.5));
  run.release_angle = 2.7;
  EXPECT_THAT(Values(Must(MakePlan(run)), "release_angle"), ElementsAre(0.675, 1.35, 2.7));
}

TEST(MakePlan, OmitsTheResolutionFactorWithoutAResolution) {
  EXPECT_THAT(Values(Must(MakePlan(LightRun("viscous"))), "resolution"), ElementsAre());
}

// Readings of a linear pendulum are the amplitude times a function of I and b, plus the zero.
TEST(MakePlan, HalvesTheErrorOfInertiaWhenTheAmplitudeDoubles) {
  const Plan plan = Must(MakePlan(LightRun("linear", 0.001)));
  EXPECT_THAT(Steps(plan, "release_angle", 0), Each(DoubleNear(0.5, 1e-6)));
  EXPECT_THAT(Steps(plan, "release_angle", 1), Each(DoubleNear(0.5, 1e-6)));
  EXPECT_THAT(Steps(plan, "release_angle", 2), Each(DoubleNear(1, 1e-6)));  // the error of the release angle stays
}

// For 16, 32, 64 and 128 whole periods; with fewer the ends of the sinusoid matter.
TEST(MakePlan, GivesTheErrorOfASinusoidsFrequency) {
  const SyntheticOptions run = LightRun("linear");
  const Plan plan = Must(MakePlan(run));
  EXPECT_THAT(Base(plan).std_errors[0].value() / kInertiaOverTorque / SinusoidError(run, run.release_angle),
              DoubleNear(1, 0.01));
  EXPECT_THAT(Steps(plan, "duration", 0), Each(DoubleNear(std::pow(2, -1.5), 0.01)));
  EXPECT_THAT(Steps(plan, "rate", 0), Each(DoubleNear(0.5, 0.005)));
}

// If noise is larger than the levels, they add a variance of q²/12 (Widrow & Kollár); levels are 1/4, 1 and 4 of half
// the noise.
TEST(MakePlan, PredictsErrorsThatGrowWithTheResolution) {
  SyntheticOptions run = LightRun("linear");
  run.resolution = 0.5 * run.noise;
  const auto noise = [](double resolution) { return std::sqrt(1 + resolution * resolution / 12); };
  EXPECT_THAT(Steps(Must(MakePlan(run)), "resolution", 0),
              ElementsAre(DoubleNear(noise(0.5) / noise(0.125), 1e-3), DoubleNear(noise(2) / noise(0.5), 0.02)));
}

TEST(MakePlan, TreatsQuantizationWithoutNoiseAsWhiteNoise) {
  SyntheticOptions levels = LightRun("viscous", 0.001);
  levels.noise = 0;
  levels.resolution = kCount;
  levels.noise_correlation = 0.5;  // correlation without noise
  SyntheticOptions noisy = levels;
  noisy.noise = kCount / std::sqrt(12.0);
  noisy.resolution = noisy.noise_correlation = 0;
  EXPECT_EQ(BaseErrors(levels), BaseErrors(noisy));
  EXPECT_EQ(Must(MakePlan(levels)).noise_of_levels, noisy.noise);
  EXPECT_EQ(Must(MakePlan(noisy)).noise_of_levels, std::nullopt);
}

TEST(MakePlan, CountsAHoldWithoutNoiseAsOneReading) {
  SyntheticOptions run = TextbookRun("viscous");
  run.resolution = kCount;
  const std::vector<double> with_short_hold = BaseErrors(run);
  run.release_time += 10;
  run.duration += 10;
  const std::vector<double> with_long_hold = BaseErrors(run);
  for (std::size_t i = 0; i < with_long_hold.size(); ++i) {
    EXPECT_THAT(with_long_hold[i] / with_short_hold[i], DoubleNear(1, 1e-6)) << i;
  }
}

/// |bias| of the linear formulas over the standard error of inertia, at the amplitude where the plan says they are
/// equal.
double BiasOverErrorWhereEqual(SyntheticOptions run) {
  run.release_angle = Must(MakePlan(run)).amplitude_of_equal_bias.value();
  const Plan there = Must(MakePlan(run));
  return std::abs(Base(there).linear_bias.value()) / (Base(there).std_errors[0].value() / run.parameters[0]);
}

// Bias over error grows as the amplitude cubed. The plan's amplitude is accurate to 1e-4, so the ratio is 1 within
// 3e-4.
TEST(MakePlan, FindsTheAmplitudeWhereBiasEqualsTheError) {
  for (const std::string_view model : {"viscous", "drag"}) {
    SyntheticOptions run = TextbookRun(model);
    run.noise = 0.02;
    EXPECT_THAT(BiasOverErrorWhereEqual(run), DoubleNear(1, 1e-3)) << model;
  }
}

// Below some amplitude dry friction leaves less than a whole period. Just above it the bias is already larger than the
// error, so the plan gives this amplitude.
TEST(MakePlan, FindsTheSmallestAmplitudeThatLeavesAWholePeriod) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.noise = 1e-5;
  const double amplitude = Must(MakePlan(run)).amplitude_of_equal_bias.value();
  run.release_angle = 0.999 * amplitude;
  EXPECT_EQ(LinearInertiaBias(run, 20), std::nullopt);
  run.release_angle = 1.001 * amplitude;
  EXPECT_LT(LinearInertiaBias(run, 20).value(), -0.01);
}

// A²/8 = SinusoidError(A), which is proportional to 1/A.
TEST(MakePlan, FindsTheAmplitudeForAnUndampedPendulum) {
  const SyntheticOptions run = LightRun("viscous");
  const double expected = std::cbrt(8 * SinusoidError(run, 1));
  EXPECT_THAT(Must(MakePlan(run)).amplitude_of_equal_bias.value() / expected, DoubleNear(1, 0.01));
}

TEST(MakePlan, FindsNoAmplitudeWhereBiasEqualsTheErrorForALinearPendulum) {
  EXPECT_EQ(Must(MakePlan(LightRun("linear", 0.001))).amplitude_of_equal_bias, std::nullopt);
}

TEST(MakePlan, ScalesAMovingStartAtTheSamePhase) {
  SyntheticOptions run = LightRun("viscous");
  run.start = StartKind::kMoving;
  run.initial_angle = -0.3;
  run.initial_rate = 2;
  const Plan plan = Must(MakePlan(run));
  const double amplitude = 2 * std::asin(std::hypot(std::sin(0.15), 2 / (2 * kFrequency)));
  EXPECT_THAT(Values(plan, "amplitude"), ElementsAre(DoubleNear(amplitude / 4, 1e-12), DoubleNear(amplitude / 2, 1e-12),
                                                     DoubleNear(amplitude, 1e-12), DoubleNear(2 * amplitude, 1e-12)));
  for (const PlanRow& row : Rows(plan, "amplitude")) {
    EXPECT_THAT(row.linear_bias.value(), DoubleNear(PeriodExcess(row.value), 1e-8)) << row.value;
  }
}

TEST(MakePlan, ScalesAngleAndRateOfALinearMovingStart) {
  SyntheticOptions run = LightRun("linear", 0.001);
  run.start = StartKind::kMoving;
  run.initial_angle = 0.3;
  run.initial_rate = 2;
  const Plan plan = Must(MakePlan(run));
  EXPECT_THAT(Values(plan, "amplitude")[2], DoubleNear(0.5, 1e-12));  // hypot(0.3, 0.4), 0.4 = 2 / ω0
  EXPECT_THAT(Steps(plan, "amplitude", 0), Each(DoubleNear(0.5, 1e-6)));
}

TEST(MakePlan, HasNoAmplitudesForATumblingPendulum) {
  SyntheticOptions run = LightRun("viscous", 0.001);
  run.start = StartKind::kMoving;
  run.initial_rate = 2.1 * kFrequency;  // goes over the top above 2 ω0
  const Plan plan = Must(MakePlan(run));
  EXPECT_THAT(Values(plan, "amplitude"), ElementsAre());
  EXPECT_EQ(plan.amplitude_of_equal_bias, std::nullopt);
  EXPECT_EQ(Base(plan).linear_bias, std::nullopt);
}

TEST(MakePlan, NamesTheParametersAndTheUnitOfARate) {
  SyntheticOptions run = LightRun("viscous", 0.001);
  run.quantity = Quantity::kRate;
  run.resolution = 0.01;
  const Plan plan = Must(MakePlan(run));
  EXPECT_EQ(plan.parameters.back().name, "rate_bias");
  EXPECT_EQ(Rows(plan, "resolution").front().unit, "rad/s");
}

TEST(MakePlan, ExplainsARowWithoutARecording) {
  SyntheticOptions run = LightRun("viscous");
  run.release_time = 25;
  const PlanRow half = Rows(Must(MakePlan(run)), "duration").front();
  EXPECT_THAT(half.std_errors, ElementsAre(std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt));
  EXPECT_EQ(half.linear_bias, std::nullopt);
  EXPECT_THAT(half.reason, HasSubstr("the release at 25 s comes after the last sample"));
}

TEST(MakePlan, HasNoErrorsWithoutACramerRaoBound) {
  SyntheticOptions run = LightRun("viscous");
  run.noise_freedom = 3;
  run.resolution = 0.001;
  const Plan plan = Must(MakePlan(run));
  EXPECT_THAT(Base(plan).std_errors, Each(Eq(std::nullopt)));
  EXPECT_THAT(Base(plan).linear_bias.value(), DoubleNear(PeriodExcess(run.release_angle), 1e-8));
  EXPECT_EQ(plan.amplitude_of_equal_bias, std::nullopt);
}

TEST(MakePlan, NeedsNoiseOrAResolution) {
  SyntheticOptions run = LightRun("viscous");
  run.noise = 0;
  const Result<Plan> plan = MakePlan(run);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(plan.error().message(), HasSubstr("noise and resolution are both 0"));
}

TEST(MakePlan, NeedsARecording) {
  SyntheticOptions run = LightRun("viscous");
  run.release_time = 50;
  const Result<Plan> late = MakePlan(run);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, StatusCode::kFailedPrecondition);
  run.duration = -1;
  const Result<Plan> wrong = MakePlan(run);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, StatusCode::kInvalidArgument);
}

TEST(LinearInertiaBias, IsTheSquareOfThePeriodsRatioWithoutFriction) {
  for (const double amplitude : {0.01, 0.1, 0.423, 1.0, 2.0}) {
    SyntheticOptions run = LightRun("viscous");
    run.release_angle = amplitude;
    EXPECT_THAT(Bias(run) / PeriodExcess(amplitude), DoubleNear(1, 1e-5)) << amplitude;  // 1e-10 of the inertia
  }
  EXPECT_THAT(PeriodExcess(0.1) / (0.1 * 0.1 / 8), DoubleNear(1, 1e-2));  // the textbook's approximation
}

// The formulas are exact for a linear pendulum with viscous friction, even if it is strongly damped.
TEST(LinearInertiaBias, IsZeroForALinearPendulumWithViscousFriction) {
  for (const double damping_ratio : {0.0, 0.004, 0.3}) {
    EXPECT_THAT(Bias(LightRun("linear", 2 * damping_ratio / kFrequency)), DoubleNear(0, 1e-10)) << damping_ratio;
  }
}

// Dry friction does not change the period of a linear pendulum and reduces each turning point by 2 τ_c / G: the bias is
// -ζ².
TEST(LinearInertiaBias, MatchesTheDecrementForDryFrictionAndLinearGravity) {
  SyntheticOptions run = LightRun("coulomb");
  run.model.gravity = Gravity::kLinear;
  run.parameters = {kInertiaOverTorque, 0, 0.001};
  run.release_angle = 0.1;
  run.release_time = 0.5;
  run.duration = 0.5 + 10.2 * 2 * kPi / kFrequency;
  const double decrement = std::log(0.1 / (0.1 - 10 * 0.004)) / 10;
  const double square = decrement * decrement;
  EXPECT_THAT(Bias(run) / (-square / (4 * kPi * kPi + square)), DoubleNear(1, 1e-5));
}

// Sum of the periods at the decreasing amplitudes, computed independently from the half swings.
TEST(LinearInertiaBias, IsTheMeanOverAllPeriodsWithFriction) {
  SyntheticOptions run = TextbookRun("drag");
  const std::vector<double> friction(run.parameters.begin() + 1, run.parameters.end());
  const double frequency = 1 / std::sqrt(run.parameters[0]);
  std::vector<double> amplitudes = {run.release_angle};
  double time = run.release_time;
  for (int half = 0; half < 20; ++half) {
    const auto end = ComputeHalfSwing(run.model, friction, amplitudes.back(), frequency);
    ASSERT_TRUE(end);
    amplitudes.push_back(end->amplitude);
    time += end->duration;
  }
  const double decrement = std::log(amplitudes.front() / amplitudes.back()) / 10;
  const double period = (time - run.release_time) / 10;
  const double expected =
      std::pow(period * frequency, 2) / (4 * kPi * kPi + decrement * decrement) - 1;  // 1 - ζ² = 4π² / (4π² + δ²)
  EXPECT_THAT(LinearInertiaBias(run, time + 0.1).value() / expected, DoubleNear(1, 1e-6));
}

TEST(LinearInertiaBias, NeedsAWholePeriod) {
  const SyntheticOptions run = LightRun("linear");
  const double period = 2 * kPi / kFrequency;
  EXPECT_EQ(LinearInertiaBias(run, 0.999 * period), std::nullopt);
  EXPECT_THAT(LinearInertiaBias(run, 1.001 * period).value(), DoubleNear(0, 1e-10));
}

}  // namespace
}  // namespace pendulum::plan_test
