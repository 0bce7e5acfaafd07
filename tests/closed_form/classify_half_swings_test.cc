// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/classify_half_swings.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::classify_half_swings_test {
namespace {

using testing::Each;

constexpr double kHalfPeriod = 0.5;  // s
constexpr double kStep = 0.01;       // s

/// A decaying cosine of 0.2 rad about 0.1 rad: half swing i lies in [i, i + 1] kHalfPeriod.
double Decaying(double time) { return 0.1 + 0.2 * std::exp(-0.05 * time) * std::cos(kPi * time / kHalfPeriod); }

Recording Sampled(const std::function<double(double)>& reading, double duration = 6.2) {
  Recording recording;
  const auto count = static_cast<Eigen::Index>(duration / kStep);
  recording.time = Eigen::VectorXd::LinSpaced(count, 0, kStep * static_cast<double>(count - 1));
  recording.value = recording.time.unaryExpr(reading);
  return recording;
}

/// The half swing that contains a time.
std::size_t HalfSwingAt(const TurningPointTable& table, double time) {
  std::size_t i = 0;
  while (table.points[i + 1].time < time) ++i;
  return i;
}

TEST(ClassifyHalfSwings, AcceptsADecayingCosineAsFree) {
  const Recording recording = Sampled(Decaying);
  EXPECT_THAT(ClassifyHalfSwings(recording, FindAllTurningPoints(recording)), Each(Verdict::kFree));
}

TEST(ClassifyHalfSwings, DetectsALastingGainOfAmplitude) {
  const Recording recording = Sampled([](double t) { return t < 3 ? Decaying(t) : 0.1 + 1.5 * (Decaying(t) - 0.1); });
  const TurningPointTable table = FindAllTurningPoints(recording);
  const std::vector<Verdict> verdicts = ClassifyHalfSwings(recording, table);
  EXPECT_EQ(verdicts[HalfSwingAt(table, 2.75)], Verdict::kGains);
  EXPECT_EQ(verdicts[HalfSwingAt(table, 4.75)], Verdict::kFree);
}

TEST(ClassifyHalfSwings, TreatsASingleHighTurningPointAsAnOutlier) {
  const Recording recording =
      Sampled([](double t) { return std::abs(t - 3) < 0.2 ? 0.1 + 1.3 * (Decaying(t) - 0.1) : Decaying(t); });
  EXPECT_THAT(ClassifyHalfSwings(recording, FindAllTurningPoints(recording)), Each(Verdict::kFree));
}

TEST(ClassifyHalfSwings, DetectsBraking) {
  const Recording recording =
      Sampled([](double t) { return t < 3.25 ? Decaying(t) : 0.1 + 0.5 * (Decaying(t) - 0.1); });
  const TurningPointTable table = FindAllTurningPoints(recording);
  EXPECT_EQ(ClassifyHalfSwings(recording, table)[HalfSwingAt(table, 3.25)], Verdict::kIrregular);
}

TEST(ClassifyHalfSwings, DetectsTimeSlipsOfAFortiethOfAPeriod) {
  const Recording recording = Sampled([](double t) { return Decaying(t < 3.25 ? t : t + 0.03); });
  const TurningPointTable table = FindAllTurningPoints(recording);
  const std::vector<Verdict> verdicts = ClassifyHalfSwings(recording, table);
  EXPECT_EQ(verdicts[HalfSwingAt(table, 3.25)], Verdict::kIrregular);
  EXPECT_EQ(verdicts[HalfSwingAt(table, 1.25)], Verdict::kFree);
  EXPECT_EQ(verdicts[HalfSwingAt(table, 5.25)], Verdict::kFree);
}

/// The last turning point comes 60 ms early. If its amplitude is above the threshold, time has slipped. If not, as just
/// before standstill, its time is uncertain.
TEST(ClassifyHalfSwings, TrustsTheTimeOfALastTurningPointAboveTheThreshold) {
  for (const bool above_threshold : {true, false}) {
    const Recording recording = Sampled(Decaying);
    TurningPointTable table = FindAllTurningPoints(recording);
    table.points.back().time -= 0.06;
    table.threshold = table.Amplitude(table.half_swings()) * (above_threshold ? 0.9 : 1.1);
    EXPECT_EQ(ClassifyHalfSwings(recording, table).back(), above_threshold ? Verdict::kIrregular : Verdict::kFree);
  }
}

TEST(ClassifyHalfSwings, DistinguishesAHoldFromATurningPoint) {
  const Recording recording = Sampled([](double t) { return t < 1 ? 0.301 : Decaying(t - 1); });
  const std::vector<Verdict> verdicts = ClassifyHalfSwings(recording, FindAllTurningPoints(recording));
  EXPECT_EQ(verdicts.front(), Verdict::kFreeAfterHold);
  EXPECT_EQ(verdicts[1], Verdict::kFree);
}

TEST(ClassifyHalfSwings, AllowsTurningPointsMissingInAGap) {
  Recording recording = Sampled(Decaying);
  const Eigen::Index first = 230;  // 2.3 s to 3.4 s are missing: two turning points
  const Eigen::Index rest = recording.size() - 340;
  recording.time.segment(first, rest) = recording.time.tail(rest).eval();
  recording.value.segment(first, rest) = recording.value.tail(rest).eval();
  recording.time.conservativeResize(first + rest);
  recording.value.conservativeResize(first + rest);
  EXPECT_THAT(ClassifyHalfSwings(recording, FindAllTurningPoints(recording)), Each(Verdict::kFree));
}

}  // namespace
}  // namespace pendulum::classify_half_swings_test
