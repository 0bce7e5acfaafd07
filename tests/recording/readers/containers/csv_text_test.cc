// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/csv_text.h"

#include <cmath>

#include <gtest/gtest.h>

namespace pendulum::csv_text_test {
namespace {

constexpr std::size_t kMaxBytes = 10'000;

TEST(CsvText, WritesRowsOfEqualWidth) {
  CsvText csv(kMaxBytes);
  csv.AddText(0, 0, "Run 1");
  csv.AddText(2, 0, "t");
  csv.AddText(2, 1, "angle");
  csv.AddNumber(3, 1, 0.1 + 0.2);
  csv.AddNumber(3, 2, NAN);
  EXPECT_EQ(csv.Finish(), "Run 1;\n\nt;angle\n;0.30000000000000004\n");
  EXPECT_FALSE(csv.is_full());
}

TEST(CsvText, QuotesWhereNeeded) {
  EXPECT_EQ(CsvCell("Angle (deg)"), "Angle (deg)");
  EXPECT_EQ(CsvCell("0,5"), "\"0,5\"");
  EXPECT_EQ(CsvCell("say \"x\""), "\"say \"\"x\"\"\"");
  EXPECT_EQ(CsvCell("two\nlines"), "two lines");
  EXPECT_EQ(CsvCell(" a"), "\" a\"");
}

TEST(CsvText, KeepsCommentsAsTheyAre) {
  CsvText csv(kMaxBytes);
  csv.AddText(0, 0, "# range: 0,1023");
  csv.AddNumber(1, 0, 1);
  csv.AddNumber(1, 1, 2);
  EXPECT_EQ(csv.Finish(), "# range: 0,1023\n1;2\n");
}

TEST(CsvText, QuotesAHeaderThatBeginsLikeAComment) {
  CsvText csv(kMaxBytes);
  csv.AddText(0, 0, "#");
  csv.AddText(0, 1, "time_s");
  csv.AddNumber(1, 0, 1);
  csv.AddNumber(1, 1, 0.5);
  EXPECT_EQ(csv.Finish(), "\"#\";time_s\n1;0.5\n");
}

TEST(CsvText, RefusesCellsThatComeTooLate) {
  CsvText csv(kMaxBytes);
  csv.AddNumber(1, 1, 1);
  csv.AddNumber(1, 0, 2);
  EXPECT_TRUE(csv.is_disordered());
  EXPECT_EQ(csv.Finish(), "\n;1\n");
}

TEST(CsvText, LimitsItsSize) {
  CsvText rows(kMaxBytes, 10);
  rows.AddNumber(10, 0, 1);
  EXPECT_TRUE(rows.is_full());
  CsvText bytes(100);
  bytes.AddText(0, 0, std::string(100, 'x'));
  EXPECT_TRUE(bytes.is_full());
  CsvText padding(100);
  padding.AddNumber(0, 50, 1);
  padding.AddNumber(1, 0, 1);
  padding.AddNumber(2, 0, 1);
  EXPECT_EQ(padding.Finish(), "");
  EXPECT_TRUE(padding.is_full());
}

TEST(CsvText, IsEmptyWithoutCells) { EXPECT_EQ(CsvText(kMaxBytes).Finish(), ""); }

}  // namespace
}  // namespace pendulum::csv_text_test
