// SPDX-License-Identifier: Apache-2.0
// How often the true law is recommended: simulator/RECOMMENDATION.md is a study of more conditions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/recommendation_cases.h"

namespace pendulum::recommendation_errors_test {
namespace {

/// If 95 % of all recommendations are right, more than 2 of 12 are wrong in 2 of 100 runs.
constexpr int kSeeds = 12;
constexpr int kMaxWrong = 2;

class Recommendation : public testing::TestWithParam<TrueLaw> {};

TEST_P(Recommendation, IsTheTrueLawIfTheDataDetermineIt) {
  const TrueLaw& law = GetParam();
  const double duration = law.model == "stribeck" ? 60 : 20;
  Recommendations counts = CountRecommendations(LawRun(law, duration, 1), kSeeds, 1001);
  EXPECT_GE(counts[std::string(law.model)], kSeeds - kMaxWrong) << testing::PrintToString(counts);
}

INSTANTIATE_TEST_SUITE_P(Laws, Recommendation, testing::ValuesIn(kTrueLaws),
                         [](const auto& law) { return std::string(law.param.model); });

}  // namespace
}  // namespace pendulum::recommendation_errors_test
