// SPDX-License-Identifier: Apache-2.0
#include "recording/time_grid.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace pendulum::time_grid_test {
namespace {

/// 2000 times that `time_of` gives for the rows 0, 1, ...
Eigen::VectorXd Times(const auto& time_of) {
  Eigen::VectorXd times(2000);
  for (Eigen::Index i = 0; i < times.size(); ++i) times[i] = time_of(static_cast<double>(i));
  return times;
}

double RoundedTo(double place, double number) { return place * std::round(number / place); }

TEST(LastPlace, IsThatOfTheNumberWithMostDecimals) {
  EXPECT_DOUBLE_EQ(LastPlace(Eigen::Vector3d(0, 0.25, 1.375)), 1e-3);
  EXPECT_DOUBLE_EQ(LastPlace(Eigen::Vector3d(0, 10, 20)), 1);
}

TEST(AreOnGrid, AcceptsCountedTimes) {
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return 0.01 * i; })));
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return RoundedTo(1e-6, i / 60); })));  // rounded
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return RoundedTo(1, 1000 * i / 60); })));
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return RoundedTo(1, 1000 * i / 120); })));
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return 1.7e9 + RoundedTo(1e-3, 0.01 * i); })));               // since 1970
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return RoundedTo(1e-3, (i + (i > 700 ? 50 : 0)) / 30); })));  // a gap
  EXPECT_TRUE(AreOnGrid(Times([](double i) { return 10 * (i + (i > 700 ? 3 : 0)); })));  // three rows are missing
}

// A timer of a microcontroller whose stamps have steps of 4 us, a loop that waits with delay(10), a computer's stamps.
TEST(AreOnGrid, RejectsMeasuredTimes) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  EXPECT_FALSE(AreOnGrid(Times([&](double i) { return 4e-6 * std::floor(2500 * i + 2 * uniform(random)); })));
  double now = 0;
  EXPECT_FALSE(AreOnGrid(Times([&](double) { return std::floor(now += 10.1 + 0.3 * uniform(random)); })));
  EXPECT_FALSE(AreOnGrid(Times([&](double i) { return RoundedTo(1e-3, 0.01 * i + 0.002 * uniform(random)); })));
  now = 0;  // a loop of 10.2 to 10.5 ms that prints two decimals
  EXPECT_FALSE(AreOnGrid(Times([&](double) { return RoundedTo(0.01, now += 0.0102 + 0.0003 * uniform(random)); })));
}

TEST(AreOnGrid, NeedsTimesThatIncrease) {
  EXPECT_FALSE(AreOnGrid(Eigen::Vector2d(0, 1)));
  EXPECT_FALSE(AreOnGrid(Eigen::Vector4d(0, 1, 1, 2)));
}

}  // namespace
}  // namespace pendulum::time_grid_test
