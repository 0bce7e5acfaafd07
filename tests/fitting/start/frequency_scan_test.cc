// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/frequency_scan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::frequency_scan_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::IsEmpty;
using testing::Le;
using testing::Lt;
using testing::Not;
using testing::SizeIs;

constexpr double kFrequency = 4.8;  // rad/s, 0.76 Hz: sampled once per second it aliases
constexpr double kZero = 0.012;
constexpr FrequencyRange kWide = {0.5, 18.8};  // rad/s; 18.8 is 3 Hz
constexpr int kSamples = 40;

/// Largest frequency step, from the phase step at the end of the scan; a local minimum may be one step off.
double GridStep(const Recording& recording) { return 0.6 / (recording.time.tail(1)[0] - recording.time[0]); }

Eigen::VectorXd EvenTimes(double interval = 1) {
  return Eigen::VectorXd::LinSpaced(kSamples, 0, interval * (kSamples - 1));
}

/// A cos(ω t - 0.9) + kZero at these times.
Recording Cosine(const Eigen::VectorXd& time, double amplitude = 0.4) {
  Recording recording;
  recording.time = time;
  recording.value = amplitude * (kFrequency * time.array() - 0.9).cos() + kZero;
  return Must(MakeRecording(recording));
}

MotionModel Linear() { return Must(FindMotionModel("linear")); }
MotionModel Viscous() { return Must(FindMotionModel("viscous")); }

/// Frictionless swing with this amplitude, one reading per second.
SyntheticOptions Swing(double amplitude, Quantity quantity = Quantity::kAngle) {
  SyntheticOptions options;
  options.model = Viscous();
  options.parameters = {1 / (kFrequency * kFrequency), 0};
  options.start = StartKind::kMoving;
  options.initial_angle = amplitude;
  options.duration = kSamples;
  options.sample_rate = 1;
  options.quantity = quantity;
  options.zero = kZero;
  return options;
}

/// Root mean square distance of the readings from the start's trajectory, divided by the distance from their mean.
double Unexplained(const Recording& recording, const StartValues& start, MotionModel model) {
  SyntheticOptions options;
  options.model = model;
  const std::size_t physical = PhysicalParameters(model).size();
  options.parameters.assign(start.parameters.begin(), start.parameters.begin() + static_cast<std::ptrdiff_t>(physical));
  options.start = StartKind::kMoving;
  options.initial_angle = start.parameters.at(physical);
  options.initial_rate = start.parameters.at(physical + 1);
  options.zero = start.parameters.at(physical + 2);
  options.sample_rate = 1;
  options.duration = kSamples;
  options.quantity = recording.quantity;
  const Eigen::VectorXd modelled = Must(SimulateRecording(options)).value;
  return (recording.value - modelled).norm() / (recording.value.array() - recording.value.mean()).matrix().norm();
}

/// The start with the nearest frequency.
StartValues Nearest(const std::vector<StartValues>& starts, double frequency) {
  return *std::ranges::min_element(
      starts, {}, [&](const StartValues& start) { return std::abs(start.natural_frequency - frequency); });
}

TEST(ScanFrequencies, HasTheTrueFrequencyOfACosineSampledOnceASecond) {
  const Recording recording = Cosine(EvenTimes());
  const StartValues start = Nearest(ScanFrequencies(recording, Linear(), kWide), kFrequency);
  EXPECT_THAT(start.natural_frequency, DoubleNear(kFrequency, GridStep(recording)));
  EXPECT_EQ(start.start, StartKind::kMoving);
}

TEST(ScanFrequencies, ExplainsReadingsAtAGridFrequency) {
  const Recording recording = Cosine(EvenTimes());
  const auto starts = ScanFrequencies(recording, Linear(), {kFrequency, kFrequency});
  ASSERT_THAT(starts, SizeIs(1));
  const std::vector<double>& found = starts[0].parameters;
  ASSERT_THAT(found, SizeIs(5));  // inertia, viscous, initial angle and rate, zero
  EXPECT_DOUBLE_EQ(found[0], 1 / (kFrequency * kFrequency));
  // The scan has no envelope without decay: the smallest is 5 % over the scanned time.
  EXPECT_THAT(found[2], DoubleNear(0.4 * std::cos(0.9), 0.02));
  EXPECT_THAT(found[3], DoubleNear(0.4 * kFrequency * std::sin(0.9), 0.1));
  EXPECT_THAT(found[4], DoubleNear(kZero, 1e-3));
  EXPECT_THAT(Unexplained(recording, starts[0], Linear()), Lt(0.1));
}

TEST(ScanFrequencies, ReturnsAtMostTwelveFrequencies) {
  // Sampled once per second, ω, 2π - ω and both plus multiples of 2π look the same: 63 of them lie below 200 rad/s.
  EXPECT_THAT(ScanFrequencies(Cosine(EvenTimes()), Linear(), {0.5, 200}), SizeIs(12));
}

TEST(ScanFrequencies, HasTheTrueFrequencyFirstAtUnevenStamps) {
  // Even samples have aliases that explain them equally well; uneven samples have none.
  const Eigen::VectorXd even = EvenTimes();
  const Recording uneven = Cosine(even.array() + 0.3 * (1.7 * even.array()).sin());
  const auto starts = ScanFrequencies(uneven, Linear(), kWide);
  ASSERT_THAT(starts, SizeIs(Ge(2U)));
  EXPECT_THAT(starts[0].natural_frequency, DoubleNear(kFrequency, GridStep(uneven)));
}

TEST(ScanFrequencies, ReturnsTheOnlyFrequencyOfARange) {
  const auto starts = ScanFrequencies(Cosine(EvenTimes()), Linear(), {3, 3});
  ASSERT_THAT(starts, SizeIs(1));
  EXPECT_EQ(starts[0].natural_frequency, 3);
}

TEST(ScanFrequencies, StaysWithinTheRange) {
  const auto starts = ScanFrequencies(Cosine(EvenTimes()), Linear(), {4, 6});
  ASSERT_THAT(starts, Not(IsEmpty()));
  for (const StartValues& start : starts) {
    EXPECT_THAT(start.natural_frequency, AllOf(Ge(4), Le(6)));
  }
}

TEST(ScanFrequencies, CorrectsTheFrequencyOfALargeSwing) {
  // At 1.2 rad the period is 4 K(sin 0.6) / ω0, 10 % above that of small swings.
  const Recording recording = Must(SimulateRecording(Swing(1.2)));
  const double apparent = kFrequency * kPi / (2 * std::comp_ellint_1(std::sin(0.6)));
  ASSERT_THAT(kFrequency - apparent, Ge(10 * GridStep(recording)));
  const StartValues sine = ScanFrequencies(recording, Viscous(), {4, 5.4}).at(0);
  EXPECT_THAT(sine.natural_frequency, DoubleNear(kFrequency, GridStep(recording)));
  EXPECT_THAT(sine.amplitude, DoubleNear(1.2, 0.1));
  const StartValues linear = ScanFrequencies(recording, Linear(), {4, 5.4}).at(0);
  EXPECT_THAT(linear.natural_frequency, DoubleNear(apparent, GridStep(recording)));
}

TEST(ScanFrequencies, AcceptsARate) {
  const Recording recording = Must(SimulateRecording(Swing(0.4, Quantity::kRate)));
  const StartValues start = Nearest(ScanFrequencies(recording, Viscous(), kWide), kFrequency);
  EXPECT_THAT(start.natural_frequency, DoubleNear(kFrequency, GridStep(recording)));
  EXPECT_THAT(start.amplitude, DoubleNear(0.4, 0.04));  // rad, not rad/s
}

}  // namespace
}  // namespace pendulum::frequency_scan_test
