// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/recording/zip_files.h"

/// Workbooks of Excel 2007 and OpenDocument for tests, as the programs write them.
namespace pendulum {

/// A sheet: its name and the XML of its rows.
using SheetXml = std::pair<std::string, std::string>;

/// The XML of a row of cells: <c r="A1" ...>. Numbers are 1-based.
inline std::string RowXml(int row, const std::vector<std::string>& cells) {
  std::string xml = "<row r=\"" + std::to_string(row) + "\">";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    xml += "<c r=\"" + std::string(1, static_cast<char>('A' + i)) + std::to_string(row) + "\"" + cells[i] + "</c>";
  }
  return xml + "</row>";
}

/// Cells for RowXml: a number with a format, a text in the cell, a shared text, the result of a formula, an error.
inline std::string NumberCell(const std::string& number, int style = 0) {
  return " s=\"" + std::to_string(style) + "\"><v>" + number + "</v>";
}
inline std::string TextCell(const std::string& text) { return " t=\"inlineStr\"><is><t>" + text + "</t></is>"; }
inline std::string SharedCell(int index) { return " t=\"s\"><v>" + std::to_string(index) + "</v>"; }
inline std::string FormulaCell(const std::string& number) { return "><f>B2*2</f><v>" + number + "</v>"; }
inline std::string ErrorCell() { return " t=\"e\"><v>#N/A</v>"; }

/// What a workbook has besides its sheets.
struct XlsxParts {
  std::string strings;                 // <si>...</si> of the shared strings.
  std::string formats = "";            // <numFmt> elements with numbers from 164 on.
  std::vector<int> styles = {0};       // The format of each style.
  std::string workbook_properties;     // <workbookPr .../>
  std::string folder = "worksheets/";  // Where the sheets are, as their relations say it.
  std::string kind = "worksheet";      // Of all sheets.
  std::string prefix;                  // Of the elements of sheets, with its colon.
};

inline std::string XlsxOf(const std::vector<SheetXml>& sheets, const XlsxParts& parts = {}) {
  const std::string type = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/";
  const std::string space = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
  std::string list, relations;
  std::vector<std::pair<std::string, std::string>> members = {
      {"_rels/.rels", "<Relationships><Relationship Id=\"rId1\" Type=\"" + type +
                          "officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"}};
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    list += "<sheet name=\"" + sheets[i].first + "\" sheetId=\"" + number + "\" r:id=\"rId" + number + "\"/>";
    relations += "<Relationship Id=\"rId" + number + "\" Type=\"" + type + parts.kind + "\" Target=\"" + parts.folder +
                 "sheet" + number + ".xml\"/>";
    members.push_back({"xl/worksheets/sheet" + number + ".xml",
                       "<?xml version=\"1.0\"?><" + parts.prefix + "worksheet xmlns" +
                           (parts.prefix.empty() ? "" : ":" + parts.prefix.substr(0, parts.prefix.size() - 1)) + "=\"" +
                           space + "\">" + sheets[i].second + "</" + parts.prefix + "worksheet>"});
  }
  std::string styles;
  for (const int format : parts.styles) styles += "<xf numFmtId=\"" + std::to_string(format) + "\"/>";
  relations += "<Relationship Id=\"s\" Type=\"" + type + "styles\" Target=\"styles.xml\"/>";
  members.push_back({"xl/styles.xml", "<styleSheet xmlns=\"" + space + "\"><numFmts>" + parts.formats +
                                          "</numFmts><cellStyleXfs><xf numFmtId=\"14\"/></cellStyleXfs><cellXfs>" +
                                          styles + "</cellXfs></styleSheet>"});
  if (!parts.strings.empty()) {
    relations += "<Relationship Id=\"t\" Type=\"" + type + "sharedStrings\" Target=\"sharedStrings.xml\"/>";
    members.push_back({"xl/sharedStrings.xml", "<sst xmlns=\"" + space + "\">" + parts.strings + "</sst>"});
  }
  members.push_back({"xl/_rels/workbook.xml.rels", "<Relationships>" + relations + "</Relationships>"});
  members.push_back({"xl/workbook.xml", "<workbook xmlns=\"" + space + "\" xmlns:r=\"r\">" + parts.workbook_properties +
                                            "<sheets>" + list + "</sheets></workbook>"});
  members.push_back({"[Content_Types].xml", "<Types/>"});
  return ZipOf(members);
}

/// An OpenDocument spreadsheet; `tables` are its elements table:table.
inline std::string OdsContent(const std::string& tables) {
  return "<?xml version=\"1.0\"?><office:document-content xmlns:office=\"o\" xmlns:table=\"t\" xmlns:text=\"x\" "
         "xmlns:calcext=\"c\"><office:body><office:spreadsheet>" +
         tables + "</office:spreadsheet></office:body></office:document-content>";
}

inline std::string OdsOf(const std::string& tables, const std::string& manifest = "<m/>") {
  return ZipOf({{"mimetype", "application/vnd.oasis.opendocument.spreadsheet"},
                {"META-INF/manifest.xml", manifest},
                {"content.xml", OdsContent(tables)}});
}

inline std::string OdsNumber(const std::string& number, const std::string& more = "") {
  return "<table:table-cell office:value-type=\"float\" office:value=\"" + number + "\"" + more +
         "><text:p>shown</text:p></table:table-cell>";
}
inline std::string OdsText(const std::string& text) {
  return "<table:table-cell office:value-type=\"string\"><text:p>" + text + "</text:p></table:table-cell>";
}
inline std::string OdsRow(const std::string& cells, const std::string& more = "") {
  return "<table:table-row" + more + ">" + cells + "</table:table-row>";
}
inline std::string OdsTable(const std::string& name, const std::string& rows) {
  return "<table:table table:name=\"" + name + "\">" + rows + "</table:table>";
}

}  // namespace pendulum
