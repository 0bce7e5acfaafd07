// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/open_interval.h"

#include <set>
#include <string_view>

#include <gtest/gtest.h>

namespace pendulum::open_interval_test {
namespace {

TEST(Sentence, ExistsOnceForEachReasonOfAnOpenInterval) {
  std::set<std::string_view> sentences;
  for (int k = 0; k <= static_cast<int>(OpenInterval::kFailedResamples); ++k) {
    const auto open = static_cast<OpenInterval>(k);
    EXPECT_EQ(Sentence(open).empty(), open == OpenInterval::kClosed) << k;
    EXPECT_TRUE(sentences.insert(Sentence(open)).second) << Sentence(open);
  }
}

}  // namespace
}  // namespace pendulum::open_interval_test
