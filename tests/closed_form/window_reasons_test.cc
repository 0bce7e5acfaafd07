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

}  // namespace
}  // namespace pendulum::window_reasons_test
