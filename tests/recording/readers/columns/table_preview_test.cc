// SPDX-License-Identifier: Apache-2.0
/// What a reader shows of a table, also if it cannot read all of it.
#include "pendulum/recording/readers/columns/table_preview.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/rows.h"
#include "tests/recording/zip_files.h"

namespace pendulum::table_preview_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TablePreview PreviewOf(const std::string& bytes, ReadOptions options = {}) {
  TablePreview preview;
  options.preview = &preview;
  (void)ParseRecording(bytes, "run", options);
  return preview;
}

TEST(TablePreview, ShowsNamesRowsAndTheChosenColumns) {
  const TablePreview preview =
      PreviewOf("# a note\nt;\"swing\";T\n0,01;1,5;20\n0,02;\"2\";21\n" + Rows("0,0{t};{v};9"));
  EXPECT_EQ(preview.format, "text with columns separated by semicolons");
  EXPECT_THAT(preview.names, ElementsAre("t", "swing", "T"));
  ASSERT_THAT(preview.rows, SizeIs(TablePreview::kRows));
  EXPECT_THAT(preview.rows[0], ElementsAre("0,01", "1,5", "20"));
  EXPECT_THAT(preview.rows[1], ElementsAre("0,02", "2", "21"));
}

TEST(TablePreview, HasTheUnitsThatWereChosen) {
  const TablePreview preview = PreviewOf("time_ms,angle_deg\n" + Rows("{t}0,{v}", 20));
  ASSERT_TRUE(preview.time && preview.value);
  EXPECT_EQ(preview.time->index, 0U);
  EXPECT_EQ(preview.time->unit, "ms");
  EXPECT_EQ(preview.value->index, 1U);
  EXPECT_EQ(preview.value->unit, "deg");
  EXPECT_THAT(preview.questions, IsEmpty());
  EXPECT_THAT(preview.assumptions, IsEmpty());
}

TEST(TablePreview, HasAllQuestionsWithTheirFlagsIfReadingFails) {
  std::string text = "n,encoder\n";
  for (int i = 1; i < 60; ++i) text += std::to_string(i) + "," + std::to_string(20 - i % 7) + "\n";
  const TablePreview preview = PreviewOf(text);
  ASSERT_THAT(preview.questions, SizeIs(2));
  EXPECT_THAT(preview.questions[0].options, ElementsAre("sample_rate_hz"));
  EXPECT_THAT(preview.questions[1].options, ElementsAre("unit"));
  EXPECT_THAT(preview.questions[1].sentence, HasSubstr("counts or degrees"));
  EXPECT_THAT(preview.names, ElementsAre("n", "encoder"));
  EXPECT_FALSE(preview.time);
  EXPECT_EQ(preview.value->unit, "");
}

TEST(TablePreview, NamesTheOptionOfAQuestionWithoutAnExample) {
  const TablePreview preview = PreviewOf("time [furlong],angle_deg\n" + Rows("0.0{t},{v}", 20));
  ASSERT_THAT(preview.questions, SizeIs(1));
  EXPECT_THAT(preview.questions[0].options, ElementsAre("time_column"));
  EXPECT_THAT(preview.questions[0].try_flags, IsEmpty());
}

TEST(TablePreview, OffersTheColumnsOfSeveralMembers) {
  const std::string swing = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const TablePreview preview = PreviewOf(ZipOf({{"a.csv", swing}, {"b.csv", swing}}));
  EXPECT_EQ(preview.format, "zip file");
  ASSERT_THAT(preview.questions, SizeIs(1));
  EXPECT_THAT(preview.questions[0].options, ElementsAre("value_column"));
  EXPECT_THAT(preview.questions[0].values, ElementsAre("a.csv/angle_deg", "b.csv/angle_deg"));
}

TEST(TablePreview, NamesTheMemberThatWasRead) {
  const TablePreview preview =
      PreviewOf(ZipOf({{"notes.txt", "x\n"}, {"run.csv", "time_s,angle_deg\n" + Rows("0.0{t},{v}")}}));
  EXPECT_EQ(preview.member, "run.csv");
  EXPECT_THAT(preview.names, ElementsAre("time_s", "angle_deg"));
}

TEST(TablePreview, ShowsTheOnlyReadableMemberWithoutAHeader) {
  std::string swing;
  for (int i = 0; i < 200; ++i) swing += std::to_string(0.01 * i) + "," + std::to_string(30 * std::cos(0.1 * i)) + "\n";
  const TablePreview preview = PreviewOf(ZipOf({{"a.txt", "hello\n"}, {"b.txt", swing}}));
  EXPECT_EQ(preview.member, "b.txt");
  EXPECT_THAT(preview.names, ElementsAre("1", "2"));
}

}  // namespace
}  // namespace pendulum::table_preview_test
