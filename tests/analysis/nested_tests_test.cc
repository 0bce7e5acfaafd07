// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/nested_tests.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/recommendation_cases.h"
#include "tests/analysis/whole_swing.h"

namespace pendulum::nested_tests_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<NestedTest> TestsOf(const Recording& recording, const std::vector<std::string>& models) {
  FitOptions options;
  options.interval = IntervalMethod::kCovariance;
  return CompareModels(OnlyOne(Must(FitModels(recording, Whole(recording), options, models))), options,
                       {.predict = false})
      .tests;
}

TEST(TestNested, UsesHalfAChiSquareForOneBoundedTerm) {
  const auto tests = TestsOf(Must(SimulateRecording(NoisyRun("coulomb"))), {"viscous", "coulomb"});
  ASSERT_EQ(tests.size(), 1);
  EXPECT_EQ(tests[0].simpler, "viscous");
  EXPECT_EQ(tests[0].richer, "coulomb");
  EXPECT_THAT(tests[0].added, ElementsAre("coulomb"));
  EXPECT_EQ(tests[0].null, "half χ²(0), half χ²(1)");
  EXPECT_LT(tests[0].p.value_or(1), 1e-10);
}

// Two terms at their bound: w_2 = 1/4 + asin ρ / 2π is at most 1/2. Dry friction and drag together act like additional
// viscous friction, because the rate has the powers 0, 2 and 1 in these terms. Therefore ρ > 0 and w_0 < 1/4.
TEST(TestNested, UsesAMixtureForTwoBoundedTerms) {
  const auto tests = TestsOf(Must(SimulateRecording(NoisyRun("viscous"))), {"viscous", "drag"});
  ASSERT_EQ(tests.size(), 1);
  EXPECT_THAT(tests[0].null, HasSubstr("half χ²(1)"));
  EXPECT_THAT(tests[0].null, HasSubstr("χ²(2)"));
  EXPECT_LT(std::stod(tests[0].null), 0.25) << tests[0].null;
  ASSERT_TRUE(tests[0].p);
  EXPECT_GT(*tests[0].p, 1e-4);
}

// With viscous friction alone the p of "viscous in coulomb" is 1 in half of the recordings and uniform below 1/2 in the
// others. Of 60 about 3 are below 0.05 (1 to 7 in 97 of 100 runs) and about 30 are 1.
TEST(TestNested, HasUniformProbabilitiesUnderTheSimplerLaw) {
  constexpr int kSeeds = 60;
  int below = 0, one = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto tests =
        TestsOf(Must(SimulateRecording(NoisyRun("viscous", static_cast<std::uint64_t>(seed)))), {"viscous", "coulomb"});
    ASSERT_EQ(tests.size(), 1);
    below += *tests[0].p < 0.05;
    one += *tests[0].p > 0.499;
  }

  EXPECT_LE(below, 8);
  EXPECT_GE(one, 18);
  EXPECT_LE(one, 42);
}

// Under the simpler law p is uniform if the stiction estimate is above coulomb; otherwise the test is not made. Of 30
// recordings none is expected below 0.001 (3 in 100 runs have one), and about 1.5 below 0.05 (5 or more: 2 in 100).
TEST(TestNested, SimulatesTheDistributionForAnUnidentifiedParameter) {
  int below = 0, far_below = 0, made = 0;
  for (int seed = 1; seed <= 30; ++seed) {
    SyntheticOptions run = LawRun(kTrueLaws[1], 15, 1);
    run.seed = static_cast<std::uint64_t>(seed);
    const auto tests = TestsOf(Must(SimulateRecording(run)), {"coulomb", "stribeck"});
    if (tests.empty()) continue;
    ++made;
    EXPECT_THAT(tests[0].null, HasSubstr("simulated, because coulomb has no stribeck_rate"));
    ASSERT_TRUE(tests[0].p) << tests[0].reason;
    below += *tests[0].p < 0.05;
    far_below += *tests[0].p < 0.001;
  }
  EXPECT_GT(made, 3);
  EXPECT_LE(below, 4);
  EXPECT_EQ(far_below, 0);
}

TEST(TestNested, FindsStiction) {
  const auto tests = TestsOf(Must(SimulateRecording(LawRun(kTrueLaws[3], 60, 1))), {"coulomb", "stribeck"});
  ASSERT_EQ(tests.size(), 1);
  EXPECT_GT(tests[0].statistic, 50);
  EXPECT_LE(tests[0].p.value_or(1), 1e-4);  // one of 20000
}

TEST(TestNested, TestsNestedModelsOnly) {
  EXPECT_THAT(TestsOf(Must(SimulateRecording(NoisyRun("coulomb"))), {"linear", "coulomb"}), IsEmpty());
  EXPECT_THAT(TestsOf(Must(SimulateRecording(NoisyRun("coulomb"))), {"drag", "asymmetric"}), IsEmpty());
}

}  // namespace
}  // namespace pendulum::nested_tests_test
