// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/layout.h"

#include <gtest/gtest.h>

namespace pendulum::layout_test {
namespace {

TEST(DisplayWidth, CountsCharactersNotBytes) {
  EXPECT_EQ(DisplayWidth("I_O"), 3);
  EXPECT_EQ(DisplayWidth("τ_c"), 3);
  EXPECT_EQ(DisplayWidth("±"), 1);
  EXPECT_EQ(DisplayWidth(""), 0);
}

TEST(DisplayWidth, IgnoresColourSequences) { EXPECT_EQ(DisplayWidth("\x1B[1;31mmm\x1B[0mτ"), 3); }

TEST(TableWithin, IsAnAlignedTableIfItFits) {
  const std::vector<Column> columns = {{"name"}, {"value", true}, {"± error", false, 1}};
  const std::vector<std::vector<std::string>> rows = {{"b", "12", "± 3"}};
  EXPECT_EQ(TableWithin(columns, rows, 2, 21), AlignedTable(columns, rows, 2));  // 2 + 4 + 2 + 5 + 1 + 7
  EXPECT_EQ(TableWithin({}, {}, 2, 20), "");
}

// Value and error stay together: they continue below, next to the name. A row without value and error is left out
// there.
TEST(TableWithin, ContinuesBelowAndRepeatsTheFirstColumn) {
  const std::vector<Column> columns = {{"name"}, {"unit"}, {"value", true}, {"± error", false, 1}};
  EXPECT_EQ(TableWithin(columns, {{"b", "s", "12", "± 3"}, {"c", "m", "", ""}}, 0, 20),
            "name  unit\n"
            "b     s\n"
            "c     m\n"
            "\n"
            "name  value ± error\n"
            "b        12 ± 3\n");
}

TEST(TableWithin, KeepsAColumnWiderThanALine) {
  EXPECT_EQ(TableWithin({{""}, {""}, {""}}, {{"a", "incomprehensible", "b"}}, 0, 8), "a  incomprehensible\n\na  b\n");
}

TEST(AlignedTable, AlignsSymbolsOfSeveralBytes) {
  const std::vector<Column> columns = {{"symbol"}, {"value", true}, {"± error", false, 1}};
  EXPECT_EQ(AlignedTable(columns, {{"b", "0.003", "± 0.1"}, {"τ_c", "12", "± 3"}, {"ω", "7", ""}}, 2),
            "  symbol  value ± error\n"
            "  b       0.003 ± 0.1\n"
            "  τ_c        12 ± 3\n"
            "  ω           7\n");
}

TEST(AlignedTable, LeavesOutEmptyColumns) {
  EXPECT_EQ(AlignedTable({{"name"}, {"systematic"}, {"unit"}}, {{"b", "", "s"}}, 0), "name  unit\nb     s\n");
}

TEST(AlignedTable, LeavesOutAnEmptyLineOfHeaders) {
  EXPECT_EQ(AlignedTable({{""}, {""}}, {{"file", "run.csv"}, {"rows", "12"}}, 1), " file  run.csv\n rows  12\n");
}

TEST(Paragraph, FillsLinesAndIndentsThem) {
  EXPECT_EQ(Paragraph("one two  three four", "- ", 9), "- one two\n  three\n  four\n");
}

TEST(Paragraph, GivesATooLongWordItsOwnLine) {
  EXPECT_EQ(Paragraph("a incomprehensible b", "", 4), "a\nincomprehensible\nb\n");
}

TEST(Paragraph, BreaksNoLineAtANoBreakSpace) {
  EXPECT_EQ(WithBlanks(Paragraph("a\u00A0b c\u00A0d", "", 4)), "a b\nc d\n");
}

TEST(Paragraph, MeasuresWidthInCharacters) { EXPECT_EQ(Paragraph("ττττ ωω", "", 7), "ττττ ωω\n"); }

// As the reader of recordings names its columns.
TEST(KeySuffix, HasNoCharactersThatAKeyCannotHave) {
  EXPECT_EQ(KeySuffix("rad"), "rad");
  EXPECT_EQ(KeySuffix("rad/s"), "rad_s");
  EXPECT_EQ(KeySuffix("m/s^2"), "m_s2");
}

}  // namespace
}  // namespace pendulum::layout_test
