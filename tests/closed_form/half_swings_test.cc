// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/half_swings.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/closed_form/reference_swing.h"

namespace pendulum::half_swings_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kOmega = 5.0;  // rad/s
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

TEST(TabulateHalfSwings, HasNoZeroShiftForDryFriction) {
  const HalfSwingTable table = Must(TabulateHalfSwings(Sample(DryFriction, 8, 200)));
  ASSERT_THAT(table.half_swings, SizeIs(11));      // 12 turning points after the start, half a period apart
  EXPECT_THAT(table.zero, DoubleNear(0.1, 1e-4));  // the mean of the reading has a larger error
  for (std::size_t i = 0; i < table.half_swings.size(); ++i) {
    SCOPED_TRACE(i);
    const double before = 1 - 0.04 * static_cast<double>(i + 1);
    EXPECT_THAT(table.half_swings[i].before, DoubleNear(before, 5e-3));
    EXPECT_THAT(table.half_swings[i].after, DoubleNear(before - 0.04, 5e-3));
  }
}

TEST(TabulateHalfSwings, HasATinyZeroShiftForExponentialDecay) {
  const auto decay = [](double t) { return 0.1 + std::exp(-0.05 * t) * std::cos(kOmega * t - 0.9); };
  EXPECT_THAT(Must(TabulateHalfSwings(Sample(decay, 20, 200))).zero, DoubleNear(0.1, 1e-3));
}

TEST(TabulateHalfSwings, LocatesThePassagesThroughZero) {
  const HalfSwingTable table = Must(TabulateHalfSwings(Sample(Cosine, 8, 100, 1000)));
  ASSERT_THAT(table.half_swings, SizeIs(11));
  // cos(5 t - 0.9) on a clock that starts at 1000 s. Turning points are at 5 t - 0.9 = n π.
  const double first_turn_number = std::ceil((kOmega * 1000 - 0.9) / kPi);
  for (std::size_t i = 0; i < table.half_swings.size(); ++i) {
    const double crossing = ((first_turn_number + 0.5 + static_cast<double>(i)) * kPi + 0.9) / kOmega;
    EXPECT_THAT(table.half_swings[i].crossing, DoubleNear(crossing, 5e-5)) << i;
  }
}

TEST(TabulateHalfSwings, LocatesAPassageBetterWithManySamples) {
  constexpr double kNoise = 0.05;
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const HalfSwingTable table = Must(TabulateHalfSwings(WithNoise(Sample(Cosine, 8, 200), kNoise, seed)));
    ASSERT_THAT(table.half_swings, SizeIs(12)) << "seed " << seed;
    for (std::size_t i = 0; i < table.half_swings.size(); ++i, ++count) {
      const double error = table.half_swings[i].crossing - ((0.5 + static_cast<double>(i)) * kPi + 0.9) / kOmega;
      squares += error * error;
    }
  }
  // Two samples give an error of about noise / slope = 0.01 s. The line through 28 samples gives 0.01 s / sqrt(28) =
  // 0.002 s plus a common 0.002 s from the noise of zero.
  EXPECT_LT(std::sqrt(squares / count), 0.0045);
}

TEST(TabulateHalfSwings, LocatesPassagesFromTwoSamples) {
  const HalfSwingTable table = Must(TabulateHalfSwings(Sample(Cosine, 8, 8)));  // five samples per half period
  for (std::size_t i = 0; i < table.half_swings.size(); ++i) {
    const double crossing = ((0.5 + static_cast<double>(i)) * kPi + 0.9) / kOmega;
    EXPECT_THAT(table.half_swings[i].crossing, DoubleNear(crossing, 0.02)) << i;
  }
}

TEST(TabulateHalfSwings, ContinuesEachHalfSwingFromThePrevious) {
  const HalfSwingTable table = Must(TabulateHalfSwings(Sample(Cosine, 8, 100)));
  for (std::size_t i = 0; i < table.half_swings.size(); ++i) EXPECT_EQ(table.half_swings[i].continues, i > 0) << i;
}

TEST(TabulateHalfSwings, BreaksTheRunAtAGap) {
  // Turning points at 0.18 + 0.628 i: only the half swing from 2.69 s to 3.32 s is lost in the gap.
  const HalfSwingTable table = Must(TabulateHalfSwings(WithoutSamples(Sample(Cosine, 8, 100), 2.75, 3.25)));
  ASSERT_THAT(table.half_swings, SizeIs(11));
  for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(table.half_swings[i].continues, i != 0 && i != 4) << i;
  EXPECT_THAT(table.half_swings[3].crossing, DoubleNear((3.5 * kPi + 0.9) / kOmega, 1e-3));
  EXPECT_THAT(table.half_swings[4].crossing, DoubleNear((5.5 * kPi + 0.9) / kOmega, 1e-3));
}

TEST(TabulateHalfSwings, AcceptsAGapOfATenthOfASecond) {
  const HalfSwingTable table = Must(TabulateHalfSwings(WithoutSamples(Sample(Cosine, 8, 100), 2.9, 3.0)));
  ASSERT_THAT(table.half_swings, SizeIs(12));
  for (std::size_t i = 1; i < 12; ++i) EXPECT_TRUE(table.half_swings[i].continues) << i;
}

TEST(TabulateHalfSwings, RefusesIsolatedHalfSwings) {
  Recording recording = Sample(Cosine, 8, 100);
  for (double turn = 0.9 / kOmega; turn < 8; turn += 2 * kHalfPeriod) {
    recording = WithoutSamples(recording, turn + 0.1, turn + kHalfPeriod - 0.1);
  }
  const auto table = TabulateHalfSwings(recording);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(table.error().message, HasSubstr("no two half swings follow each other without a gap"));
}

TEST(TabulateHalfSwings, RefusesTooFewTurningPoints) {
  const auto table = TabulateHalfSwings(Sample(Cosine, 1, 100));
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(table.error().message, HasSubstr("are needed to tell a swing"));
}

TEST(TabulateHalfSwings, KeepsTheQuantity) {
  Recording recording = Sample(Cosine, 8, 100);
  EXPECT_EQ(Must(TabulateHalfSwings(recording)).quantity, Quantity::kAngle);
  recording.quantity = Quantity::kRate;
  EXPECT_EQ(Must(TabulateHalfSwings(recording)).quantity, Quantity::kRate);
}

}  // namespace
}  // namespace pendulum::half_swings_test
