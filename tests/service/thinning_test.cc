// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/thinning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::thinning_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

using Numbers = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Times 0, 1, ... s.
Numbers Seconds(std::size_t count) {
  Numbers time(count);
  for (std::size_t i = 0; i < count; ++i) time[i] = static_cast<double>(i);
  return time;
}

bool IsIncreasing(const std::vector<Eigen::Index>& indices) {
  return std::ranges::adjacent_find(indices, std::ranges::greater_equal()) == indices.end();
}

TEST(Thin, KeepsAllOfAFewSamples) {
  EXPECT_THAT(Thin(Seconds(4), Numbers{1, 2, 3, kNan}, 4), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(Thin(Seconds(1), Numbers{1}, 4), ElementsAre(0));
  EXPECT_THAT(Thin(Numbers(), Numbers(), 4), IsEmpty());
}

// Expected blocks: [0, 5) and [5, 10] without the ends 0 and 10.
TEST(Thin, KeepsTheExtremesOfEachBlockInTheirOrder) {
  const Numbers value = {9, 3, 8, 1, 5, 2, 2, 7, -4, 3, 0};
  EXPECT_THAT(Thin(Seconds(11), value, 6), ElementsAre(0, 2, 3, 7, 8, 10));
  EXPECT_THAT(Thin(Seconds(11), value, 7), ElementsAre(0, 2, 3, 7, 8, 10));
  EXPECT_THAT(Thin(Seconds(11), value, 4), ElementsAre(0, 2, 8, 10));
}

TEST(Thin, KeepsOneSampleOfAConstantBlock) {
  EXPECT_THAT(Thin(Seconds(9), Numbers(9, 5.0), 6), ElementsAre(0, 1, 4, 8));
}

// The two blocks have equal durations. Each contains one group of samples; the gap between the groups has none.
TEST(Thin, GivesNoSamplesInAGap) {
  const Numbers time = {0, 1, 2, 3, 97, 98, 99, 100};
  EXPECT_THAT(Thin(time, Numbers{0, 1, 2, 3, 4, 5, 6, 7}, 6), ElementsAre(0, 1, 3, 4, 6, 7));
}

TEST(Thin, IgnoresNaNAsAnExtreme) {
  EXPECT_THAT(Thin(Seconds(9), Numbers{0, kNan, 3, kNan, kNan, kNan, kNan, kNan, kNan}, 6), ElementsAre(0, 2, 8));
  EXPECT_THAT(Thin(Seconds(9), Numbers(9, kNan), 6), ElementsAre(0, 8));
}

// The limits and properties that the declaration documents must hold for any number of samples.
TEST(Thin, KeepsItsGuaranteesForASwing) {
  for (const std::size_t size : {5U, 4001U, 4002U, 8001U, 100'003U}) {
    Numbers time(size), value(size);
    for (std::size_t i = 0; i < size; ++i) {
      time[i] = 0.005 * static_cast<double>(i) + 1e-3 * std::sin(static_cast<double>(i));
      value[i] = std::exp(-0.01 * time[i]) * std::sin(6 * time[i]);
    }
    for (const Eigen::Index most : {4, 5, 100, 4000}) {
      const auto chosen = Thin(time, value, most);
      EXPECT_LE(chosen.size(), most);
      EXPECT_TRUE(IsIncreasing(chosen));
      EXPECT_EQ(chosen.front(), 0);
      EXPECT_EQ(chosen.back(), size - 1);
      EXPECT_THAT(chosen, Contains(std::ranges::max_element(value) - value.begin()));
      EXPECT_THAT(chosen, Contains(std::ranges::min_element(value) - value.begin()));
    }
  }
}

TEST(Thin, UsesItsFullLimit) {
  constexpr std::size_t kMany = 100'000;
  Numbers value(kMany);
  for (std::size_t i = 0; i < kMany; ++i) value[i] = std::sin(static_cast<double>(i));
  EXPECT_EQ(Thin(Seconds(kMany), value, 4000).size(), 4000);
}

// Files may contain times that do not increase or are infinite.
TEST(Thin, RespectsItsLimitForAnyTimes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Numbers value = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  for (const Numbers& time : {Numbers(10, 1.0), Numbers(10, kNan), Numbers(10, kInfinity),
                              Numbers{9, 8, 7, 6, 5, 4, 3, 2, 1, 0}, Numbers{-1e308, 0, 0, 0, 0, 0, 0, 0, 0, 1e308}}) {
    const auto chosen = Thin(time, value, 6);
    EXPECT_LE(chosen.size(), 6);
    EXPECT_TRUE(IsIncreasing(chosen));
    EXPECT_EQ(chosen.back(), 9);
  }
}

}  // namespace
}  // namespace pendulum::thinning_test
