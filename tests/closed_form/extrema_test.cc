// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/extrema.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/closed_form/reference_swing.h"

namespace pendulum::extrema_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kDecay = 0.05;  // 1/s
constexpr double kOmega = 5.0;   // rad/s

double DampedSine(double t) { return std::exp(-kDecay * t) * std::sin(kOmega * t); }

/// Its turning points before `end`: tan(ω t) = ω / γ, once per half period.
std::vector<Extremum> TurningPointsOfDampedSine(double end) {
  std::vector<Extremum> points;
  for (double t = std::atan(kOmega / kDecay) / kOmega; t < end; t += kPi / kOmega) {
    points.push_back({t, DampedSine(t)});
  }
  return points;
}

/// The largest differences of times and of values between two lists of the same length.
Extremum LargestError(const std::vector<Extremum>& found, const std::vector<Extremum>& expected) {
  Extremum error;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error.time = std::max(error.time, std::abs(found[i].time - expected[i].time));
    error.value = std::max(error.value, std::abs(found[i].value - expected[i].value));
  }
  return error;
}

void ExpectMaximaAndMinimaInTurn(const std::vector<Extremum>& extrema) {
  for (std::size_t i = 1; i < extrema.size(); ++i) {
    EXPECT_LT(extrema[i].value * extrema[i - 1].value, 0) << i;
    EXPECT_GT(extrema[i].time, extrema[i - 1].time) << i;
  }
}

/// Held at 1 for 1.9 s, then a cosine of 5 rad/s.
double HeldThenCosine(double t) { return t < 1.9 ? 1.0 : std::cos(kOmega * (t - 1.9)); }

// ---- Turning points ----------------------------------------------------------------------------------------------

TEST(FindExtrema, LocatesTheTurningPointsOfADampedSineFarBelowOneSample) {
  constexpr double kRate = 50;
  const std::vector<Extremum> expected = TurningPointsOfDampedSine(19.9);
  const std::vector<Extremum> found = Must(FindExtrema(Sample(DampedSine, 20, kRate)));
  ASSERT_THAT(found, SizeIs(expected.size()));
  EXPECT_LT(LargestError(found, expected).time, 0.02 / kRate);
  EXPECT_LT(LargestError(found, expected).value, 2e-3);  // the error of the parabola over 0.15 of a half period
  ExpectMaximaAndMinimaInTurn(found);
}

TEST(FindExtrema, NeedsNoUniformSampling) {
  Recording recording = Sample(DampedSine, 20, 50);
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    recording.time[i] += 0.008 * std::sin(12.9898 * static_cast<double>(i));  // shifted by at most 0.4 of a sample
    recording.value[i] = DampedSine(recording.time[i]);
  }
  const std::vector<Extremum> expected = TurningPointsOfDampedSine(19.9);
  const std::vector<Extremum> found = Must(FindExtrema(recording));
  ASSERT_THAT(found, SizeIs(expected.size()));
  EXPECT_LT(LargestError(found, expected).time, 0.1 / 50);
}

TEST(FindExtrema, NoiseAddsNoTurningPointAndMovesNoneFar) {
  const std::vector<Extremum> expected = TurningPointsOfDampedSine(19.9);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<Extremum> found = Must(FindExtrema(WithNoise(Sample(DampedSine, 20.2, 100), 0.02, seed)));
    ASSERT_THAT(found, SizeIs(expected.size()));
    // 19 samples per parabola: its vertex has an error of 0.01 s at the end, where the amplitude has fallen to 0.37.
    EXPECT_LT(LargestError(found, expected).time, 0.06);
    EXPECT_LT(LargestError(found, expected).value, 0.04);
  }
}

TEST(FindExtrema, NoiseAtRestGivesNoTurningPoint) {
  // Turning points every 0.63 s. The amplitude is below a standard deviation of the noise from 7.7 s on; 50 s follow.
  const auto to_rest = [](double t) { return std::exp(-0.6 * t) * std::sin(kOmega * t); };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Extremum> found = Must(FindExtrema(WithNoise(Sample(to_rest, 60, 100), 0.01, seed)));
    EXPECT_LT(found.back().time, 8) << "seed " << seed;
  }
}

TEST(FindExtrema, FlickerOfOneCountIsNotATurningPoint) {
  const double count = 0.02;
  Recording recording = Sample([&](double t) { return count * std::round(DampedSine(t) / count); }, 20, 100);
  for (Eigen::Index i = 0; i < recording.size(); i += 37) recording.value[i] += count;
  recording.resolution = count;
  EXPECT_THAT(Must(FindExtrema(recording)), SizeIs(TurningPointsOfDampedSine(19.9).size()));
}

TEST(FindExtrema, AHoldIsNotATurningPoint) {
  for (const double noise : {0.0, 0.01}) {
    SCOPED_TRACE(noise);
    const std::vector<Extremum> found = Must(FindExtrema(WithNoise(Sample(HeldThenCosine, 10, 100), noise, 3)));
    ASSERT_THAT(found, SizeIs(12));  // half periods of 0.628 s from 1.9 s to 10 s
    EXPECT_THAT(found.front().time, DoubleNear(1.9 + kPi / kOmega, 0.01));
    EXPECT_LT(found.front().value, 0);
  }
}

TEST(FindExtrema, AStartInTheMiddleOfASwingIsNotATurningPoint) {
  const std::vector<Extremum> found =
      Must(FindExtrema(Sample([](double t) { return std::cos(kOmega * t + 0.8); }, 10, 100)));
  EXPECT_THAT(found.front().time, DoubleNear((kPi - 0.8) / kOmega, 1e-3));
  EXPECT_THAT(found.front().value, DoubleNear(-1, 0.01));
}

TEST(FindExtrema, ATurningPointSoonAfterTheStartCounts) {
  const std::vector<Extremum> found =
      Must(FindExtrema(Sample([](double t) { return std::cos(kOmega * t - 0.8); }, 10, 100)));
  EXPECT_THAT(found.front().time, DoubleNear(0.8 / kOmega, 1e-3));
  EXPECT_THAT(found.front().value, DoubleNear(1, 0.01));
}

TEST(FindExtrema, RefusesAConstantReading) {
  const auto found = FindExtrema(Sample([](double) { return 0.3; }, 10, 10));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(found.error().message,
            "the reading is constant: there is no swing in it; check the sensor, or choose another column");
}

TEST(FindExtrema, RefusesFewerThanThreeTurningPointsWithTheirNumber) {
  // Minima and maxima of cos(5 t + 0.8) are at 0.468, 1.097 and 1.725 s.
  const auto wave = [](double t) { return std::cos(kOmega * t + 0.8); };
  const auto two = FindExtrema(Sample(wave, 1.5, 100));
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(two.error().message, HasSubstr("neighbouring samples: 2;"));
  EXPECT_THAT(two.error().message, HasSubstr("are needed to tell a swing"));
  EXPECT_THAT(FindExtrema(Sample(wave, 0.4, 100)).error().message, HasSubstr("neighbouring samples: 0;"));
  EXPECT_TRUE(FindExtrema(Sample(wave, 2.0, 100)));
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
}  // namespace pendulum::extrema_test
