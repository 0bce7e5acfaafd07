// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/ods.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "recording/readers/containers/cell_time.h"
#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/xml_parser.h"

namespace pendulum {
namespace {

/// A cell, which may stand for several equal cells beside each other.
struct OdsCell {
  std::size_t column = 0, repeats = 1;
  std::string type;   // float, string, date, ...
  std::string value;  // The attribute with the value; for a string its text.
  bool is_error = false;
};

/// Reads the elements of content.xml.
class OdsReader {
 public:
  OdsReader(std::size_t max_bytes, Workbook& workbook) : max_bytes_(max_bytes), workbook_(workbook), csv_(0) {}

  void Start(std::string_view element, const XmlAttributes& attributes) {
    ++depth_;
    if (element == "spreadsheet") is_spreadsheet_ = true;
    if (!is_spreadsheet_) return;
    if (element == "table" && !is_in_table_) {
      BeginTable(attributes["name"]);
    } else if (is_in_table_ && cell_depth_ == 0 && element == "table-row") {
      cells_.clear();
      next_column_ = 0;
      row_repeats_ = attributes.Number("number-rows-repeated", 1);
    } else if (is_in_table_ && cell_depth_ == 0 && (element == "table-cell" || element == "covered-table-cell")) {
      BeginCell(attributes);
    } else if (cell_depth_ > 0 && element == "p" && depth_ == cell_depth_ + 1) {
      if (!text_.empty()) text_ += ' ';
      is_text_ = true;
    } else if (is_text_ && element == "s") {
      text_.append(std::min<std::size_t>(attributes.Number("c", 1), 1000), ' ');
    } else if (is_text_ && (element == "tab" || element == "line-break")) {
      text_ += ' ';
    }
  }

  void Add(std::string_view text) {
    if (is_text_) text_ += text;
  }

  void End(std::string_view element) {
    if (is_text_ && element == "p" && depth_ == cell_depth_ + 1) is_text_ = false;
    if (cell_depth_ == depth_) EndCell();
    if (is_in_table_ && element == "table-row" && cell_depth_ == 0) EndRow();
    if (is_in_table_ && element == "table" && depth_ == table_depth_) EndTable();
    --depth_;
  }

  bool is_done() const { return workbook_.is_too_large || !workbook_.complaint.empty(); }

 private:
  void BeginTable(std::string_view name) {
    is_in_table_ = true;
    table_depth_ = depth_;
    row_ = 0;
    workbook_.sheets.push_back({std::string(name), ""});
    csv_ = CsvText(max_bytes_, kMaxSheetRows);
  }

  void EndTable() {
    is_in_table_ = false;
    Sheet& sheet = workbook_.sheets.back();
    FinishSheet(csv_, max_bytes_, sheet, workbook_);
  }

  void BeginCell(const XmlAttributes& attributes) {
    cell_depth_ = depth_;
    text_.clear();
    OdsCell& cell = cells_.emplace_back();
    cell.column = next_column_;
    cell.repeats = attributes.Number("number-columns-repeated", 1);
    next_column_ += cell.repeats;
    for (const char* const value : {"value", "date-value", "time-value", "boolean-value", "string-value"}) {
      if (cell.value.empty()) cell.value = attributes[value];
    }
    // LibreOffice also writes its own calcext:value-type, which is `error` for a fault.
    cell.type = attributes["value-type"];
    cell.is_error = attributes.Has("value-type", "error");
  }

  void EndCell() {
    OdsCell& cell = cells_.back();
    cell_depth_ = 0;
    if (cell.value.empty()) cell.value = std::move(text_);
    text_.clear();
    if (cell.value.empty() || cell.is_error) cells_.pop_back();
  }

  /// Empty rows at the end of a sheet are repeated a million times. A malicious file repeats rows that are not empty.
  void EndRow() {
    const std::size_t repeats = cells_.empty() ? 0 : row_repeats_;
    const std::size_t width = cells_.empty() ? 0 : cells_.back().column + cells_.back().repeats;
    workbook_.is_too_large |= width > 0 && repeats > max_bytes_ / width;  // A cell has at least a separator.
    for (std::size_t i = 0; i < repeats && !is_done() && !csv_.is_full(); ++i) AddRow(row_ + i);
    row_ += row_repeats_;
    workbook_.is_too_large |= csv_.is_full();
  }

  void AddRow(std::size_t row) {
    for (const OdsCell& cell : cells_) {
      for (std::size_t i = 0; i < cell.repeats && !csv_.is_full(); ++i) AddCell(row, cell.column + i, cell);
    }
  }

  void AddCell(std::size_t row, std::size_t column, const OdsCell& cell) {
    const bool is_number = cell.type == "float" || cell.type == "percentage" || cell.type == "currency";
    const char* const end = cell.value.data() + cell.value.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(cell.value.data(), end, number);
    if (is_number && error == std::errc() && stop == end) return csv_.AddNumber(row, column, number);
    if (cell.type == "date") return csv_.AddText(row, column, WithoutEndZeros(cell.value));
    if (cell.type == "time") return csv_.AddText(row, column, DurationText(cell.value));
    csv_.AddText(row, column, cell.value);
  }

  std::size_t max_bytes_;
  Workbook& workbook_;
  CsvText csv_;
  int depth_ = 0, table_depth_ = 0, cell_depth_ = 0;  // cell_depth_ is 0 outside cells.
  bool is_spreadsheet_ = false, is_in_table_ = false, is_text_ = false;
  std::size_t row_ = 0, row_repeats_ = 1, next_column_ = 0;
  std::vector<OdsCell> cells_;  // Of the current row, without empty ones.
  std::string text_;
};

XmlHandlers HandlersOf(OdsReader& reader) {
  return {[&](std::string_view element, const XmlAttributes& attributes) { reader.Start(element, attributes); },
          [&](std::string_view element) { reader.End(element); }, [&](std::string_view text) { reader.Add(text); }};
}

void CheckRead(const std::string& fault, Workbook& workbook) {
  if (!workbook.complaint.empty() || workbook.is_too_large) return;
  if (!fault.empty()) {
    workbook.complaint = "this spreadsheet is damaged (" + fault + "); save it again";
  } else if (workbook.sheets.empty()) {
    workbook.complaint = "this document has no sheet with cells; name a spreadsheet";
  }
}

}  // namespace

Workbook ReadOds(const ZipMembers& zip, std::size_t max_bytes) {
  constexpr std::size_t kMaxManifest = std::size_t{1} << 20;
  Workbook workbook;
  const ZipMembers::Member* const manifest = zip.Find("META-INF/manifest.xml");
  const Result<std::string> listed = manifest == nullptr ? Result<std::string>() : zip.Unpack(*manifest, kMaxManifest);
  if (listed && listed->find("encryption-data") != std::string::npos) {
    workbook.complaint = "this spreadsheet is encrypted; save it without a password";
    return workbook;
  }
  const ZipMembers::Member* const content = zip.Find("content.xml");
  if (content == nullptr) {
    workbook.complaint = "this spreadsheet is damaged: content.xml is missing; save it again";
    return workbook;
  }
  OdsReader reader(max_bytes, workbook);
  XmlParser parser(HandlersOf(reader));
  const auto unpacked =
      zip.UnpackBlocks(*content, [&](std::string_view block) { return parser.Add(block) && !reader.is_done(); });
  if (unpacked && !reader.is_done()) parser.Add("", true);
  CheckRead(unpacked ? parser.fault() : "content.xml cannot be unpacked", workbook);
  return workbook;
}

Workbook ReadFlatOds(std::string_view xml, std::size_t max_bytes) {
  Workbook workbook;
  OdsReader reader(max_bytes, workbook);
  CheckRead(ParseXml(xml, HandlersOf(reader)), workbook);
  return workbook;
}

}  // namespace pendulum
