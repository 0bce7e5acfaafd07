// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/excel_xml.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::excel_xml_test {
namespace {

using testing::StartsWith;

std::string Book(const std::string& rows) {
  return "<?xml version=\"1.0\"?><?mso-application progid=\"Excel.Sheet\"?><Workbook "
         "xmlns=\"urn:schemas-microsoft-com:office:spreadsheet\" "
         "xmlns:ss=\"urn:schemas-microsoft-com:office:spreadsheet\"><Worksheet ss:Name=\"Run 1\"><Table>" +
         rows + "</Table></Worksheet></Workbook>";
}

std::string Cell(const std::string& type, const std::string& value, const std::string& more = "") {
  return "<Cell" + more + "><Data ss:Type=\"" + type + "\">" + value + "</Data></Cell>";
}

std::string TextOf(const std::string& rows) {
  const Workbook workbook = ReadExcelXml(Book(rows), 10'000);
  EXPECT_EQ(workbook.complaint, "");
  return workbook.sheets.empty() ? "" : workbook.sheets.front().text;
}

TEST(ReadExcelXml, ReadsCellsOfAllTypes) {
  EXPECT_EQ(TextOf("<Row>" + Cell("String", "Time &amp; <B>angle</B>") + Cell("Error", "#N/A") +
                   Cell("Number", "0.30000000000000004") + "</Row><Row>" + Cell("DateTime", "2024-03-01T16:04:31.273") +
                   Cell("DateTime", "1899-12-31T16:04:31.500") + "</Row>"),
            "Time & angle;;0.30000000000000004\n2024-03-01T16:04:31.273;16:04:31.5;\n");
}

TEST(ReadExcelXml, KeepsPlacesAndIgnoresComments) {
  EXPECT_EQ(TextOf("<Row ss:Index=\"2\"><Cell ss:Index=\"2\"><Data ss:Type=\"Number\">1</Data><Comment><ss:Data>note"
                   "</ss:Data></Comment></Cell>" +
                   Cell("Number", "2", " ss:MergeAcross=\"1\"") + Cell("Number", "3") + "</Row>"),
            "\n;1;2;;3\n");
}

TEST(ReadExcelXml, ReadsARecording) {
  std::string rows = "<Row>" + Cell("String", "time_s") + Cell("String", "angle_rad") + "</Row>";
  for (int i = 0; i < 8; ++i) {
    rows += "<Row>" + Cell("Number", "0.0" + std::to_string(i)) + Cell("Number", std::to_string(100 + i)) + "</Row>";
  }
  ExpectTheRows(RecordingOf(Book(rows)));
  EXPECT_THAT(FaultOf(Book(rows).substr(0, 500)), StartsWith("run.csv: this XML workbook is damaged (line 1, column "));
}

}  // namespace
}  // namespace pendulum::excel_xml_test
