// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/xlsx.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "pendulum/base/sha256.h"
#include "tests/recording/rows.h"
#include "tests/recording/xlsx_files.h"

namespace pendulum::xlsx_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The text of the first sheet.
std::string TextOfSheet(const std::string& rows, const XlsxParts& parts = {}) {
  const std::string bytes = XlsxOf({{"Sheet1", "<sheetData>" + rows + "</sheetData>"}}, parts);
  const Workbook workbook = ReadXlsx(ZipMembers::Open(bytes, "run.xlsx").value(), 1'000'000);
  EXPECT_EQ(workbook.complaint, "");
  return workbook.sheets.empty() ? "" : workbook.sheets.front().text;
}

/// Eight rows with the times and values of ExpectTheRows, below a header.
std::string Sheet(const std::vector<std::string>& names, int first_row = 1) {
  std::vector<std::string> header;
  for (const std::string& name : names) header.push_back(TextCell(name));
  std::string rows = RowXml(first_row, header);
  for (int i = 0; i < 8; ++i) {
    rows += RowXml(first_row + 1 + i, {NumberCell("0.0" + std::to_string(i)), NumberCell(std::to_string(100 + i))});
  }
  return "<sheetData>" + rows + "</sheetData>";
}

const std::string kAngle = Sheet({"time_s", "angle_rad"});

// ---- Cells -------------------------------------------------------------------------------------------------------

TEST(ReadXlsx, ReadsNumbersTextsFormulasAndErrors) {
  XlsxParts parts;
  parts.strings =
      "<si><t>Time (s)</t></si><si><r><t>An</t></r><r><t xml:space=\"preserve\">gle</t></r>"
      "<rPh><t>ruby</t></rPh></si>";
  EXPECT_EQ(TextOfSheet(RowXml(1, {SharedCell(0), SharedCell(1), TextCell("a;b")}) +
                            RowXml(2, {NumberCell("0.30000000000000004"), FormulaCell("1E-3"), ErrorCell()}) +
                            RowXml(3, {" t=\"b\"><v>1</v>", " t=\"str\"><f>A1</f><v>x</v>", SharedCell(99)}),
                        parts),
            "Time (s);Angle;\"a;b\"\n0.30000000000000004;0.001;\nTRUE;x;\n");
}

TEST(ReadXlsx, KeepsTheNumbersOfRowsAndColumns) {
  EXPECT_EQ(TextOfSheet("<row r=\"3\"><c r=\"C3\"><v>1</v></c></row><row r=\"5\"><c r=\"A5\"><v>2</v></c></row>"),
            "\n\n;;1\n\n2;;\n");
  EXPECT_EQ(TextOfSheet("<row><c><v>1</v></c><c><v>2</v></c></row><row><c><v>3</v></c></row>"), "1;2\n3;\n");
}

/// 45352 is 1 March 2024 in Excel.
TEST(ReadXlsx, WritesTimesAsText) {
  XlsxParts parts;
  parts.formats =
      "<numFmt numFmtId=\"164\" formatCode=\"dd/mm/yy\\ hh:mm:ss.000\"/><numFmt numFmtId=\"165\" "
      "formatCode=\"[h]:mm:ss\"/><numFmt numFmtId=\"166\" formatCode=\"0.00&quot; seconds&quot;\"/>";
  parts.styles = {0, 164, 165, 166, 47};
  const std::string moment = NumberText(45352 + (16 * 3600 + 4 * 60 + 31.273) / 86400);
  const std::string row = RowXml(1, {NumberCell(moment, 1), NumberCell("1.5", 2), NumberCell("1.5", 3),
                                     NumberCell(NumberText(31.273 / 86400), 4)});
  EXPECT_EQ(TextOfSheet(row, parts), "2024-03-01T16:04:31.273;36:00:00;1.5;00:00:31.273\n");
  parts.workbook_properties = "<workbookPr date1904=\"1\"/>";
  EXPECT_EQ(TextOfSheet(RowXml(1, {NumberCell("43890", 1)}), parts), "2024-03-01T00:00:00\n");
  EXPECT_EQ(TextOfSheet(RowXml(1, {" t=\"d\"><v>2024-03-01T16:04:31.273</v>"})), "2024-03-01T16:04:31.273\n");
}

TEST(ReadXlsx, KeepsCommentsForMetadata) {
  const std::string rows = RowXml(1, {TextCell("# rig: {\"a\": 1, \"b\": 2}")}) + RowXml(2, {"", NumberCell("5")});
  EXPECT_EQ(TextOfSheet(rows), "# rig: {\"a\": 1, \"b\": 2}\n;5\n");
}

// ---- Workbooks ---------------------------------------------------------------------------------------------------

TEST(ReadXlsx, GivesTheSameRecordingAsCsv) {
  std::string rows = RowXml(1, {TextCell("time_s"), TextCell("angle_rad")}), csv = "time_s,angle_rad\n";
  for (int i = 0; i < 300; ++i) {
    const std::string time = NumberText(i / 30.0), angle = NumberText(0.4 * std::cos(4.9 * i / 30.0));
    rows += RowXml(i + 2, {NumberCell(time), NumberCell(angle)});
    csv += time + "," + angle + "\n";
  }
  const std::string bytes = XlsxOf({{"Sheet1", "<sheetData>" + rows + "</sheetData>"}});
  const Recording expected = RecordingOf(csv), recording = RecordingOf(bytes);
  EXPECT_EQ(recording.time, expected.time);
  EXPECT_EQ(recording.value, expected.value);
  EXPECT_EQ(recording.resolution, expected.resolution);
  EXPECT_EQ(recording.sha256, Sha256(bytes).value());
  EXPECT_EQ(recording.path, "run.csv");
}

TEST(ReadXlsx, FindsSheetsWhereverProgramsPutThem) {
  for (const std::string folder : {"worksheets/", "/xl/worksheets/", "./worksheets/", "../xl/worksheets/"}) {
    XlsxParts parts;
    parts.folder = folder;
    ExpectTheRows(RecordingOf(XlsxOf({{"Sheet1", kAngle}}, parts)));
  }
  XlsxParts prefixed;
  prefixed.prefix = "x:";
  std::string sheet = kAngle;
  for (const std::string tag : {"<", "</"}) {
    for (std::size_t at = 0; (at = sheet.find(tag, at)) != std::string::npos; at += tag.size()) {
      if (sheet[at + tag.size()] != '/') sheet.insert(at + tag.size(), "x:");
    }
  }
  ExpectTheRows(RecordingOf(XlsxOf({{"Sheet1", sheet}}, prefixed)));
}

TEST(ReadXlsx, ChoosesTheSheetWithTheSwing) {
  const std::string light = Sheet({"Time (s)", "Illuminance (lx)"});
  const std::string meta = "<sheetData>" + RowXml(1, {TextCell("time_s"), TextCell("angle_deg")}) +
                           RowXml(2, {NumberCell("1"), NumberCell("2")}) + "</sheetData>";
  ExpectTheRows(RecordingOf(XlsxOf({{"Light", light}, {"Angle", kAngle}, {"Empty", "<sheetData/>"}})));
  ExpectTheRows(RecordingOf(XlsxOf({{"Raw Data", kAngle}, {"Metadata Device", meta}, {"Metadata Time", meta}})));
  EXPECT_TRUE(RecordingOf(XlsxOf({{"Raw Data", kAngle}, {"Metadata Device", meta}})).warnings.empty());
}

TEST(ReadXlsx, PrefersRawDataAndSaysSo) {
  const std::string other = Sheet({"time_s", "angle_deg"});
  const Recording recording = RecordingOf(XlsxOf({{"Fit", other}, {"Raw Data", kAngle}}));
  ExpectTheRows(recording);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "member_assumed");
  EXPECT_EQ(MessageText(recording.warnings[0]),
            "run.csv: sheet \"Raw Data\" was read, although others have columns of a swing too; choose another with "
            "--value_column \"SHEET/COLUMN\"");
}

TEST(ReadXlsx, NamesTheSheetsThatCouldBeTheRecording) {
  const std::string two = XlsxOf({{"Run 1", kAngle}, {"Run 2", Sheet({"time_s", "angle_deg"})}});
  EXPECT_EQ(FaultOf(two),
            "run.csv: columns \"Run 1/angle_rad\" and \"Run 2/angle_deg\" could both be the quantity; choose one with "
            "--value_column");
  ExpectTheRows(RecordingOf(two, TimeAndValue("", "Run 1/angle_rad")));
  ExpectTheRows(RecordingOf(two, TimeAndValue("", "Run 2")), kDegree);
  EXPECT_THAT(FaultOf(XlsxOf({{"a", Sheet({"force", "mass"})}, {"b", Sheet({"force", "mass"})}})),
              StartsWith("run.csv: none of its sheets \"a\" and \"b\" has a column of times and one of an angle or a "
                         "rate; choose with --value_column \"SHEET/COLUMN\", or name another recording. The first "
                         "sheet says: run.csv:a:"));
}

TEST(ReadXlsx, ReadsTheOnlySheetThatCanBeRead) {
  const std::string notes = "<sheetData>" + RowXml(1, {TextCell("My notes")}) + "</sheetData>";
  ExpectTheRows(RecordingOf(XlsxOf({{"Notes", notes}, {"Data", Sheet({"clock", "reading"})}}),
                            TimeAndValue("clock:s", "reading", "rad")));
}

TEST(ReadXlsx, ReportsTheRowOfAFault) {
  std::string sheet = kAngle;
  sheet.insert(sheet.find("</sheetData>"),
               RowXml(10, {NumberCell("0.08"), TextCell("oops")}) + RowXml(11, {NumberCell("0.09"), NumberCell("1")}));
  EXPECT_THAT(FaultOf(XlsxOf({{"Run 1", sheet}})), StartsWith("run.csv:Run 1:10:"));
}

// ---- Faults ------------------------------------------------------------------------------------------------------

TEST(ReadXlsx, NamesWorkbooksThatCannotBeRead) {
  XlsxParts charts;
  charts.kind = "chartsheet";
  EXPECT_EQ(FaultOf(XlsxOf({{"Chart1", ""}}, charts)),
            "run.csv: this workbook has no sheet with cells, only charts or macros; name one with the numbers");
  EXPECT_EQ(FaultOf(ZipOf({{"xl/workbook.xml", "<x/>"}, {"[Content_Types].xml", "<x/>"}})),
            "run.csv: this workbook is damaged: \"xl/_rels/workbook.xml.rels\" is missing; save it again");
  EXPECT_EQ(
      FaultOf(XlsxOf({{"Sheet1", "<sheetData><row></sheetData>"}})),
      "run.csv: this workbook is damaged: \"xl/worksheets/sheet1.xml\" cannot be read (line 1, column 117: mismatched "
      "tag); save it again");
  EXPECT_THAT(FaultOf(ZipOf({{"xl/workbook.bin", "x"}, {"[Content_Types].xml", "<x/>"}})),
              StartsWith("run.csv: this is a binary workbook (.xlsb); save it as .xlsx"));
  EXPECT_EQ(FaultOf(XlsxOf(
                {{"S", "<sheetData>" + RowXml(2, {NumberCell("1")}) + RowXml(1, {NumberCell("1")}) + "</sheetData>"}})),
            "run.csv: the cells of sheet \"S\" are not in order; save the workbook again");
}

TEST(ReadXlsx, RefusesEntities) {
  const std::string bomb = "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\">]><worksheet><sheetData/></worksheet>";
  std::string bytes = XlsxOf({{"Sheet1", kAngle}});
  const std::string workbook = "<workbook><sheets><sheet name=\"S\" id=\"1\"/></sheets></workbook>";
  EXPECT_THAT(FaultOf(ZipOf({{"xl/workbook.xml", workbook},
                             {"xl/_rels/workbook.xml.rels",
                              "<R><Relationship Id=\"1\" Type=\"/worksheet\" Target=\"s.xml\"/></R>"},
                             {"xl/s.xml", bomb}})),
              HasSubstr("\"xl/s.xml\" cannot be read (line 1, column 13: a document type)"));
}

TEST(ReadXlsx, LimitsTheSizeOfSheets) {
  const auto sheet = [](const std::string& cell) {
    return XlsxOf({{"S", "<sheetData><row r=\"1\"><c r=\"" + cell + "\"><v>1</v></c></row></sheetData>"}});
  };
  EXPECT_THAT(FaultOf(sheet("A1048577")), HasSubstr("more than 1048576 rows"));
  EXPECT_THAT(FaultOf(sheet("ZZZ1")), HasSubstr("more than 1048576 rows"));
  std::string rows = RowXml(1, {NumberCell("1")});
  rows.insert(rows.size() - 6, "<c r=\"XFD1\"><v>1</v></c>");  // 16384 columns
  for (int i = 2; i < 100; ++i) rows += RowXml(i, {NumberCell("1")});
  ReadOptions options;
  options.most_unpacked_bytes = 1'000'000;
  EXPECT_THAT(FaultOf(XlsxOf({{"S", "<sheetData>" + rows + "</sheetData>"}}), options),
              HasSubstr("or 1000000 bytes, too many for a recording"));
}

TEST(ReadXlsx, RefusesATruncatedWorkbook) {
  const std::string whole = XlsxOf({{"Sheet1", kAngle}});
  for (std::size_t size = 4; size < whole.size(); size += 101) {
    EXPECT_THAT(FaultOf(whole.substr(0, size)), StartsWith("run.csv: this zip file cannot be opened")) << size;
  }
}

TEST(ReadXlsx, ReadsAWorkbookInAZipFile) {
  ExpectTheRows(RecordingOf(ZipOf({{"run.xlsx", XlsxOf({{"Sheet1", kAngle}})}, {"notes.txt", "hello\n"}})));
  ExpectTheRows(RecordingOf(ZipOf(
      {{"a.csv", "time_s,angle_rad\n" + Rows("0.0{t},{v}")}, {"report.docx", ZipOf({{"word/document.xml", ""}})}})));
}

}  // namespace
}  // namespace pendulum::xlsx_test
