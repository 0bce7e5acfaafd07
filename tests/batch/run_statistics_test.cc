// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/run_statistics.h"

#include <algorithm>
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

#include "pendulum/base/distributions.h"
#include "tests/batch/run_values.h"

namespace pendulum::run_statistics_test {
namespace {

using run_values::kNone;
using run_values::NormalRuns;
using run_values::OneGroup;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// ---- Describe ------------------------------------------------------------------------------------------------------

const std::vector<double> kTen = {2.1, 3.7, 1.4, 5.9, 4.4, 2.8, 3.3, 6.2, 3.1, 2.5};

// np.percentile(x, [0, 25, 50, 75, 100]) is type 7 of Hyndman and Fan, R's default; also x.mean(), x.std(ddof=1).
TEST(Describe, GivesQuartilesMeanAndStandardDeviation) {
  const Distribution distribution = Describe(kTen);
  EXPECT_EQ(distribution.minimum, 1.4);
  EXPECT_DOUBLE_EQ(distribution.lower_quartile, 2.575);
  EXPECT_DOUBLE_EQ(distribution.median, 3.2);
  EXPECT_DOUBLE_EQ(distribution.upper_quartile, 4.225);
  EXPECT_EQ(distribution.maximum, 6.2);
  EXPECT_DOUBLE_EQ(distribution.mean, 3.54);
  EXPECT_NEAR(distribution.std_dev, 1.5614807786912468, 1e-14);
}

// np.histogram(x, bins=np.histogram_bin_edges(x, 'fd')): edges 1.4, 2.6, 3.8, 5.0, 6.2.
TEST(Describe, UsesTheBinsOfFreedmanAndDiaconis) {
  const Distribution distribution = Describe(kTen);
  EXPECT_EQ(distribution.from, 1.4);
  EXPECT_EQ(distribution.to, 6.2);
  EXPECT_THAT(distribution.counts, ElementsAre(3, 4, 1, 2));
  EXPECT_EQ(distribution.below, 0);
  EXPECT_EQ(distribution.above, 0);
}

// The quartiles of 0..100 with an outlier on each side are 24.5 and 75.5, so bins end at 75.5 + 3 · 51 at most. No
// value is lost, and the histogram has more than one bar.
TEST(Describe, CountsOutliersOutsideTheBins) {
  std::vector<double> values(101);
  std::iota(values.begin(), values.end(), 0);
  values.push_back(1e6);
  values.push_back(-1e6);
  const Distribution distribution = Describe(values);
  EXPECT_DOUBLE_EQ(distribution.lower_quartile, 24.5);
  EXPECT_DOUBLE_EQ(distribution.upper_quartile, 75.5);
  EXPECT_DOUBLE_EQ(distribution.from, 24.5 - 3 * 51);
  EXPECT_DOUBLE_EQ(distribution.to, 75.5 + 3 * 51);
  EXPECT_EQ(distribution.below, 1);
  EXPECT_EQ(distribution.above, 1);
  EXPECT_EQ(std::accumulate(distribution.counts.begin(), distribution.counts.end(), std::size_t{0}), 101);
}

// For 10^6 equally spaced values the rule gives a bin width of 2 · 500000 / 100, which would be 100 bins.
TEST(Describe, HasAtMostSixtyBins) {
  std::vector<double> values(1000000);
  std::iota(values.begin(), values.end(), 0);
  EXPECT_THAT(Describe(values).counts, SizeIs(60));
}

TEST(Describe, HasOneBinForEqualValues) {
  const Distribution one = Describe({2.5});
  EXPECT_EQ(one.median, 2.5);
  EXPECT_EQ(one.std_dev, 0);
  EXPECT_THAT(one.counts, ElementsAre(1));
  const Distribution same = Describe({2.5, 2.5, 2.5});
  EXPECT_EQ(same.from, 2.5);
  EXPECT_EQ(same.to, 2.5);
  EXPECT_THAT(same.counts, ElementsAre(3));
}

TEST(Describe, CountsEveryValueOnce) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const RunValues values = NormalRuns(1, 300, 1, seed);
    const Distribution distribution = Describe(values.estimate);
    const std::size_t inside = std::accumulate(distribution.counts.begin(), distribution.counts.end(), std::size_t{0});
    EXPECT_EQ(inside + distribution.below + distribution.above, 300);
  }
}

// ---- FindOutliers --------------------------------------------------------------------------------------------------

// False alarm rate of this rule in an independent simulation (NumPy, 4000 batches per size): 3.3 to 4.4 % for 5 to 200
// runs. 1 % is four standard deviations of the rate.
// Median 3; distances 2, 1, 0, 1 and 97 from it have the median 1. Φ⁻¹(3/4) = 1/1.4826.
TEST(RobustStdDev, IgnoresAnOutlier) {
  EXPECT_DOUBLE_EQ(MedianOf({4, 1, 3, 2}), 2.5);
  EXPECT_DOUBLE_EQ(MedianOf({1, 2, 3, 4, 100}), 3);
  EXPECT_NEAR(RobustStdDev({1, 2, 3, 4, 100}), 1 / NormalQuantile(0.75), 1e-4);
}

TEST(FindOutliers, HasAFalseAlarmOnceInTwentyBatches) {
  constexpr int kBatches = 3000;
  for (const std::size_t runs : {5U, 20U, 100U}) {
    int alarms = 0;
    for (int seed = 0; seed < kBatches; ++seed) {
      if (!FindOutliers(NormalRuns(1, runs, 1, static_cast<std::uint64_t>(seed) + 1)).empty()) ++alarms;
    }
    EXPECT_GT(alarms, 0.025 * kBatches) << runs;
    EXPECT_LT(alarms, 0.06 * kBatches) << runs;
  }
}

TEST(FindOutliers, ListsTheFarthestRunFirstWithItsDistance) {
  RunValues values = OneGroup({10, 11, 9, 10.5, 30, 9.5, -30, 10});
  std::ranges::fill(values.std_error, 2);
  const auto outliers = FindOutliers(values);
  ASSERT_THAT(outliers, SizeIs(2));
  EXPECT_EQ(outliers[0].run, 6);
  EXPECT_DOUBLE_EQ(outliers[0].z, 20);  // a distance of 40 from the median 10, with errors of 2
  EXPECT_EQ(outliers[1].run, 4);
  EXPECT_DOUBLE_EQ(outliers[1].z, 10);
}

// Distances 0, 0, 0.5, 0.5, 1, 1, 20 from the median 10: their median is 0.5, and the scale is 1.4826 · 0.5.
TEST(FindOutliers, UsesTheScatterIfThereAreNoErrors) {
  const auto outliers = FindOutliers(OneGroup({10, 11, 9, 10.5, 30, 9.5, 10}));
  ASSERT_THAT(outliers, SizeIs(1));
  EXPECT_EQ(outliers[0].run, 4);
  EXPECT_NEAR(outliers[0].z, 20 / (1.4826 * 0.5), 1e-12);
}

// st.norm.isf((1 - 0.95 ** (1 / 6)) / 2) = 2.63104 for six runs.
TEST(FindOutliers, UsesTheLimitOfSidak) {
  for (const auto& [value, count] : {std::pair{2.631, 0}, std::pair{2.632, 1}}) {
    EXPECT_THAT(FindOutliers(OneGroup({-0.2, 0.1, 0, -0.1, value, 0}, 1)), SizeIs(count)) << value;
  }
}

TEST(FindOutliers, ComparesRunsWithinTheirGroup) {
  RunValues values = NormalRuns(2, 10, 1, 7);  // groups at about 100 and 150
  EXPECT_THAT(FindOutliers(values), IsEmpty());
  values.estimate[4] = 150;  // in the first group
  const auto outliers = FindOutliers(values);
  ASSERT_THAT(outliers, SizeIs(1));
  EXPECT_EQ(outliers[0].run, 4);
}

TEST(FindOutliers, NeedsFiveRuns) {
  EXPECT_THAT(FindOutliers(OneGroup({1, 1, 1, 1000}, 0.1)), IsEmpty());
  EXPECT_THAT(FindOutliers(OneGroup({1, 1, 1, 1, 1000}, 0.1)), SizeIs(1));
  EXPECT_THAT(FindOutliers(OneGroup({})), IsEmpty());
}

TEST(FindOutliers, FindsNoOutlierIfRobustScaleAndErrorsAreZero) {
  EXPECT_THAT(FindOutliers(OneGroup({1, 1, 1, 1, 1000})), IsEmpty());
}

// ---- AnalyzeRepeatability ------------------------------------------------------------------------------------------

// Weights 1, 1, 1/4: mean 25.5 / 2.25, chi2 = (4/3)² + (2/3)² + (8/3)² / 4 = 4. With two degrees of freedom p is
// exp(-chi2 / 2).
TEST(AnalyzeRepeatability, MatchesThreeRunsComputedByHand) {
  RunValues values = OneGroup({10, 12, 14});
  values.std_error = {1, 1, 2};
  const auto repeatability = AnalyzeRepeatability(values, {});
  ASSERT_TRUE(repeatability);
  ASSERT_THAT(repeatability->groups, SizeIs(1));
  const GroupRepeatability& group = repeatability->groups[0];
  EXPECT_EQ(group.runs, 3);
  EXPECT_NEAR(group.mean, 25.5 / 2.25, 1e-13);
  EXPECT_NEAR(group.std_error, 1 / 1.5, 1e-13);
  EXPECT_NEAR(group.chi2, 4, 1e-12);
  EXPECT_NEAR(group.ScatterRatio(), std::sqrt(2), 1e-12);
  EXPECT_NEAR(group.P(), std::exp(-2), 1e-12);
  EXPECT_EQ(repeatability->runs, 3);
  EXPECT_EQ(repeatability->dof, 2);
  EXPECT_NEAR(repeatability->upper_p, std::exp(-2), 1e-12);
  EXPECT_NEAR(repeatability->lower_p, 1 - std::exp(-2), 1e-12);
  EXPECT_EQ(repeatability->verdict, Repeatability::Verdict::kAgrees);
}

// With equal errors the equation of Paule and Mandel is between² = s² - error²: 4 - 1 and 16 - 1. With 2 and 1 degrees
// of freedom the result is sqrt((2 · 3 + 1 · 15) / 3).
// Quantiles 0.025 and 0.975 of χ²: M. Abramowitz and I. A. Stegun, table 26.8. 1.96: table 26.5.
TEST(GroupRepeatability, HasIntervalsOfScatterAndMean) {
  const GroupRepeatability group{.group = 0, .runs = 11, .mean = 2, .std_error = 0.1, .chi2 = 22.5, .between = 0};
  EXPECT_NEAR(group.ScatterRatio(), 1.5, 1e-12);
  const auto [low, high] = group.ScatterInterval();
  EXPECT_NEAR(low, std::sqrt(22.5 / 20.4831), 1e-5);
  EXPECT_NEAR(high, std::sqrt(22.5 / 3.24697), 1e-5);
  const auto [from, to] = group.MeanInterval();
  EXPECT_NEAR(from, 2 - 0.196, 1e-5);
  EXPECT_NEAR(to, 2 + 0.196, 1e-5);
}

// p 0.001 is expected among a hundred groups: χ² with one degree of freedom exceeds 10.828 with this probability.
TEST(Repeatability, NamesAGroupOnlyIfItsPIsSmallAmongAllGroups) {
  const GroupRepeatability group{.group = 0, .runs = 2, .mean = 0, .std_error = 1, .chi2 = 10.828, .between = 0};
  Repeatability all;
  all.groups = std::vector<GroupRepeatability>(3, group);
  EXPECT_TRUE(all.Disagrees(group));
  all.groups.resize(100, group);
  EXPECT_FALSE(all.Disagrees(group));
  all.dof = 19;
  EXPECT_FALSE(all.HasEnoughRuns());
  all.dof = 20;
  EXPECT_TRUE(all.HasEnoughRuns());
}

TEST(AnalyzeRepeatability, CombinesGroupsByTheirDegreesOfFreedom) {
  RunValues values = OneGroup({10, 12, 14, 100, 100 + std::sqrt(32)}, 1);
  values.group = {0, 0, 0, 1, 1};
  const auto repeatability = AnalyzeRepeatability(values, {});
  ASSERT_TRUE(repeatability);
  ASSERT_THAT(repeatability->groups, SizeIs(2));
  EXPECT_NEAR(repeatability->groups[0].between, std::sqrt(3), 1e-6);
  EXPECT_NEAR(repeatability->groups[1].between, std::sqrt(15), 1e-6);
  EXPECT_NEAR(repeatability->between, std::sqrt(7), 1e-6);
  EXPECT_EQ(repeatability->dof, 3);
  EXPECT_NEAR(repeatability->chi2, 8 + 16, 1e-9);
  EXPECT_NEAR(repeatability->ScatterRatio(), std::sqrt(8), 1e-9);
}

/// Number of batches with a verdict other than kAgrees, although their errors are right. Each of three rigs has `runs`
/// runs.
int FalseVerdicts(int batches, std::size_t runs) {
  int verdicts = 0;
  for (int seed = 0; seed < batches; ++seed) {
    const auto repeatability = AnalyzeRepeatability(NormalRuns(3, runs, 1, static_cast<std::uint64_t>(seed) + 1), {});
    if (repeatability->verdict != Repeatability::Verdict::kAgrees) ++verdicts;
  }
  return verdicts;
}

// p below 1 % on either side: 2 % of 2000 batches, with a standard deviation of 6.3.
TEST(AnalyzeRepeatability, HasTwoFalseAlarmsInAHundredBatches) {
  const int verdicts = FalseVerdicts(2000, 10);
  EXPECT_GT(verdicts, 40 - 4 * 6.3);
  EXPECT_LT(verdicts, 40 + 4 * 6.3);
}

// Standard deviation 2, errors 1: between is sqrt(3); with 198 degrees of freedom its standard error is 0.115.
TEST(AnalyzeRepeatability, DetectsAndQuantifiesErrorsThatAreTooSmall) {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const auto repeatability = AnalyzeRepeatability(NormalRuns(2, 100, 2, seed), {});
    ASSERT_TRUE(repeatability);
    EXPECT_EQ(repeatability->verdict, Repeatability::Verdict::kScatterLarger);
    EXPECT_NEAR(repeatability->between, std::sqrt(3), 4 * 0.115);
    EXPECT_NEAR(repeatability->ScatterRatio(), 2, 4 * 0.1);
    EXPECT_LT(repeatability->upper_p, 1e-6);
  }
}

TEST(AnalyzeRepeatability, DetectsErrorsThatAreTooLarge) {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const auto repeatability = AnalyzeRepeatability(NormalRuns(2, 100, 0.5, seed), {});
    ASSERT_TRUE(repeatability);
    EXPECT_EQ(repeatability->verdict, Repeatability::Verdict::kScatterSmaller);
    EXPECT_EQ(repeatability->between, 0);
    EXPECT_LT(repeatability->lower_p, 1e-6);
  }
}

// Rigs that differ by 50, with errors of 1: as one group they would not repeat.
TEST(AnalyzeRepeatability, DoesNotTreatDifferentRigsAsScatter) {
  RunValues values = NormalRuns(5, 20, 1, 3);
  const auto by_rig = AnalyzeRepeatability(values, {});
  ASSERT_TRUE(by_rig);
  EXPECT_EQ(by_rig->verdict, Repeatability::Verdict::kAgrees);
  values.group.assign(values.size(), 0);
  const auto together = AnalyzeRepeatability(values, {});
  ASSERT_TRUE(together);
  EXPECT_EQ(together->verdict, Repeatability::Verdict::kScatterLarger);
  EXPECT_GT(together->between, 50);
}

// 5 % more scatter is significant in 20000 runs, but too small to report.
TEST(AnalyzeRepeatability, NeedsADifferenceOfTenPercent) {
  for (const double scatter : {1.05, 0.95}) {
    const auto repeatability = AnalyzeRepeatability(NormalRuns(1, 20000, scatter, 1), {});
    ASSERT_TRUE(repeatability);
    EXPECT_LT(std::min(repeatability->lower_p, repeatability->upper_p), 1e-6);
    EXPECT_EQ(repeatability->verdict, Repeatability::Verdict::kAgrees) << scatter;
  }
}

TEST(AnalyzeRepeatability, IgnoresOutliersAndRunsWithoutErrors) {
  RunValues values = OneGroup({10, 500, 12, 14, -70});
  values.std_error = {1, 1, 1, 2, kNone};
  const auto repeatability = AnalyzeRepeatability(values, {{1, 490}});
  ASSERT_TRUE(repeatability);
  EXPECT_EQ(repeatability->runs, 3);
  EXPECT_NEAR(repeatability->chi2, 4, 1e-12);
}

TEST(AnalyzeRepeatability, IsMissingWithoutAGroupOfTwoRunsWithErrors) {
  EXPECT_FALSE(AnalyzeRepeatability(OneGroup({}), {}));
  EXPECT_FALSE(AnalyzeRepeatability(OneGroup({1}, 1), {}));
  EXPECT_FALSE(AnalyzeRepeatability(OneGroup({1, 2, 3}), {}));
  EXPECT_FALSE(AnalyzeRepeatability(OneGroup({1, 2}, 1), {{0, 9}}));
  RunValues apart = OneGroup({1, 2}, 1);
  apart.group = {0, 1};
  EXPECT_FALSE(AnalyzeRepeatability(apart, {}));
}

}  // namespace
}  // namespace pendulum::run_statistics_test
