// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/encoder_edges.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::encoder_edges_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

constexpr double kResolution = 0.01;  // rad

Recording Of(const std::vector<double>& time, const std::vector<double>& counts) {
  Recording recording;
  const auto size = static_cast<Eigen::Index>(time.size());
  recording.time = Eigen::Map<const Eigen::VectorXd>(time.data(), size);
  recording.value = kResolution * Eigen::Map<const Eigen::VectorXd>(counts.data(), size);
  recording.resolution = kResolution;
  return recording;
}

/// A cos ωt in counts, every `step` s. With `changes`, rows that repeat a count are left out.
Recording Wave(double amplitude, double step, bool changes) {
  constexpr double kRate = 5;  // rad/s
  std::vector<double> time, counts;
  for (double t = 0; t < 10; t += step) {
    const double count = std::round(amplitude * std::cos(kRate * t) / kResolution);
    if (changes && !counts.empty() && count == counts.back()) continue;
    time.push_back(t);
    counts.push_back(count);
  }
  return Of(time, counts);
}

TEST(IsEventDriven, DetectsRowsAtChangesOfTheCount) {
  EXPECT_TRUE(IsEventDriven(Wave(0.5, 1e-4, true)));
  EXPECT_TRUE(IsEventDriven(Wave(0.05, 1e-4, true)));
  EXPECT_TRUE(IsEventDriven(Wave(0.5, 2e-3, true)));
}

TEST(IsEventDriven, IsFalseForEvenSamples) {
  for (const double amplitude : {0.02, 0.05, 0.2, 0.5, 1.0}) {
    for (const double step : {1e-3, 4e-3, 1e-2, 2e-2}) {
      EXPECT_FALSE(IsEventDriven(Wave(amplitude, step, false))) << amplitude << " rad, every " << step << " s";
    }
  }
}

TEST(IsEventDriven, NeedsAnAngleOnLevels) {
  Recording recording = Wave(0.5, 1e-4, true);
  recording.resolution = 0;
  EXPECT_FALSE(IsEventDriven(recording));
  recording.resolution = kResolution;
  recording.quantity = Quantity::kRate;
  EXPECT_FALSE(IsEventDriven(recording));
  EXPECT_FALSE(IsEventDriven(Of({0, 1, 2.5, 3, 4, 5.5, 6, 7, 8}, {0, 1, 2, 1, 0, 1, 2, 3, 2})));
}

TEST(ConvertToEdges, PlacesARowOnTheEdgeThatTheCountCrossed) {
  // Up to count 3 and back down past 0. By hand: edges at half counts, silences in count 3 and for the first row in
  // count 0.
  const Recording edges = ConvertToEdges(Of({0, 1, 2, 3, 5, 6, 7, 8}, {0, 1, 2, 3, 2, 1, 0, -1}));
  const std::vector<double> time = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<double> counts = {0, 0.5, 1.5, 2.5, 3, 2.5, 1.5, 0.5, -0.5};
  ASSERT_EQ(edges.size(), 9);
  for (Eigen::Index i = 0; i < 9; ++i) {
    EXPECT_EQ(edges.time[i], time[static_cast<std::size_t>(i)]);
    EXPECT_THAT(edges.value[i], DoubleNear(kResolution * counts[static_cast<std::size_t>(i)], 1e-15));
  }
  ASSERT_TRUE(edges.edge);
  EXPECT_THAT(std::remainder(*edges.edge - 0.5 * kResolution, kResolution), DoubleNear(0, 1e-15));
  ASSERT_EQ(edges.warnings.size(), 1);
  EXPECT_EQ(edges.warnings[0].code, "event_driven");
  EXPECT_THAT(MessageText(edges.warnings[0]), HasSubstr("at the 2 turning points and rests"));
}

TEST(ConvertToEdges, UsesTheEnteredEdgeIfRowsWereMissed) {
  const Recording edges = ConvertToEdges(Of({0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 3, 4, 5, 4, 2, 1}));
  EXPECT_THAT(edges.value[2], DoubleNear(2.5 * kResolution, 1e-15));
  EXPECT_THAT(edges.value[7], DoubleNear(2.5 * kResolution, 1e-15));  // after the silence at the turning point
}

TEST(ConvertToEdges, TreatsARepeatedCountAsASilence) {
  const Recording edges = ConvertToEdges(Of({0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 2, 3, 4, 5, 6}));
  EXPECT_THAT(edges.value[3], DoubleNear(2 * kResolution, 1e-15));
}

/// One row goes backwards within a long fast motion, because a busy logger let the counter miss edges.
TEST(ConvertToEdges, RemovesRowsOfACounterSlip) {
  std::vector<double> time, counts;
  for (int i = 0; i < 24; ++i) {
    time.push_back(i);
    counts.push_back(i < 12 ? i : i - 4);  // 11, 8, ...: three edges missed, one counted backwards
  }
  const Recording edges = ConvertToEdges(Of(time, counts));
  ASSERT_EQ(edges.size(), 23);
  EXPECT_EQ(edges.time[12], 13);
  EXPECT_THAT(edges.value[11], DoubleNear(10.5 * kResolution, 1e-15));
  EXPECT_THAT(edges.value[12], DoubleNear(8.5 * kResolution, 1e-15));
  EXPECT_THAT(MessageText(edges.warnings[0]), HasSubstr("1 row in the wrong direction left out"));
}

TEST(EdgeDirections, AreTheCrossingDirectionsOfEdges) {
  const Recording edges = ConvertToEdges(Of({0, 1, 2, 3, 5, 6, 7, 8}, {0, 1, 2, 3, 2, 1, 0, -1}));
  const Eigen::VectorXd directions = EdgeDirections(edges);
  const std::vector<double> expected = {0, 1, 1, 1, 0, -1, -1, -1, -1};
  EXPECT_EQ(std::vector<double>(directions.begin(), directions.end()), expected);
}

TEST(ConvertToEdges, RemovesAFirstRowBeforeAHold) {
  const Recording edges = ConvertToEdges(Of({-20, 1, 2, 3, 5, 6, 7, 8}, {0, 1, 2, 3, 2, 1, 0, -1}));
  EXPECT_EQ(edges.time[0], 1);
}

}  // namespace
}  // namespace pendulum::encoder_edges_test
