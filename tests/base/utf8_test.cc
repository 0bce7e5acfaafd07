// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/utf8.h"

#include <string_view>

#include <gtest/gtest.h>

namespace pendulum::utf8_test {
namespace {

// Examples from RFC 3629, sections 3, 7 and 10.
TEST(IsUtf8, AcceptsCharactersOfEachLength) {
  for (const std::string_view text : {"", "angle", "A\xE2\x89\xA2\xCE\x91.", "\xEF\xBB\xBF\xF0\xA3\x8E\xB4"}) {
    EXPECT_TRUE(IsUtf8(text)) << text;
  }
}

TEST(WithoutByteOrderMark, RemovesOneMarkAtTheBeginning) {
  EXPECT_EQ(WithoutByteOrderMark("\xEF\xBB\xBF\xEF\xBB\xBFt"), "\xEF\xBB\xBFt");
  for (const std::string_view text : {"", "\xEF\xBB", "t\xEF\xBB\xBF"}) EXPECT_EQ(WithoutByteOrderMark(text), text);
}

TEST(IsUtf8, RefusesOtherEncodingsAndLongForms) {
  for (const std::string_view text : {"W\xE4rme", "\xE2\x89", "\xC0\x80", "\xED\xA1\x8C", "\xF4\x90\x80\x80"}) {
    EXPECT_FALSE(IsUtf8(text)) << text;
  }
}

}  // namespace
}  // namespace pendulum::utf8_test
