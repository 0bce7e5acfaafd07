// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/format.h"

#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum::format_test {
namespace {

TEST(ProbabilityText, HasTwoDigitsAndNoZero) {
  EXPECT_EQ(ProbabilityText(0.0271), "0.027");
  EXPECT_EQ(ProbabilityText(3.5e-19), "3.5e-19");
  EXPECT_EQ(ProbabilityText(0), "< 1e-99");
}

TEST(ShellWord, IsQuotedIfItHasSpecialCharacters) {
  EXPECT_EQ(ShellWord("run_1.csv"), "run_1.csv");
  EXPECT_EQ(ShellWord("Time (s):ms"), "'Time (s):ms'");
  EXPECT_EQ(ShellWord("it's"), "'it'\\''s'");
  EXPECT_EQ(ShellWord(""), "''");
}

TEST(NumberText, RoundsToSignificantDigits) {
  EXPECT_EQ(NumberText(0.0123456, 2), "0.012");
  EXPECT_EQ(NumberText(99.6, 2), "1e+02");
  EXPECT_EQ(NumberText(-3.0, 6), "-3");
}

TEST(NumberText, IsTheShortestTextThatReadsBackExactly) {
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(-1e300), "-1e+300");
  for (const double value : {1.0 / 3, 5e-324, std::numeric_limits<double>::max(), -2.2250738585072014e-308}) {
    EXPECT_EQ(std::strtod(NumberText(value).c_str(), nullptr), value);
  }
}

TEST(Quoted, KeepsPrintableTextAndEscapesOtherBytes) {
  EXPECT_EQ(Quoted(""), R"("")");
  EXPECT_EQ(Quoted("angle_deg"), R"("angle_deg")");
  EXPECT_EQ(Quoted("θ [°]"), R"("θ [°]")");
  EXPECT_EQ(Quoted("角度"), R"("角度")");
  EXPECT_EQ(Quoted("\xE2\x80\xAE"), R"("\xe2\x80\xae")");  // reverses the direction of the text
  EXPECT_EQ(Quoted("a\x1b[31m\n"), R"("a\x1b[31m\x0a")");
  EXPECT_EQ(Quoted("\xC2\x9B"), R"("\xc2\x9b")");  // a control sequence introducer, two bytes of valid UTF-8
  EXPECT_EQ(Quoted("\xFF"), R"("\xff")");
}

TEST(Quoted, ShortensLongText) {
  EXPECT_EQ(Quoted(std::string(40, 'x')), '"' + std::string(40, 'x') + '"');
  EXPECT_EQ(Quoted(std::string(300, '\x01')).size(), 2 + 40 + 3);  // the limit holds for what is shown
  EXPECT_EQ(Quoted(std::string(41, 'x')), '"' + std::string(40, 'x') + "...\"");
}

struct Named {
  std::string name;
};

TEST(SizeText, CountsWholeMebibytes) {
  EXPECT_EQ(SizeText(33554432), "32 MiB");
  EXPECT_EQ(SizeText(1000), "1000 bytes");
}

TEST(NameList, JoinsNamesForASentence) {
  EXPECT_EQ(NameList(std::vector<Named>{}), "");
  EXPECT_EQ(NameList(std::vector<Named>{{"inertia"}}), "inertia");
  EXPECT_EQ(NameList(std::vector<std::string_view>{"viscous", "drag"}), "viscous, drag");
  EXPECT_EQ(NameList(std::vector<Named>{{"inertia"}, {"viscous"}, {"zero_angle"}}), "inertia, viscous, zero_angle");
}

TEST(ListWithAnd, NamesTheFirstEight) {
  EXPECT_EQ(ListWithAnd({}), "");
  EXPECT_EQ(ListWithAnd({"inertia"}), "inertia");
  EXPECT_EQ(ListWithAnd({"inertia", "viscous"}), "inertia and viscous");
  EXPECT_EQ(ListWithAnd({"1", "2", "3", "4", "5", "6", "7", "8"}), "1, 2, 3, 4, 5, 6, 7 and 8");
  EXPECT_EQ(ListWithAnd({"1", "2", "3", "4", "5", "6", "7", "8", "9"}), "1, 2, 3, 4, 5, 6, 7, 8, ...");
  EXPECT_EQ(ListWithAnd({"1", "2", "3", "4", "5", "6", "7", "8", "9"}, 9), "1, 2, 3, 4, 5, 6, 7, 8 and 9");
}

}  // namespace
}  // namespace pendulum::format_test
