// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/section_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/text_parts.h"

namespace pendulum::section_text_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A section with one block, as text.
std::string TextOf(Block block, TextStyle style = {}) { return ToText(Sections{{"T", "", {std::move(block)}}}, style); }

TEST(SectionText, IsIndentedBelowItsTitleAndRemark) {
  EXPECT_EQ(ToText(Sections{{"Correlations", "of two", {Words{"none"}}}, {"Fit", "", {}}}),
            "[[Correlations]] (of two)\n    none\n[[Fit]]\n");
}

TEST(SectionText, AlignsFactsAndFillsTheirLines) {
  const std::string words = "word word word word word word word word word word word word word word word word word word";
  EXPECT_EQ(TextOf(Facts{{"τ", "one  two"}, {"long", words}}),
            "[[T]]\n    τ     one  two\n"
            "    long  word word word word word word word word word word word word word word\n"
            "          word word word word\n");
}

TEST(SectionText, ReportsWhatATableOmits) {
  Table table{{{"n", true}}, {{"1"}, {"2"}, {"9"}}};
  table.rows_before = 2;
  table.left_out = "... 6 more";
  EXPECT_EQ(TextOf(table), "[[T]]\n    n\n    1\n    2\n    ... 6 more\n    9\n");
}

TEST(SectionText, BreaksEquationsOnlyBeforeSigns) {
  const std::string term = "aaaaaaaaaaaaaaaaaa\u00A0b";
  EXPECT_EQ(TextOf(Formula{term + " +\u00A0" + term + " +\u00A0" + term + " =\u00A0" + "0"}),
            "[[T]]\n    aaaaaaaaaaaaaaaaaa b + aaaaaaaaaaaaaaaaaa b + aaaaaaaaaaaaaaaaaa b = 0\n");
  EXPECT_EQ(TextOf(Formula{term + " +\u00A0" + term + " +\u00A0" + term + " +\u00A0" + term}),
            "[[T]]\n    aaaaaaaaaaaaaaaaaa b + aaaaaaaaaaaaaaaaaa b + aaaaaaaaaaaaaaaaaa b\n"
            "    + aaaaaaaaaaaaaaaaaa b\n");
}

TEST(SectionText, FillsLinesToItsWidth) {
  EXPECT_EQ(TextOf(Words{"word word word word word"}, {.width = 24}), "[[T]]\n    word word word word\n    word\n");
  EXPECT_EQ(TextOf(Words{"word word word word word"}), "[[T]]\n    word word word word word\n");
}

TEST(SectionText, ListsItems) { EXPECT_EQ(TextOf(Items{{"one", "two"}}), "[[T]]\n  - one\n  - two\n"); }

// SGR sequences of ECMA-48: 1 bold, 31 red, 33 yellow, 0 plain.
TEST(SectionText, IsColouredOnRequest) {
  Table table{{{"agrees"}, {"z"}}, {{"NO", "7"}, {"yes", "NOT"}}};
  table.caution = "NO";
  const Sections sections = {
      {"T", "", {Words{"bad", Emphasis::kAlarm}, Facts{{"a", "b", Emphasis::kCaution}}, table, Words{"good"}}}};
  EXPECT_EQ(ToText(sections, {.colour = true}),
            "\x1B[1m[[T]]\x1B[0m\n    \x1B[1;31mbad\x1B[0m\n    a  \x1B[33mb\x1B[0m\n"
            "    agrees  z\n    \x1B[33mNO\x1B[0m      7\n    yes     NOT\n    good\n");
  EXPECT_THAT(ToText(sections), Not(HasSubstr("\x1B")));
}

TEST(SectionText, ColoursEachLineSeparately) {
  const std::string word(50, 'x');
  EXPECT_EQ(TextOf(Items{{word + " " + word}, Emphasis::kCaution}, {.colour = true}),
            "\x1B[1m[[T]]\x1B[0m\n  - \x1B[33m" + word + "\x1B[0m\n    \x1B[33m" + word + "\x1B[0m\n");
}

}  // namespace
}  // namespace pendulum::section_text_test
