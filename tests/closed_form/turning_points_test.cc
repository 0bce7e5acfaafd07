// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_points.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/period.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::turning_points_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kDecay = 0.05;  // 1/s
constexpr double kOmega = 5.0;   // rad/s

double DampedSine(double t) { return std::exp(-kDecay * t) * std::sin(kOmega * t); }

/// The turning points of DampedSine before `end`: tan(ω t) = ω / γ, once per half period.
std::vector<TurningPoint> TurningPointsOfDampedSine(double end) {
  std::vector<TurningPoint> points;
  for (double t = std::atan(kOmega / kDecay) / kOmega; t < end; t += kPi / kOmega) {
    points.push_back({t, DampedSine(t)});
  }
  return points;
}

/// The largest differences of times and of values between two lists of the same length.
TurningPoint LargestError(const std::vector<TurningPoint>& found, const std::vector<TurningPoint>& expected) {
  TurningPoint error;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error.time = std::max(error.time, std::abs(found[i].time - expected[i].time));
    error.value = std::max(error.value, std::abs(found[i].value - expected[i].value));
  }
  return error;
}

void ExpectMaximaAndMinimaInTurn(const std::vector<TurningPoint>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_LT(points[i].value * points[i - 1].value, 0) << i;
    EXPECT_GT(points[i].time, points[i - 1].time) << i;
  }
}

/// Held at 1 for 1.9 s, then a cosine of 5 rad/s.
double HeldThenCosine(double t) { return t < 1.9 ? 1.0 : std::cos(kOmega * (t - 1.9)); }

// ---- Turning points ----------------------------------------------------------------------------------------------

TEST(FindTurningPoints, LocatesTheTurningPointsOfADampedSineFarBelowOneSample) {
  constexpr double kRate = 50;
  const std::vector<TurningPoint> expected = TurningPointsOfDampedSine(19.9);
  const std::vector<TurningPoint> found = Must(FindTurningPoints(Sample(DampedSine, 20, kRate))).points;
  ASSERT_THAT(found, SizeIs(expected.size()));
  EXPECT_LT(LargestError(found, expected).time, 0.02 / kRate);
  EXPECT_LT(LargestError(found, expected).value, 2e-3);  // the error of the parabola over 0.15 of a half period
  ExpectMaximaAndMinimaInTurn(found);
}

TEST(FindTurningPoints, NeedsNoUniformSampling) {
  Recording recording = Sample(DampedSine, 20, 50);
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    recording.time[i] += 0.008 * std::sin(12.9898 * static_cast<double>(i));  // shifted by at most 0.4 of a sample
    recording.value[i] = DampedSine(recording.time[i]);
  }
  const std::vector<TurningPoint> expected = TurningPointsOfDampedSine(19.9);
  const std::vector<TurningPoint> found = Must(FindTurningPoints(recording)).points;
  ASSERT_THAT(found, SizeIs(expected.size()));
  EXPECT_LT(LargestError(found, expected).time, 0.1 / 50);
}

TEST(FindTurningPoints, NoiseAddsNoTurningPointAndMovesEachOnlySlightly) {
  const std::vector<TurningPoint> expected = TurningPointsOfDampedSine(19.9);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<TurningPoint> found =
        Must(FindTurningPoints(WithNoise(Sample(DampedSine, 20.2, 100), 0.02, seed))).points;
    ASSERT_THAT(found, SizeIs(expected.size()));
    // 19 samples per parabola: its vertex has an error of 0.01 s at the end, where the amplitude has fallen to 0.37.
    EXPECT_LT(LargestError(found, expected).time, 0.06);
    EXPECT_LT(LargestError(found, expected).value, 0.04);
  }
}

TEST(FindTurningPoints, NoiseAtRestGivesNoTurningPoint) {
  // Turning points every 0.63 s. The amplitude is below a standard deviation of the noise from 7.7 s on; 50 s follow.
  const auto to_rest = [](double t) { return std::exp(-0.6 * t) * std::sin(kOmega * t); };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<TurningPoint> found =
        Must(FindTurningPoints(WithNoise(Sample(to_rest, 60, 100), 0.01, seed))).points;
    EXPECT_LT(found.back().time, 8) << "seed " << seed;
  }
}

TEST(FindTurningPoints, FlickerOfOneCountIsNotATurningPoint) {
  const double count = 0.02;
  Recording recording = Sample([&](double t) { return count * std::round(DampedSine(t) / count); }, 20, 100);
  for (Eigen::Index i = 0; i < recording.size(); i += 37) recording.value[i] += count;
  recording.resolution = count;
  EXPECT_THAT(Must(FindTurningPoints(recording)).points, SizeIs(TurningPointsOfDampedSine(19.9).size()));
}

TEST(FindTurningPoints, AHoldIsNotATurningPoint) {
  for (const double noise : {0.0, 0.01}) {
    SCOPED_TRACE(noise);
    const std::vector<TurningPoint> found =
        Must(FindTurningPoints(WithNoise(Sample(HeldThenCosine, 10, 100), noise, 3))).points;
    ASSERT_THAT(found, SizeIs(12));  // half periods of 0.628 s from 1.9 s to 10 s
    EXPECT_THAT(found.front().time, DoubleNear(1.9 + kPi / kOmega, 0.01));
    EXPECT_LT(found.front().value, 0);
  }
}

TEST(FindTurningPoints, AStartInTheMiddleOfASwingIsNotATurningPoint) {
  const std::vector<TurningPoint> found =
      Must(FindTurningPoints(Sample([](double t) { return std::cos(kOmega * t + 0.8); }, 10, 100))).points;
  EXPECT_THAT(found.front().time, DoubleNear((kPi - 0.8) / kOmega, 1e-3));
  EXPECT_THAT(found.front().value, DoubleNear(-1, 0.01));
}

TEST(FindTurningPoints, IncludesATurningPointSoonAfterTheStart) {
  const std::vector<TurningPoint> found =
      Must(FindTurningPoints(Sample([](double t) { return std::cos(kOmega * t - 0.8); }, 10, 100))).points;
  EXPECT_THAT(found.front().time, DoubleNear(0.8 / kOmega, 1e-3));
  EXPECT_THAT(found.front().value, DoubleNear(1, 0.01));
}

TEST(FindTurningPoints, RefusesAConstantReading) {
  const auto found = FindTurningPoints(Sample([](double) { return 0.3; }, 10, 10));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(found.error().message(),
            "the reading is constant, so there is no swing; check the sensor, or choose another column");
}

TEST(FindTurningPoints, RefusesFewerThanThreeTurningPointsWithTheirNumber) {
  // Minima and maxima of cos(5 t + 0.8) are at 0.468, 1.097 and 1.725 s.
  const auto wave = [](double t) { return std::cos(kOmega * t + 0.8); };
  const auto two = FindTurningPoints(Sample(wave, 1.5, 100));
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(two.error().message(), HasSubstr("neighbouring samples: 2;"));
  EXPECT_THAT(two.error().message(), HasSubstr("are needed: choose"));
  EXPECT_THAT(FindTurningPoints(Sample(wave, 0.4, 100)).error().message(), HasSubstr("neighbouring samples: 0;"));
  EXPECT_TRUE(FindTurningPoints(Sample(wave, 2.0, 100)));
}

TEST(FindTurningPoints, NamesATableOfMaxima) {
  // 1 % of noise, until nothing is left.
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.002);
  Recording maxima =
      Sample([&](double t) { return 0.5 * std::exp(-0.05 * t) - 0.0005 * t + noise(random); }, 56, 1 / 1.4);
  const auto found = FindTurningPoints(maxima);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message(), HasSubstr("maxima of a swing, one of each period; give all readings"));
  maxima.value *= -1;
  EXPECT_THAT(FindTurningPoints(maxima).error().message(), HasSubstr("maxima of a swing"));
}

// ---- Zero and runs -----------------------------------------------------------------------------------------------

constexpr double kHalfPeriod = kPi / kOmega;

/// Small oscillation with dry friction and a turning point at amplitude 1 at t = 0. In half period i it is a cosine
/// about (-1)^i x_k, so the turning points are (-1)^i (1 - 2 i x_k). The zero of the reading is 0.1.
double DryFriction(double t) {
  constexpr double kDryness = 0.02;  // x_k
  constexpr double kZero = 0.1;
  const double half_swing = std::floor(t / kHalfPeriod);
  const double side = std::fmod(half_swing, 2) == 0 ? 1 : -1;
  const double amplitude = 1 - 2 * half_swing * kDryness;
  return kZero + side * (kDryness + (amplitude - kDryness) * std::cos(kOmega * t - kPi * half_swing));
}

double Cosine(double t) { return 0.1 + std::cos(kOmega * t - 0.9); }

TEST(FindTurningPoints, HasNoZeroShiftForDryFriction) {
  const TurningPointTable table = Must(FindTurningPoints(Sample(DryFriction, 8, 200)));
  ASSERT_THAT(table.points, SizeIs(12));                 // half a period apart, after the start
  EXPECT_THAT(table.zero.value, DoubleNear(0.1, 1e-4));  // the mean of the reading has a larger error
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    EXPECT_THAT(table.Amplitude(i), DoubleNear(1 - 0.04 * static_cast<double>(i + 1), 5e-3)) << i;
    EXPECT_EQ(table.Side(i), i % 2 == 0 ? -1 : 1) << i;
  }
  EXPECT_EQ(table.LargestAmplitude(), table.Amplitude(0));
}

TEST(FindTurningPoints, HasATinyZeroShiftForExponentialDecay) {
  const auto decay = [](double t) { return 0.1 + std::exp(-0.05 * t) * std::cos(kOmega * t - 0.9); };
  EXPECT_THAT(Must(FindTurningPoints(Sample(decay, 20, 200))).zero.value, DoubleNear(0.1, 1e-3));
}

TEST(FindTurningPoints, GivesTheQuantityOfTheRecording) {
  Recording recording = Sample(Cosine, 8, 100);
  EXPECT_EQ(Must(FindTurningPoints(recording)).quantity, Quantity::kAngle);
  recording.quantity = Quantity::kRate;
  EXPECT_EQ(Must(FindTurningPoints(recording)).quantity, Quantity::kRate);
}

TEST(FindTurningPoints, BreaksTheRunAtAGap) {
  // Turning points at 0.18 + 0.628 i: only the half swing from 2.69 s to 3.32 s is lost in the gap.
  const TurningPointTable table = Must(FindTurningPoints(WithoutSamples(Sample(Cosine, 8, 100), 2.75, 3.25)));
  ASSERT_THAT(table.points, SizeIs(13));
  for (std::size_t i = 0; i < 13; ++i) EXPECT_EQ(table.points[i].continues, i != 0 && i != 5) << i;
  const std::vector<TurningPointRun> runs = table.Runs();
  ASSERT_THAT(runs, SizeIs(2));
  EXPECT_EQ(runs[0].first, 0U);
  EXPECT_EQ(runs[0].last, 4U);
  EXPECT_EQ(runs[1].first, 5U);
  EXPECT_EQ(runs[1].last, 12U);
}

TEST(FindTurningPoints, AcceptsAGapOfATenthOfASecond) {
  const TurningPointTable table = Must(FindTurningPoints(WithoutSamples(Sample(Cosine, 8, 100), 2.9, 3.0)));
  ASSERT_THAT(table.points, SizeIs(13));
  for (std::size_t i = 0; i < 13; ++i) EXPECT_EQ(table.points[i].continues, i > 0) << i;
}

TEST(TurningPointTable, HasNoRunOfASinglePoint) {
  TurningPointTable table;
  EXPECT_THAT(table.Runs(), SizeIs(0));
  table.points = {{.value = 3}, {.value = 1}, {.value = -1, .continues = true}, {.value = 2}};
  ASSERT_THAT(table.Runs(), SizeIs(1));
  EXPECT_EQ(table.Runs()[0].first, 1U);
  EXPECT_EQ(table.Runs()[0].last, 2U);
  EXPECT_EQ(table.LargestAmplitude(), 1);
}

TEST(TurningPointTable, HasTheStretchOfTheEllipticIntegral) {
  TurningPointTable table;
  table.points = {{.value = kPi / 2}};
  EXPECT_NEAR(table.Stretch(0), 1.180340599016, 1e-9);  // (2/π) K(sin 45 deg)
  table.quantity = Quantity::kRate;
  EXPECT_EQ(table.Stretch(0), 1);
}

// ---- All turning points --------------------------------------------------------------------------------------------

/// Turning points at i kHalfPeriod.
double DecayingCosine(double t) { return 0.1 + 0.2 * std::exp(-kDecay * t) * std::cos(kOmega * t); }

TEST(FindAllTurningPoints, FindsTimesZeroAndAmplitudeOfADecayingCosine) {
  const TurningPointTable table = FindAllTurningPoints(Sample(DecayingCosine, 7.75, 100));
  ASSERT_EQ(table.half_swings(), 12U);
  for (std::size_t i = 1; i < table.points.size(); ++i) {
    const double expected = static_cast<double>(i) * kHalfPeriod;
    EXPECT_NEAR(table.points[i].time, expected, 2e-3);
    EXPECT_NEAR(table.ZeroAt(i), 0.1, 1e-3);
    EXPECT_NEAR(table.Amplitude(i), 0.2 * std::exp(-kDecay * expected), 1.5e-3);
  }
  // half_period refers to small swings; a swing of 0.2 rad takes longer.
  EXPECT_NEAR(table.half_period * SineGravity::PeriodRatio(0.17), kHalfPeriod, 2e-3);
}

TEST(FindAllTurningPoints, HasNoZeroForFewerThanThreePoints) {
  const TurningPointTable table = FindAllTurningPoints(Sample(DecayingCosine, 0.9, 100));
  EXPECT_LT(table.points.size(), 3U);
  EXPECT_TRUE(table.local_zero.empty());
}

// ---- Noise between neighbours -------------------------------------------------------------------------------------

TEST(SuccessiveDifferenceNoise, IsTheStandardDeviationOfWhiteNoise) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Recording recording = WithNoise(Sample(DampedSine, 20, 500), 0.01, seed);
    EXPECT_THAT(SuccessiveDifferenceNoise(recording), DoubleNear(0.01, 3e-4)) << "seed " << seed;
  }
}

TEST(SuccessiveDifferenceNoise, IsRightForUnevenSamples) {
  Recording recording = Sample(DampedSine, 20, 500);
  for (Eigen::Index i = 0; i < recording.size(); ++i) recording.time[i] += i % 2 == 0 ? 0.0 : 0.0018;
  for (Eigen::Index i = 0; i < recording.size(); ++i) recording.value[i] = DampedSine(recording.time[i]);
  EXPECT_THAT(SuccessiveDifferenceNoise(WithNoise(recording, 0.01, 1)), DoubleNear(0.01, 3e-4));
}

TEST(SuccessiveDifferenceNoise, IsZeroForAStraightLine) {
  Recording recording = Sample([](double t) { return 3 - 0.5 * t; }, 2, 10);
  EXPECT_THAT(SuccessiveDifferenceNoise(recording), DoubleNear(0, 1e-14));
  recording.time = recording.time.array().square().eval();
  recording.value = (3 - 0.5 * recording.time.array()).eval();
  EXPECT_THAT(SuccessiveDifferenceNoise(recording), DoubleNear(0, 1e-14));
}

}  // namespace
}  // namespace pendulum::turning_points_test
