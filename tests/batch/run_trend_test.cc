// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/run_statistics.h"
#include "tests/batch/run_values.h"

namespace pendulum::run_trend_test {
namespace {

using run_values::kNone;
using run_values::NormalRuns;
using run_values::OneGroup;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// ---- FitTrend ------------------------------------------------------------------------------------------------------

/// The first set of F. J. Anscombe, The American Statistician 27:17 (1973).
RunValues Anscombe() {
  RunValues values = OneGroup({8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68});
  values.order = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  return values;
}

// scipy.stats.linregress(x, y), SciPy 1.10.1.
TEST(FitTrend, MatchesATextbookRegression) {
  const auto trend = FitTrend(Anscombe(), {});
  ASSERT_TRUE(trend);
  EXPECT_EQ(trend->runs, 11);
  EXPECT_NEAR(trend->slope, 0.5000909090909091, 1e-13);
  EXPECT_NEAR(trend->std_error, 0.11790550059563408, 1e-13);
  EXPECT_NEAR(trend->p, 0.00216962887307879, 1e-12);
}

// numpy.linalg.lstsq(np.c_[x, g == 0, g == 1], y): one slope and two levels, 8 degrees of freedom. Adding 100 to the
// second group changes nothing.
TEST(FitTrend, HasOneLevelPerGroup) {
  for (const double more : {0.0, 100.0}) {
    RunValues values = Anscombe();
    for (std::size_t i = 5; i < values.size(); ++i) {
      values.group[i] = 1;
      values.estimate[i] += more;
    }
    const auto trend = FitTrend(values, {});
    ASSERT_TRUE(trend);
    EXPECT_NEAR(trend->slope, 0.5181611570247864, 1e-12);
    EXPECT_NEAR(trend->std_error, 0.1320300316611298, 1e-12);
    EXPECT_NEAR(trend->p, 0.004390076485051971, 1e-11);
  }
}

TEST(FitTrend, IgnoresOutliersAndRunsWithoutAnOrder) {
  RunValues values = Anscombe();
  const auto add = [&](double estimate, double order) {
    values.estimate.push_back(estimate);
    values.order.push_back(order);
    values.std_error.push_back(kNone);
    values.group.push_back(0);
  };
  add(500, 7);
  add(-40, kNone);
  const auto trend = FitTrend(values, {{11, 99}});
  ASSERT_TRUE(trend);
  EXPECT_EQ(trend->runs, 11);
  EXPECT_NEAR(trend->slope, 0.5000909090909091, 1e-13);
}

// Under the null hypothesis p is below 5 % in 5 % of 2000 batches, with a standard deviation of 9.7.
TEST(FitTrend, HasACorrectProbability) {
  int below = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    if (FitTrend(NormalRuns(3, 4, 1, seed), {})->p < 0.05) ++below;
  }
  EXPECT_NEAR(below, 100, 4 * 9.7);
}

TEST(FitTrend, NeedsADegreeOfFreedomAndTwoOrderValues) {
  EXPECT_FALSE(FitTrend(OneGroup({}), {}));
  EXPECT_FALSE(FitTrend(OneGroup({1, 2}), {}));
  EXPECT_FALSE(FitTrend(OneGroup({1, 2, 3}), {{0, 9}}));
  RunValues same = OneGroup({1, 2, 3});
  same.order = {4, 4, 4};
  EXPECT_FALSE(FitTrend(same, {}));
  RunValues apart = OneGroup({1, 2, 3});
  apart.group = {0, 1, 2};
  EXPECT_FALSE(FitTrend(apart, {}));
}

TEST(FitTrend, FindsNoTrendWithoutScatter) {
  const auto trend = FitTrend(OneGroup({5, 5, 5}), {});
  ASSERT_TRUE(trend);
  EXPECT_EQ(trend->slope, 0);
  EXPECT_EQ(trend->p, 1);
}

// ---- ParseOrderValue -----------------------------------------------------------------------------------------------

TEST(ParseOrderValue, AcceptsNumbers) {
  bool is_date = true;
  EXPECT_EQ(ParseOrderValue("21.5", is_date), 21.5);
  EXPECT_FALSE(is_date);
  EXPECT_EQ(ParseOrderValue("-3e2", is_date), -300);
  EXPECT_EQ(ParseOrderValue("2026", is_date), 2026);
}

// Expected values from Python: datetime.date(...) - datetime.date(1970, 1, 1).
TEST(ParseOrderValue, ConvertsDatesToDays) {
  const std::vector<std::pair<const char*, double>> dates = {{"1970-01-01", 0},
                                                             {"1969-12-31", -1},
                                                             {"2024-02-29", 19782},
                                                             {"2026-03-01", 20513},
                                                             {"2026-03-01T12:00:00", 20513.5},
                                                             {"2026-03-01 18:00", 20513.75},
                                                             {"2026-03-01T12:00:00Z", 20513.5},
                                                             {"2026-03-01T12:00Z", 20513.5},
                                                             {"2026-03-01T13:30:00+01:30", 20513.5},
                                                             {"2026-03-01T00:00:00-06:00", 20513.25},
                                                             {"2026-03-01T00:00:21.6", 20513.00025}};
  for (const auto& [text, days] : dates) {
    bool is_date = false;
    const auto order = ParseOrderValue(text, is_date);
    ASSERT_TRUE(order) << text;
    EXPECT_TRUE(is_date) << text;
    EXPECT_NEAR(*order, days, 1e-9) << text;
  }
}

TEST(ParseOrderValue, RejectsOtherTexts) {
  for (const char* text : {"", "monday", "12 deg", "nan", "inf", "1,5", "2026-02-30", "2026-13-01", "2026-03", "--",
                           "01.03.2026", "03/01/2026"}) {
    bool is_date = true;
    EXPECT_FALSE(ParseOrderValue(text, is_date)) << text;
    EXPECT_FALSE(is_date) << text;
  }
}

TEST(ParseOrderValue, RejectsTextThatOnlyBeginsLikeADate) {
  for (const char* text : {"2026-03-01x", "2026-03-01 rig 7", "2026-03-01T25:00:00", "2026-03-01T12:61", "2026-03-01Z",
                           "2026-03-01T12:00:00z", "2026-03-01T12:00:00+1", "2026-03-01T12:00+01:00Z"}) {
    bool is_date = false;
    EXPECT_FALSE(ParseOrderValue(text, is_date)) << text;
  }
}

}  // namespace
}  // namespace pendulum::run_trend_test
