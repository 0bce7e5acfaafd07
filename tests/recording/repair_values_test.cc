// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/repair_values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::repair_values_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Le;

/// middle + amplitude * cos(5 t), sampled at 100 Hz without noise.
Recording Wave(double amplitude, double middle = 0, Eigen::Index count = 1000) {
  Recording recording;
  recording.time = Eigen::ArrayXd::LinSpaced(count, 0, 0.01 * static_cast<double>(count - 1));
  recording.value = middle + amplitude * (5 * recording.time.array()).cos();
  return recording;
}

/// Adds nearly normal noise of standard deviation `sigma`: the sum of twelve uniform draws.
Recording Noisy(Recording recording, double sigma, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  for (double& value : recording.value) {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += std::ldexp(static_cast<double>(generator() >> 11), -53);
    value += sigma * sum;
  }
  return recording;
}

std::vector<std::string> Codes(const Recording& recording) {
  std::vector<std::string> codes;
  for (const Warning& warning : recording.warnings) codes.emplace_back(warning.code.text());
  return codes;
}

void ExpectUntouched(const Recording& recording) {
  const Recording repaired = RepairValues(recording);
  EXPECT_THAT(Codes(repaired), IsEmpty());
  EXPECT_EQ(repaired.time, recording.time);
  EXPECT_EQ(repaired.value, recording.value);
}

/// Largest distance of a repaired recording's readings from a curve.
template <typename Curve>
double FarthestFrom(const Recording& recording, const Curve& curve) {
  double farthest = 0;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    farthest = std::max(farthest, std::abs(recording.value[i] - curve(recording.time[i])));
  }
  return farthest;
}

// ---- Whole turns ----------------------------------------------------------------------------------------------------

/// The readings of a sensor that wraps around at `low`.
Recording Wrapped(Recording recording, double low) {
  for (double& value : recording.value) value -= 2 * kPi * std::floor((value - low) / (2 * kPi));
  return recording;
}

TEST(RepairValues, UnwrapsAnAngleAcrossTheSensorsZero) {
  Recording recording = Wrapped(Wave(0.5), 0);  // hangs at 0 = 360 deg: jumps at each of 16 passages
  recording.range = SensorRange{0, 2 * kPi};
  const Recording repaired = RepairValues(recording);
  ASSERT_THAT(Codes(repaired), ElementsAre("unwrapped"));
  EXPECT_EQ(
      MessageText(repaired.warnings[0]),
      "16 jumps by a whole turn, where the sensor's range begins again, were removed, so the angle is continuous");
  EXPECT_LT(FarthestFrom(repaired, [](double t) { return 0.5 * std::cos(5 * t); }), 1e-12);
  EXPECT_FALSE(repaired.range);
}

TEST(RepairValues, UnwrapsALargeSwingBeyondHalfATurn) {
  // The sensor is mounted at 60 deg and shows (-180, 180] deg.
  const Recording repaired = RepairValues(Wrapped(Wave(-2.5, kPi / 3), -kPi));
  ASSERT_THAT(Codes(repaired), ElementsAre("unwrapped"));
  EXPECT_LT(FarthestFrom(repaired, [](double t) { return kPi / 3 - 2.5 * std::cos(5 * t); }), 1e-12);
}

TEST(RepairValues, KeepsAnAngleOfMoreThanATurn) {
  Recording recording = Wave(2.0);
  recording.value.tail(500).array() += 2 * kPi;  // a jump of unknown cause
  const Recording repaired = RepairValues(recording);
  EXPECT_EQ(repaired.value, recording.value);
}

TEST(RepairValues, DoesNotUnwrapRatesOrCounts) {
  for (const std::string unit : {"rad/s", "counts"}) {
    Recording recording = Wrapped(Wave(0.5), 0);
    recording.unit = unit;
    if (unit == "rad/s") recording.quantity = Quantity::kRate;
    EXPECT_THAT(Codes(RepairValues(recording)), testing::Not(testing::Contains("unwrapped"))) << unit;
  }
}

// ---- Repeated readings ----------------------------------------------------------------------------------------------

TEST(RepairValues, RemovesATrackersRepeats) {
  for (const int times : {2, 3}) {
    SCOPED_TRACE(times);
    Recording recording = Wave(0.5);
    for (Eigen::Index i = 0; i < recording.size(); ++i) recording.value[i] = recording.value[i - i % times];
    const Recording repaired = RepairValues(recording);
    ASSERT_THAT(Codes(repaired), ElementsAre("stale_values"));
    const Eigen::Index left_out = recording.size() - repaired.size();
    EXPECT_EQ(MessageText(repaired.warnings[0]), std::to_string(left_out) +
                                                     " readings only repeat the previous one while the pendulum moves; "
                                                     "they are left out");
    EXPECT_THAT(static_cast<double>(left_out), testing::DoubleNear(1000.0 * (times - 1) / times, 10));
    EXPECT_LT(FarthestFrom(repaired, [](double t) { return 0.5 * std::cos(5 * t); }), 1e-3);
  }
}

TEST(RepairValues, RemovesAFrozenRunInMotion) {
  Recording recording = Wave(0.5);
  recording.value.segment(151, 5).setConstant(recording.value[150]);  // halfway down
  const Recording repaired = RepairValues(recording);
  ASSERT_THAT(Codes(repaired), ElementsAre("stale_values"));
  EXPECT_EQ(repaired.size(), 995);
  EXPECT_LT(FarthestFrom(repaired, [](double t) { return 0.5 * std::cos(5 * t); }), 1e-12);
}

TEST(RepairValues, KeepsRepeatsAtRestAndAtQuantizedTurningPoints) {
  Recording rest = Wave(0.5);  // held for 2 s, and at rest after six periods
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    rest.value[i] = 0.5 * std::cos(std::clamp(5 * (rest.time[i] - 2), 0.0, 12 * kPi));
  }
  Recording fast = rest;  // the reading after the hold is already far away
  fast.value = (fast.value / 1e-4).array().round() * 1e-4;
  fast.resolution = 1e-4;
  for (Eigen::Index i = 0; i < 190; ++i) fast.value[i] += 1e-4 * static_cast<double>(i % 2);
  EXPECT_EQ(RepairValues(fast).size(), fast.size());
  Recording quantized = Wave(0.5);
  for (double& value : quantized.value) value = 0.005 * std::round(value / 0.005);
  quantized.resolution = 0.005;
  EXPECT_EQ(RepairValues(quantized).value, quantized.value);
  EXPECT_EQ(RepairValues(rest).size(), rest.size());
}

// ---- Spikes ---------------------------------------------------------------------------------------------------------

TEST(RepairValues, RemovesOnlySpikes) {
  const Recording clean = Noisy(Wave(0.5), 0.002, 1);
  for (const double height : {0.1, -0.3, 3.0}) {
    Recording recording = clean;
    std::vector<Eigen::Index> spiked = {100, 333, 334, 700};  // two of them adjacent
    for (const Eigen::Index i : spiked) recording.value[i] += height;
    const Recording repaired = RepairValues(recording);
    ASSERT_THAT(Codes(repaired), ElementsAre("spikes")) << height;
    EXPECT_EQ(MessageText(repaired.warnings[0]), "4 readings far from their neighbours on both sides are left out");
    EXPECT_EQ(repaired.size(), 996);
    EXPECT_LT(FarthestFrom(repaired, [](double t) { return 0.5 * std::cos(5 * t); }), 0.013);  // limited by the noise
  }
}

TEST(RepairValues, RemovesReadingsThatDropToAFixedValue) {
  Recording recording = Noisy(Wave(0.5, 1), 0.002, 1);
  for (Eigen::Index i = 40; i < recording.size(); i += 97) recording.value[i] = 0;
  const Recording repaired = RepairValues(recording);
  EXPECT_THAT(Codes(repaired), ElementsAre("spikes"));
  EXPECT_EQ(repaired.size(), 990);
}

TEST(RepairValues, KeepsAKickAndARelease) {
  Recording kicked = Wave(0.5);  // its rate changes suddenly at 4.7 s, 0.3 s after a turning point
  for (Eigen::Index i = 470; i < kicked.size(); ++i) {
    kicked.value[i] += 0.3 * std::sin(5 * (kicked.time[i] - kicked.time[470]));
  }
  Recording released = Wave(0.5);
  for (Eigen::Index i = 0; i < released.size(); ++i) {
    released.value[i] = 0.5 * std::cos(5 * std::max(released.time[i] - 2, 0.0));
  }
  for (const Recording& recording : {kicked, released}) {
    ExpectUntouched(Noisy(recording, 0.002, 1));
    ExpectUntouched(Noisy(recording, 0.0001, 2));
  }
}

TEST(RepairValues, RarelyTreatsNoiseAsASpike) {
  Eigen::Index left_out = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const Recording recording = Noisy(Wave(0.5, 0, 300), 0.003, seed);
    left_out += recording.size() - RepairValues(recording).size();
  }
  EXPECT_THAT(left_out, Le(6));  // of 300,000
}

TEST(RepairValues, KeepsAllReadingsIfThereAreTooManySpikes) {
  Recording recording = Noisy(Wave(0.5), 0.002, 1);
  for (Eigen::Index i = 3; i < recording.size(); i += 7) recording.value[i] += 0.8;
  const Recording repaired = RepairValues(recording);
  ASSERT_THAT(Codes(repaired), ElementsAre("many_spikes"));
  EXPECT_EQ(repaired.value, recording.value);
  EXPECT_THAT(MessageText(repaired.warnings[0]),
              testing::EndsWith(" readings are far from their neighbours, too many to leave out"));
  EXPECT_THAT(std::stoi(MessageText(repaired.warnings[0])), testing::Ge(101));
}

// ---- Rows only at changes -------------------------------------------------------------------------------------------

/// An encoder of 0.01 rad per count.
Recording Counted(Eigen::Index count, double step) {
  Recording recording;
  recording.time = Eigen::ArrayXd::LinSpaced(count, 0, step * static_cast<double>(count - 1));
  recording.value = (0.01 * (50 * (5 * recording.time.array()).cos()).round()).matrix();
  recording.resolution = 0.01;
  return recording;
}

Recording OnlyChanges(const Recording& recording) {
  std::vector<Eigen::Index> kept = {0};
  for (Eigen::Index i = 1; i < recording.size(); ++i) {
    if (recording.value[i] != recording.value[i - 1]) kept.push_back(i);
  }
  Recording changes = recording;
  changes.time = recording.time(kept).eval();
  changes.value = recording.value(kept).eval();
  return changes;
}

TEST(RepairValues, DetectsRowsWrittenOnlyAtChanges) {
  const Recording repaired = RepairValues(OnlyChanges(Counted(20000, 5e-4)));
  ASSERT_THAT(Codes(repaired), ElementsAre("event_driven"));
  EXPECT_EQ(MessageText(repaired.warnings[0]),
            "the recording has rows only where the value changes; the angle is then at the edge of its count, half a "
            "count from the middle, and the error bars ignore this shift; record at equal intervals if possible");
}

TEST(RepairValues, FindsNoEventsInEvenSamples) {
  EXPECT_THAT(Codes(RepairValues(Counted(2000, 5e-3))), IsEmpty());
  EXPECT_THAT(Codes(RepairValues(Counted(20000, 5e-4))), testing::Not(testing::Contains("event_driven")));
}

// ---- Saturation ----------------------------------------------------------------------------------------------------

TEST(RepairValues, TreatsTheLevelOfFlatTopsAsARangeEnd) {
  Recording clipped = Noisy(Wave(0.6), 0.002, 5);
  clipped.value = clipped.value.cwiseMin(0.4);
  const Recording repaired = RepairValues(clipped);
  ASSERT_TRUE(repaired.range.has_value());
  EXPECT_EQ(repaired.range->high, 0.4);
  EXPECT_LT(repaired.range->low, -0.6);
  EXPECT_EQ(repaired.size(), clipped.size());
}

TEST(RepairValues, AcceptsRoundedTops) {
  Recording coarse = Wave(0.6);
  coarse.value = (coarse.value / 0.02).array().round() * 0.02;
  EXPECT_FALSE(RepairValues(coarse).range.has_value());
}

TEST(RepairValues, KeepsTheRangeGivenByTheFile) {
  Recording clipped = Wave(0.6);
  clipped.value = clipped.value.cwiseMin(0.4);
  clipped.range = SensorRange{-1, 0.4};
  EXPECT_EQ(RepairValues(clipped).range->low, -1);
  EXPECT_EQ(RepairValues(clipped).range->high, 0.4);
}

TEST(RepairValues, KeepsTheRangeIfSwingsBeginAtOneHeldAngle) {
  Recording held = Wave(0.6);
  held.range = SensorRange{-1, 1};
  held.value = held.time.unaryExpr([&](double t) {  // four times: lifted at speed, held, released without speed
    const double part = std::fmod(4 * t / held.time[held.size() - 1], 1.0);
    if (part < 0.02) return 30 * part;
    return part < 0.2 ? 0.6 : 0.6 * std::cos(40 * (part - 0.2)) * (1.2 - part);
  });
  held.value = (held.value / 0.001).array().round() * 0.001;
  const Recording repaired = RepairValues(held);
  EXPECT_EQ(repaired.range->high, 1);
  EXPECT_EQ(repaired.range->low, -1);
}

TEST(RepairValues, TreatsFlatTopsWithinTheRangeOfTheFileAsItsEnd) {
  Recording clipped = Noisy(Wave(0.6), 0.002, 5);
  clipped.value = clipped.value.cwiseMax(-0.3);  // a sensor that reaches a part of the converter's range
  clipped.range = SensorRange{-1, 1};
  const Recording repaired = RepairValues(clipped);
  EXPECT_EQ(repaired.range->low, -0.3);
  EXPECT_EQ(repaired.range->high, 1);
}

}  // namespace
}  // namespace pendulum::repair_values_test
