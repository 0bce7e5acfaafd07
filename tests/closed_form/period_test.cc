// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/period.h"

#include <cmath>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/closed_form/reference_swing.h"

namespace pendulum::period_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

// ---- Amplitude and period ----------------------------------------------------------------------------------------

TEST(PeriodRatio, MatchesThePublishedTable) {
  // T/T0 at amplitude [deg], computed independently by the arithmetic-geometric mean.
  constexpr std::pair<double, double> kTable[] = {{10, 1.001907188143}, {30, 1.017408797596},  {60, 1.073182007149},
                                                  {90, 1.180340599016}, {120, 1.372880500618}, {150, 1.762203729504},
                                                  {170, 2.439362719674}};
  for (const auto& [degrees, ratio] : kTable) {
    EXPECT_THAT(SineGravity::PeriodRatio(degrees * kRadFromDeg), DoubleNear(ratio, 1e-12)) << degrees;
  }
}

TEST(PeriodRatio, MatchesTheStandardLibrarysEllipticIntegral) {
  for (double degrees = 1; degrees < 180; degrees += 1) {
    const double expected = 2 / kPi * std::comp_ellint_1(std::sin(0.5 * degrees * kRadFromDeg));
    EXPECT_THAT(SineGravity::PeriodRatio(degrees * kRadFromDeg) / expected, DoubleNear(1, 1e-12)) << degrees;
  }
}

TEST(PeriodRatio, IsOneAtRestAndIndependentOfTheSign) {
  EXPECT_EQ(SineGravity::PeriodRatio(0), 1);
  EXPECT_EQ(SineGravity::PeriodRatio(-1.2), SineGravity::PeriodRatio(1.2));
}

TEST(AngleAmplitude, IsUnchangedForAnAngle) {
  EXPECT_EQ(AngleAmplitude(Quantity::kAngle, 1.3, 5), 1.3);
  EXPECT_EQ(AngleAmplitude(Quantity::kAngle, 4.0, 5), 3.1);
}

TEST(AngleAmplitude, FollowsFromEnergyForAPeakRate) {
  // ω_peak² / 2 = ω0² (1 - cos A).
  for (const double amplitude : {0.1, 1.0, 2.0, 3.0}) {
    const double peak = 5 * std::sqrt(2 * (1 - std::cos(amplitude)));
    EXPECT_THAT(AngleAmplitude(Quantity::kRate, peak, 5), DoubleNear(amplitude, 1e-12));
  }
  EXPECT_EQ(AngleAmplitude(Quantity::kRate, 11, 5), 3.1);  // faster than any swing
}

// ---- Zero crossings ------------------------------------------------------------------------------------------------

constexpr double kOmega = 5.0;  // rad/s

/// Turning points at 5 t - 0.9 = n π, zero crossings a quarter of a period later.
double Cosine(double t) { return 0.1 + std::cos(kOmega * t - 0.9); }

double CrossingAfterTurn(double number) { return ((number + 0.5) * kPi + 0.9) / kOmega; }

TEST(ZeroCrossing, MatchesACosine) {
  const Recording recording = Sample(Cosine, 8, 100, 1000);  // on a clock that starts at 1000 s
  const TurningPointTable table = Must(FindTurningPoints(recording));
  ASSERT_EQ(table.half_swings(), 11U);
  const double first_turn_number = std::ceil((kOmega * 1000 - 0.9) / kPi);
  for (std::size_t i = 1; i < table.points.size(); ++i) {
    const double crossing = CrossingAfterTurn(first_turn_number + static_cast<double>(i - 1));
    EXPECT_THAT(ZeroCrossing(recording, table, i), DoubleNear(crossing, 5e-5)) << i;
  }
}

TEST(ZeroCrossing, IsMorePreciseWithManySamples) {
  constexpr double kNoise = 0.05;
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording recording = WithNoise(Sample(Cosine, 8, 200), kNoise, seed);
    const TurningPointTable table = Must(FindTurningPoints(recording));
    ASSERT_EQ(table.half_swings(), 12U) << "seed " << seed;
    for (std::size_t i = 1; i < table.points.size(); ++i, ++count) {
      squares += std::pow(ZeroCrossing(recording, table, i) - CrossingAfterTurn(static_cast<double>(i - 1)), 2);
    }
  }
  // Two samples give an error of about noise / slope = 0.01 s. The line through 28 samples gives 0.01 s / sqrt(28) =
  // 0.002 s plus a common 0.002 s from the noise of zero.
  EXPECT_LT(std::sqrt(squares / count), 0.0045);
}

TEST(ZeroCrossing, NeedsOnlyTwoSamples) {
  const Recording recording = Sample(Cosine, 8, 8);  // five samples per half period
  const TurningPointTable table = Must(FindTurningPoints(recording));
  for (std::size_t i = 1; i < table.points.size(); ++i) {
    const double crossing = CrossingAfterTurn(static_cast<double>(i - 1));
    EXPECT_THAT(ZeroCrossing(recording, table, i), DoubleNear(crossing, 0.02)) << i;
  }
}

// ---- Natural frequency from a recording ---------------------------------------------------------------------------

// Near the top, the angle and the rate around their peaks differ more and more from a parabola. The amplitudes found
// are too small, and so is the correction of the period.

double FrequencyOf(const Recording& recording) {
  return Must(NaturalFrequency(recording, Must(FindTurningPoints(recording)), Gravity::kSine));
}

TEST(NaturalFrequency, IsRightForAnUndampedAngleAtAnyAmplitude) {
  for (double degrees = 10; degrees <= 170; degrees += 10) {
    const auto angle = [&](double t) { return UndampedAngle(degrees * kRadFromDeg, 1.0 / 25, t + 0.3); };
    const Recording recording = Sample(angle, 30, 100);
    const double tolerance = degrees <= 120 ? 1e-4 : 2e-3;
    EXPECT_THAT(FrequencyOf(recording) / 5, DoubleNear(1, tolerance)) << degrees << " deg";
  }
}

TEST(NaturalFrequency, IsRightForAnUndampedRateAtAnyAmplitude) {
  for (double degrees = 10; degrees <= 170; degrees += 10) {
    const auto rate = [&](double t) { return UndampedRate(degrees * kRadFromDeg, 5, t + 0.3); };
    Recording recording = Sample(rate, 30, 100);
    recording.quantity = Quantity::kRate;
    const double tolerance = degrees <= 60 ? 1e-4 : degrees <= 110 ? 1e-3 : 0.02;
    EXPECT_THAT(FrequencyOf(recording) / 5, DoubleNear(1, tolerance)) << degrees;
  }
}

TEST(NaturalFrequency, IsCorrectedForAnAmplitudeThatDecays) {
  Decay decay;
  decay.coulomb = 0.01;
  decay.viscous = 0.002;
  decay.amplitude = 150 * kRadFromDeg;
  for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
    decay.quantity = quantity;
    const Recording recording = SimulateDecay(decay);
    EXPECT_THAT(FrequencyOf(recording) / 5, DoubleNear(1, 2e-3)) << (quantity == Quantity::kRate ? "rate" : "angle");
  }
}

TEST(NaturalFrequency, LosesNoCycleInAGap) {
  const auto angle = [](double t) { return UndampedAngle(1.0, 1.0 / 25, t + 0.3); };
  const Recording recording = WithoutSamples(Sample(angle, 30, 100), 10.03, 13.71);  // 2.7 periods
  EXPECT_THAT(FrequencyOf(recording) / 5, DoubleNear(1, 1e-4));
}

TEST(NaturalFrequency, RefusesIsolatedHalfSwings) {
  Recording recording = Sample(Cosine, 8, 100);
  for (double turn = 0.9 / kOmega; turn < 8; turn += 2 * kPi / kOmega) {
    recording = WithoutSamples(recording, turn + 0.1, turn + kPi / kOmega - 0.1);
  }
  const Result<double> frequency = NaturalFrequency(recording, Must(FindTurningPoints(recording)), Gravity::kSine);
  ASSERT_FALSE(frequency);
  EXPECT_EQ(frequency.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(frequency.error().message(), HasSubstr("no two successive half swings without a gap"));
}

}  // namespace
}  // namespace pendulum::period_test
