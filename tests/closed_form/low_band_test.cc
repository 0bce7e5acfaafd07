// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/low_band.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/closed_form/reference_swing.h"

namespace pendulum::low_band_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::Le;

constexpr double kRate = 200;  // Hz
constexpr double kNoise = 1e-3;

Recording Oscillation(double frequency, double duration = 10) {
  return Sample([=](double t) { return std::sin(2 * kPi * frequency * t + 0.3); }, duration, kRate);
}

/// The largest reading away from the ends, where the mean is over fewer samples.
double LargestInside(const Recording& recording, double margin) {
  double largest = 0;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const bool inside = recording.time[i] > margin && recording.time[i] < recording.time.tail(1)[0] - margin;
    if (inside) largest = std::max(largest, std::abs(recording.value[i]));
  }
  return largest;
}

TEST(LowBand, RemovesAnOscillationWithThePeriodOfTheMean) {
  EXPECT_THAT(LargestInside(LowBand(Oscillation(8), 1.0 / 8), 0.3), Le(0.01));
}

// The transfer function of a mean over L is sin(π f L) / (π f L); here it is applied twice.
TEST(LowBand, KeepsTheKnownShareOfASlowerOscillation) {
  for (const double slower : {2.0, 4.0, 8.0}) {
    const double x = kPi / slower;
    const double share = std::pow(std::sin(x) / x, 2);
    EXPECT_THAT(LargestInside(LowBand(Oscillation(8 / slower), 1.0 / 8), 0.3), DoubleNear(share, 0.02)) << slower;
  }
}

TEST(LowBand, KeepsAConstantWithUnevenStampsAndGaps) {
  Recording recording = WithoutSamples(Oscillation(1), 3, 5);
  for (Eigen::Index i = 0; i < recording.size(); i += 3) recording.time[i] += 0.002;
  recording.value.setConstant(1e6 + 0.25);
  const Recording low = LowBand(recording, 0.5);
  for (const double value : low.value) EXPECT_THAT(value, DoubleNear(1e6 + 0.25, 1e-6));
}

// ---- What remains of a vibration ----------------------------------------------------------------------------------

/// A swing with turning points every 0.5 s, over which a vibration of 8 Hz lies: `size` times exp(-decay t).
Recording Vibrating(double size, double decay) {
  const Recording swing = Sample([](double t) { return std::cos(2 * kPi * t); }, 12, kRate);
  Recording vibrating = swing;
  for (Eigen::Index i = 0; i < swing.size(); ++i) {
    vibrating.value[i] += size * std::exp(-decay * swing.time[i]) * std::sin(2 * kPi * 8 * swing.time[i]);
  }
  return WithNoise(std::move(vibrating), kNoise, 1);
}

FreeSwing WholeSwing(const Recording& recording) {
  FreeSwing swing;
  swing.from = recording.time[0];
  swing.to = recording.time.tail(1)[0];
  swing.amplitude = 1;
  swing.half_period = 0.5;
  for (double turn = 0.5; turn < swing.to; turn += 0.5) swing.turns.push_back(turn);
  swing.heights.assign(swing.turns.size() - 1, 2);
  return swing;
}

FreeSwing WithoutVibration(double size, double decay) {
  const Recording recording = Vibrating(size, decay);
  FreeSwing swing = WholeSwing(recording);
  LeaveOutVibration(recording, kNoise, 1.0 / 8, swing);
  return swing;
}

TEST(LeaveOutVibration, BeginsTheSwingAfterAVibrationThatDiesAway) {
  const FreeSwing swing = WithoutVibration(0.4, 1.5);  // 1 % after 2.5 s
  EXPECT_EQ(swing.begins.reason, WindowBegin::Reason::kAfterVibration);
  EXPECT_THAT(swing.begins.frequency_hz, DoubleNear(8, 0.2));
  EXPECT_THAT(swing.from, AllOf(Ge(1.8), Le(3.0)));
  EXPECT_EQ(swing.turns.front(), swing.from);
  EXPECT_FALSE(swing.vibration);
}

TEST(LeaveOutVibration, MeasuresAVibrationThatStays) {
  const FreeSwing swing = WithoutVibration(0.1, 0);
  EXPECT_EQ(swing.from, 0);
  ASSERT_TRUE(swing.vibration);
  EXPECT_THAT(swing.vibration->frequency, DoubleNear(8, 0.2));
  EXPECT_THAT(swing.vibration->amplitude, DoubleNear(0.1, 0.01));
}

TEST(LeaveOutVibration, DoesNotTakeNoiseForAVibration) {
  const FreeSwing swing = WithoutVibration(0, 0);
  EXPECT_EQ(swing.from, 0);
  EXPECT_FALSE(swing.vibration);
}

}  // namespace
}  // namespace pendulum::low_band_test
