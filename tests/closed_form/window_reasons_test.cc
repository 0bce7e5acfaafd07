// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/window_reasons.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace pendulum::window_reasons_test {
namespace {

template <typename Bound>
void ExpectOneSentencePerReason(typename Bound::Reason last) {
  std::set<std::string> sentences;
  for (int k = 0; k <= static_cast<int>(last); ++k) {
    Bound bound;
    bound.reason = static_cast<typename Bound::Reason>(k);
    const std::string sentence = Sentence(bound);
    EXPECT_EQ(sentence.empty(), bound.reason == Bound::Reason::kUnknown) << k;
    EXPECT_TRUE(sentences.insert(sentence).second) << sentence;
  }
}

TEST(Sentence, ExistsOnceForEachReason) {
  ExpectOneSentencePerReason<WindowBegin>(WindowBegin::Reason::kUndersampledAfterHold);
  ExpectOneSentencePerReason<WindowEnd>(WindowEnd::Reason::kCountsLost);
}

TEST(Sentence, GivesAngleAndTime) {
  EXPECT_EQ(Sentence(WindowEnd{WindowEnd::Reason::kAtRest, 45.0278}), "at rest from about 45.03 s");
  EXPECT_NE(Sentence(WindowBegin{WindowBegin::Reason::kAfterFall, 171.26}).find("171 deg"), std::string::npos);
}

TEST(Sentence, SaysWhatAWindowCosts) {
  EXPECT_EQ(Sentence(LeftOut{12, 47, true, 1.812}), "12 of 47 half swings, also the largest: the period's error × 1.8");
  EXPECT_EQ(Sentence(LeftOut{1, 47, true, 1.2}), "the largest of 47 half swings: the period's error × 1.2");
  EXPECT_EQ(Sentence(LeftOut{3, 47, false, 1.01}), "3 of 47 half swings: the period's error hardly changes");
}

}  // namespace
}  // namespace pendulum::window_reasons_test
