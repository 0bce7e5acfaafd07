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

// ---- Amplitude and period ----------------------------------------------------------------------------------------

TEST(PeriodRatio, MatchesThePublishedTable) {
  // T/T0 at amplitude [deg], computed independently by the arithmetic-geometric mean.
  constexpr std::pair<double, double> kTable[] = {{10, 1.001907188143}, {30, 1.017408797596},  {60, 1.073182007149},
                                                  {90, 1.180340599016}, {120, 1.372880500618}, {150, 1.762203729504},
                                                  {170, 2.439362719674}};
  for (const auto& [degrees, ratio] : kTable) {
    EXPECT_THAT(PeriodRatio(degrees * kRadFromDeg), DoubleNear(ratio, 1e-12)) << degrees;
  }
}

TEST(PeriodRatio, MatchesTheStandardLibrarysEllipticIntegral) {
  for (double degrees = 1; degrees < 180; degrees += 1) {
    const double expected = 2 / kPi * std::comp_ellint_1(std::sin(0.5 * degrees * kRadFromDeg));
    EXPECT_THAT(PeriodRatio(degrees * kRadFromDeg) / expected, DoubleNear(1, 1e-12)) << degrees;
  }
}

TEST(PeriodRatio, IsOneAtRestAndTheSameOnBothSides) {
  EXPECT_EQ(PeriodRatio(0), 1);
  EXPECT_EQ(PeriodRatio(-1.2), PeriodRatio(1.2));
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

// ---- Natural frequency from a recording ---------------------------------------------------------------------------

// Near the top, the angle and the rate around their peaks differ more and more from a parabola. The amplitudes come out
// too small, and so does the correction of the period.

TEST(NaturalFrequency, IsRightForAnUndampedAngleAtAnyAmplitude) {
  for (double degrees = 10; degrees <= 170; degrees += 10) {
    const auto angle = [&](double t) { return UndampedAngle(degrees * kRadFromDeg, 1.0 / 25, t + 0.3); };
    const HalfSwingTable table = Must(TabulateHalfSwings(Sample(angle, 30, 100)));
    const double tolerance = degrees <= 120 ? 1e-4 : 2e-3;
    EXPECT_THAT(NaturalFrequency(table) / 5, DoubleNear(1, tolerance)) << degrees << " deg";
  }
}

TEST(NaturalFrequency, IsRightForAnUndampedRateAtAnyAmplitude) {
  for (double degrees = 10; degrees <= 170; degrees += 10) {
    const auto rate = [&](double t) { return UndampedRate(degrees * kRadFromDeg, 5, t + 0.3); };
    Recording recording = Sample(rate, 30, 100);
    recording.quantity = Quantity::kRate;
    const double tolerance = degrees <= 60 ? 1e-4 : degrees <= 110 ? 1e-3 : 0.02;
    EXPECT_THAT(NaturalFrequency(Must(TabulateHalfSwings(recording))) / 5, DoubleNear(1, tolerance)) << degrees;
  }
}

TEST(NaturalFrequency, IsCorrectedForAnAmplitudeThatDecays) {
  Decay decay;
  decay.coulomb = 0.01;
  decay.viscous = 0.002;
  decay.amplitude = 150 * kRadFromDeg;
  for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
    decay.quantity = quantity;
    const HalfSwingTable table = Must(TabulateHalfSwings(SimulateDecay(decay)));
    EXPECT_THAT(NaturalFrequency(table) / 5, DoubleNear(1, 2e-3)) << (quantity == Quantity::kRate ? "rate" : "angle");
  }
}

TEST(NaturalFrequency, LosesNoCycleInAGap) {
  const auto angle = [](double t) { return UndampedAngle(1.0, 1.0 / 25, t + 0.3); };
  const Recording recording = WithoutSamples(Sample(angle, 30, 100), 10.03, 13.71);  // 2.7 periods
  EXPECT_THAT(NaturalFrequency(Must(TabulateHalfSwings(recording))) / 5, DoubleNear(1, 1e-4));
}

}  // namespace
}  // namespace pendulum::period_test
