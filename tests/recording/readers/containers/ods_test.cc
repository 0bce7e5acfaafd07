// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/ods.h"

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"
#include "tests/recording/xlsx_files.h"

namespace pendulum::ods_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The text of the first sheet.
std::string TextOfSheet(const std::string& rows) {
  const std::string bytes = OdsOf(OdsTable("Sheet1", rows));
  const Workbook workbook = ReadOds(ZipMembers::Open(bytes, "run.ods").value(), 1'000'000);
  EXPECT_EQ(workbook.complaint, "");
  return workbook.sheets.empty() ? "" : workbook.sheets.front().text;
}

std::string TypedCell(const std::string& type, const std::string& value, const std::string& more = "") {
  return "<table:table-cell office:value-type=\"" + type + "\" office:" + value + more + "/>";
}

/// The rows of ExpectTheRows below a header.
std::string AngleRows() {
  std::string rows = OdsRow(OdsText("time_s") + OdsText("angle_rad"));
  for (int i = 0; i < 8; ++i) {
    rows += OdsRow(OdsNumber("0.0" + std::to_string(i)) + OdsNumber(std::to_string(100 + i)));
  }
  return rows;
}

TEST(ReadOds, ReadsCellsOfAllTypes) {
  const std::string error =
      "<table:table-cell office:value-type=\"string\" office:string-value=\"\" "
      "calcext:value-type=\"error\"><text:p>#DIV/0!</text:p></table:table-cell>";
  EXPECT_EQ(TextOfSheet(OdsRow(OdsText("Time<text:s text:c=\"2\"/>(s)") + OdsText("a;b") + error) +
                        OdsRow(OdsNumber("0.30000000000000004") + TypedCell("percentage", "value=\"0.5\"") +
                               TypedCell("boolean", "boolean-value=\"true\"") + OdsNumber("1"))),
            "Time  (s);\"a;b\";;\n0.30000000000000004;0.5;true;1\n");
}

TEST(ReadOds, WritesTimesAsText) {
  EXPECT_EQ(TextOfSheet(OdsRow(TypedCell("date", "date-value=\"2024-03-01T16:04:31.273000000\"") +
                               TypedCell("time", "time-value=\"PT16H04M31.273S\"") +
                               TypedCell("time", "time-value=\"PT00H00M00.01S\""))),
            "2024-03-01T16:04:31.273;16:04:31.273;00:00:00.01\n");
}

TEST(ReadOds, RepeatsCellsAndRows) {
  const std::string gap = "<table:table-cell table:number-columns-repeated=\"2\"/>";
  EXPECT_EQ(TextOfSheet(OdsRow(gap + OdsNumber("7", " table:number-columns-repeated=\"2\"")) +
                        OdsRow(gap, " table:number-rows-repeated=\"2\"") +
                        OdsRow(OdsNumber("8"), " table:number-rows-repeated=\"3\"") +
                        OdsRow("<table:covered-table-cell/>", " table:number-rows-repeated=\"1048000\"")),
            ";;7;7\n\n\n8;;;\n8;;;\n8;;;\n");
}

/// LibreOffice fills equal rows with empty cells up to its last column.
TEST(ReadOds, EmptyCellsAtTheEndOfARowNeedNoBytes) {
  const std::string end = "<table:table-cell table:number-columns-repeated=\"16383\"/>";
  std::string expected;
  for (int i = 0; i < 100; ++i) expected += "7\n";
  EXPECT_EQ(TextOfSheet(OdsRow(OdsNumber("7") + end, " table:number-rows-repeated=\"100\"")), expected);
}

TEST(ReadOds, IgnoresNotesAndHeaderGroups) {
  const std::string note =
      "<table:table-cell office:value-type=\"float\" office:value=\"5\"><office:annotation><text:p>"
      "a note</text:p></office:annotation><text:p>5</text:p></table:table-cell>";
  EXPECT_EQ(
      TextOfSheet("<table:table-header-rows>" + OdsRow(OdsText("t")) + "</table:table-header-rows>" + OdsRow(note)),
      "t\n5\n");
}

TEST(ReadOds, ReadsTheSheetWithTheSwing) {
  const std::string notes = OdsTable("Notes", OdsRow(OdsText("hello")));
  ExpectTheRows(RecordingOf(OdsOf(notes + OdsTable("Data", AngleRows()))));
  ExpectTheRows(
      RecordingOf(OdsOf(OdsTable("A", AngleRows()) + OdsTable("B", AngleRows())), TimeAndValue("", "B/angle_rad")));
}

TEST(ReadOds, ReadsFlatXml) {
  const std::string body = OdsContent(OdsTable("Data", AngleRows()));
  std::string flat = body;
  for (std::size_t at = 0; (at = flat.find("document-content")) != std::string::npos;) flat.replace(at, 16, "document");
  ExpectTheRows(RecordingOf(flat));
}

/// A repeated row of a bomb would fill any memory.
TEST(ReadOds, RefusesBombsQuickly) {
  const auto begin = std::chrono::steady_clock::now();
  const auto bomb = [](const std::string& rows, const std::string& columns) {
    return OdsOf(OdsTable("S", OdsRow(OdsNumber("1", " table:number-columns-repeated=\"" + columns + "\""),
                                      " table:number-rows-repeated=\"" + rows + "\"")));
  };
  EXPECT_THAT(FaultOf(bomb("1000000000", "1")), HasSubstr("more than 1048576 rows"));
  EXPECT_THAT(FaultOf(bomb("1", "1000000000")), HasSubstr("too many for a recording"));
  EXPECT_THAT(FaultOf(bomb("1000000", "16000")), HasSubstr("too many for a recording"));
  EXPECT_THAT(FaultOf(bomb("99999999999999999999", "1")), HasSubstr("more than 1048576 rows"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

TEST(ReadOds, NamesSpreadsheetsThatCannotBeRead) {
  EXPECT_EQ(FaultOf(OdsOf("", "<manifest:encryption-data/>")),
            "run.csv: this spreadsheet is encrypted; save it without a password");
  EXPECT_EQ(FaultOf(OdsOf("")), "run.csv: this document has no sheet with cells; name a spreadsheet");
  EXPECT_THAT(FaultOf(OdsOf("<table:table>")), StartsWith("run.csv: this spreadsheet is damaged (line 1, column "));
  EXPECT_EQ(FaultOf(ZipOf({{"mimetype", "application/vnd.oasis.opendocument.spreadsheet"}})),
            "run.csv: this spreadsheet is damaged: content.xml is missing; save it again");
}

}  // namespace
}  // namespace pendulum::ods_test
