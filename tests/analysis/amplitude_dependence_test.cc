// SPDX-License-Identifier: Apache-2.0
// Recordings of a rig whose torque is G θ, fitted with G sin θ: their inertia falls with amplitude.
#include "pendulum/analysis/amplitude_dependence.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/parallel.h"
#include "pendulum/closed_form/period.h"
#include "tests/analysis/joint_runs.h"

namespace pendulum::amplitude_dependence_test {
namespace {

using testing::DoubleNear;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;
using testing::Not;

const std::vector<std::string> kShared = {"inertia", "viscous", "coulomb"};
constexpr double kInertiaTruth = 0.079;  // kg m²

FitOptions RigOptions(std::string_view model = "coulomb") {
  FitOptions options = ModelOptions(model);
  options.interval = IntervalMethod::kCovariance;
  options.rig = Rig{{kTextbookTorque, 0}, {}, {}};
  return options;
}

/// Five releases from 0.25 to 0.53 rad.
std::vector<SyntheticOptions> FiveRuns(std::uint64_t seed, double noise, Gravity gravity) {
  std::vector<SyntheticOptions> runs = SeveralRuns(5, seed);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    runs[k].release_angle = 0.25 + 0.07 * static_cast<double>(k);
    runs[k].noise = noise;
    runs[k].model.gravity = gravity;
  }
  return runs;
}

/// The same five releases with a torque G θ and noise of 2.5 counts.
std::vector<SyntheticOptions> LinearRuns(std::uint64_t seed) { return FiveRuns(seed, 2.5 * kCount, Gravity::kLinear); }

const AmplitudeDependence* DependenceOf(const Homogeneity& result, const std::string& name) {
  const auto found = std::ranges::find(result.amplitude_dependence, name, &AmplitudeDependence::name);
  return found == result.amplitude_dependence.end() ? nullptr : &*found;
}

// ---- Amplitude dependence present ----------------------------------------------------------------------------------

// The period of a sine torque is P(A) times that of small swings (MODEL.md eq. (6.1)). To get the period of G θ its
// inertia must be I / P(A)². P = 1 + A²/16 + ..., so the slope is -I/8; A⁴ changes it by less than 1 % below half a
// radian.
TEST(AmplitudeDependence, FollowsThePeriodForALinearTorque) {
  for (const std::uint64_t seed : {1, 11, 21}) {
    FittedAlone fits(LinearRuns(seed), RigOptions());
    fits.TestConstancies();
    const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
    EXPECT_FALSE(result.agrees());
    const AmplitudeDependence* const inertia = DependenceOf(result, "inertia");
    ASSERT_NE(inertia, nullptr);
    const double error = inertia->slope_std_error;
    EXPECT_THAT(inertia->slope, DoubleNear(-kInertiaTruth / 8, 4 * error + 0.01 * kInertiaTruth / 8));
    EXPECT_THAT(error, Lt(0.03 * kInertiaTruth / 8));
    EXPECT_EQ(inertia->unit, "kg m^2");
    EXPECT_THAT(inertia->p, Lt(1e-6));
    EXPECT_THAT(inertia->rest_p, Gt(0.05));
  }
}

// The span between recordings follows eq. (6.1) at the mean amplitudes of the motion. The estimates weight early swings
// more than these means do, so a difference of a tenth is allowed.
TEST(AmplitudeDependence, HasASpanThatFollowsFromThePeriods) {
  FittedAlone fits(LinearRuns(1), RigOptions());
  fits.TestConstancies();
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  const double expected = std::pow(SineGravity::PeriodRatio(result.amplitudes.back()), -2) -  //
                          std::pow(SineGravity::PeriodRatio(result.amplitudes.front()), -2);
  EXPECT_THAT(DependenceOf(result, "inertia")->span / expected, DoubleNear(1, 0.1));
}

TEST(AmplitudeDependence, FollowsThePeriodWithoutTrendsWithinRecordings) {
  const FittedAlone fits(LinearRuns(1), RigOptions());  // the trends within recordings are unknown
  const Homogeneity result = TestHomogeneity(fits.Runs(), {"inertia"});
  const AmplitudeDependence* const inertia = DependenceOf(result, "inertia");
  ASSERT_NE(inertia, nullptr);
  EXPECT_THAT(inertia->slope / (-kInertiaTruth / 8), DoubleNear(1, 0.1));
  EXPECT_THAT(inertia->p, Lt(0.01));
}

TEST(AmplitudeDependence, IsReportedIfNoRecordingIsAnOutlier) {
  FittedAlone fits(LinearRuns(1), RigOptions());
  fits.TestConstancies();
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_THAT(result.disagreeing, IsEmpty());
  EXPECT_THAT(result.verdict,
              HasSubstr("inertia falls by 1.7 % from the recording with the smallest swings to that with the largest"));
  EXPECT_THAT(result.verdict, HasSubstr("and nothing else differs"));
}

// With less noise the errors of the three larger swings cover the differences that the sine causes, so these three
// agree. The two smaller swings do not agree with them. Amplitude explains all five, so no recording is to be left out.
TEST(AmplitudeDependence, IsReportedIfItExplainsTheDisagreement) {
  FittedAlone fits(FiveRuns(1, 0.002, Gravity::kLinear), RigOptions());
  fits.TestConstancies();
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  const AmplitudeDependence* const inertia = DependenceOf(result, "inertia");
  ASSERT_NE(inertia, nullptr);
  EXPECT_THAT(inertia->p, Lt(1e-6));
  EXPECT_THAT(inertia->rest_p, Gt(0.05));
  EXPECT_THAT(result.verdict, HasSubstr("inertia falls by 1.7 %"));
  EXPECT_THAT(result.verdict, Not(HasSubstr("fit the others without")));
}

// ---- Amplitude dependence absent -----------------------------------------------------------------------------------

TEST(AmplitudeDependence, DoesNotExplainInertiaThatScatters) {
  std::vector<SyntheticOptions> runs = FiveRuns(31, 0.002, Gravity::kSine);
  const double factors[] = {1.01, 0.99, 0.995, 0.985, 1.012};  // almost independent of amplitude: a correlation of 0.08
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].parameters[0] *= factors[k];
  FittedAlone fits(runs, RigOptions());
  fits.TestConstancies();
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_FALSE(result.agrees());
  const AmplitudeDependence* const inertia = DependenceOf(result, "inertia");
  ASSERT_NE(inertia, nullptr);
  EXPECT_THAT(inertia->p, Gt(0.05));
  EXPECT_THAT(inertia->rest_p, Lt(1e-6));
  EXPECT_THAT(result.verdict, Not(HasSubstr("smallest swings")));
  EXPECT_THAT(result.verdict, HasSubstr("inertia scatters by"));
}

// The true rate of false alarms is at most p. Of 40 sets at p < 0.05, more than 7 alarms happen once in 700 times; one
// alarm below 0.001 happens once in 25.
TEST(AmplitudeDependence, IsRarelyFoundInRunsOfOneRig) {
  constexpr int kSets = 40;
  std::vector<double> p(kSets, 1.0);
  ParallelFor(kSets, 0, [&](int i) {
    FittedAlone fits(FiveRuns(static_cast<std::uint64_t>(1000 + 5 * i), 0.002, Gravity::kSine), RigOptions());
    fits.TestConstancies();
    const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
    if (const auto* const inertia = DependenceOf(result, "inertia")) p[static_cast<std::size_t>(i)] = inertia->p;
  });
  EXPECT_LE(std::ranges::count_if(p, [](double one) { return one < 0.05; }), 7);
  EXPECT_LE(std::ranges::count_if(p, [](double one) { return one < 0.001; }), 1);
  EXPECT_LT(std::ranges::count(p, 1.0), 5);  // nearly all sets were tested
}

// ---- Fit of a line to numbers --------------------------------------------------------------------------------------

/// A parameter with these values and standard errors, as TestHomogeneity gives it for runs without windows.
SharedParameter Numbers(const std::vector<double>& value, const std::vector<double>& error) {
  SharedParameter parameter;
  parameter.name = "inertia";
  parameter.unit = "s^2";
  double weights = 0;
  for (std::size_t k = 0; k < value.size(); ++k) {
    parameter.runs.push_back({value[k], error[k], {}});
    weights += 1 / (error[k] * error[k]);
    parameter.mean += value[k] / (error[k] * error[k]);
  }
  parameter.mean /= weights;
  return parameter;
}

/// Only the number of these runs matters; their data is not used.
std::optional<AmplitudeDependence> TestNumbers(const std::vector<double>& value, const std::vector<double>& error,
                                               const std::vector<double>& amplitudes) {
  const FittedAlone fits(std::vector<SyntheticOptions>(value.size(), NoisyRun()), ModelOptions("coulomb"));
  return TestAmplitudeDependence(fits.Runs(), Numbers(value, error), amplitudes);
}

// Weighted straight line of values 1, 3, 2 at x = 1, 2, 3 with errors 1: slope 1/2 with error 1/√2. The residuals are
// -1/2, 1, -1/2, so χ² is 1.5 for one degree of freedom, and the error grows by its root. F = (2 - 1.5) / 1.5 = 1/3 has
// p = 2/3 under F(1, 1), because F(1,1) = (2/π) atan √F. χ²(1) above 1.5 has the probability 0.22067.
TEST(AmplitudeDependence, IsAStraightLineInAmplitudeSquared) {
  const auto line = TestNumbers({1, 3, 2}, {1, 1, 1}, {1, std::sqrt(2.0), std::sqrt(3.0)});
  ASSERT_TRUE(line);
  EXPECT_THAT(line->slope, DoubleNear(0.5, 1e-12));
  EXPECT_THAT(line->slope_std_error, DoubleNear(std::sqrt(0.75), 1e-12));
  EXPECT_THAT(line->p, DoubleNear(2.0 / 3, 1e-12));
  EXPECT_THAT(line->span, DoubleNear(0.5, 1e-12));  // twice the slope over a mean of 2
  EXPECT_THAT(line->rest_p, DoubleNear(0.22067, 1e-5));
}

TEST(AmplitudeDependence, IsNotTestedWithTwoRecordingsOrOneAmplitude) {
  EXPECT_FALSE(TestNumbers({1, 2}, {1, 1}, {1, 2}));
  EXPECT_FALSE(TestNumbers({1, 2, 3}, {1, 1, 1}, {2, 2, 2}));
}

// ---- Amplitude of a motion -----------------------------------------------------------------------------------------

// Linear torque and viscous friction: A e^(-γ t), γ = b / 2 I, from the release at 1.9 s to the last sample at 19.99 s.
TEST(MeanAmplitude, IsTheRmsOfADecayingSwing) {
  const FittedAlone fits({ReleasedRun("linear", 0.3, 1)}, RigOptions("linear"));
  const double decay = 2 * (0.003 / (2 * kInertiaTruth)) * (19.99 - 1.9);
  const double expected = 0.3 * std::sqrt((1 - std::exp(-decay)) / decay);
  EXPECT_THAT(MeanAmplitude(fits.RecordingOf(0), fits.Fit(0), fits.options()) / expected, DoubleNear(1, 5e-3));
}

TEST(MeanAmplitude, IsNaNWithoutAFit) {
  FittedAlone fits({ReleasedRun("linear", 0.3, 1)}, RigOptions("linear"));
  fits.Fit(0).termination = Termination::kFailed;
  EXPECT_TRUE(std::isnan(MeanAmplitude(fits.RecordingOf(0), fits.Fit(0), fits.options())));
}

// 0.3 counts are no angle.
TEST(MeanAmplitude, IsNaNForAMotionInCounts) {
  FittedAlone fits({ReleasedRun("linear", 0.3, 1)}, RigOptions("linear"));
  for (ParameterEstimate& parameter : fits.Fit(0).parameters) {
    if (parameter.unit == "rad") parameter.unit = "counts";
  }
  EXPECT_TRUE(std::isnan(MeanAmplitude(fits.RecordingOf(0), fits.Fit(0), fits.options())));
}

}  // namespace
}  // namespace pendulum::amplitude_dependence_test
