// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/excel_xml.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>
#include <utility>

#include "recording/readers/containers/cell_time.h"
#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/xml_parser.h"

namespace pendulum {
namespace {

class ExcelXmlReader {
 public:
  ExcelXmlReader(std::size_t max_bytes, Workbook& workbook) : max_bytes_(max_bytes), workbook_(workbook), csv_(0) {}

  void Start(std::string_view element, const XmlAttributes& attributes) {
    if (element == "Worksheet") {
      workbook_.sheets.push_back({std::string(attributes["Name"]), ""});
      csv_ = CsvText(max_bytes_, kMaxSheetRows);
      row_ = 0;
    } else if (element == "Row") {
      row_ = IndexOf(attributes, row_);
      column_ = 0;
    } else if (element == "Cell") {
      column_ = IndexOf(attributes, column_);
      merged_ = attributes.Number("MergeAcross", 0);
    } else if (element == "Comment") {
      is_comment_ = true;
    } else if (element == "Data" && !is_comment_ && !workbook_.sheets.empty()) {
      type_ = attributes["Type"];
      value_.clear();
      is_value_ = true;
    }
  }

  void Add(std::string_view text) {
    if (is_value_) value_ += text;
  }

  void End(std::string_view element) {
    if (element == "Data" && is_value_) {
      is_value_ = false;
      AddCell();
    }
    if (element == "Comment") is_comment_ = false;
    if (element == "Cell") column_ += 1 + merged_;
    if (element == "Row") ++row_;
    if (element != "Worksheet" || workbook_.sheets.empty()) return;
    Sheet& sheet = workbook_.sheets.back();
    FinishSheet(csv_, max_bytes_, sheet, workbook_);
  }

 private:
  /// Indices begin at 1 and are given where cells or rows are skipped.
  static std::size_t IndexOf(const XmlAttributes& attributes, std::size_t next) {
    const std::size_t index = attributes.Number("Index", 0);
    return index == 0 ? next : index - 1;
  }

  void AddCell() {
    constexpr std::string_view kNoDate = "1899-12-31T";  // The date of a time of day.
    if (type_ == "Error") return;
    std::string_view text = value_;
    if (type_ == "Number") {
      double number = 0;
      const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error == std::errc() && stop == text.data() + text.size()) return csv_.AddNumber(row_, column_, number);
    }
    if (type_ == "DateTime" && text.starts_with(kNoDate)) text.remove_prefix(kNoDate.size());
    csv_.AddText(row_, column_, type_ == "DateTime" ? WithoutEndZeros(text) : text);
  }

  std::size_t max_bytes_;
  Workbook& workbook_;
  CsvText csv_;
  std::size_t row_ = 0, column_ = 0, merged_ = 0;  // `merged_`: further columns of the cell.
  bool is_value_ = false, is_comment_ = false;
  std::string type_, value_;
};

}  // namespace

Workbook ReadExcelXml(std::string_view xml, std::size_t max_bytes) {
  Workbook workbook;
  ExcelXmlReader reader(max_bytes, workbook);
  const std::string fault = ParseXml(
      xml, {[&](std::string_view element, const XmlAttributes& attributes) { reader.Start(element, attributes); },
            [&](std::string_view element) { reader.End(element); }, [&](std::string_view text) { reader.Add(text); }});
  if (!workbook.complaint.empty() || workbook.is_too_large) return workbook;
  if (!fault.empty()) workbook.complaint = "this XML workbook is damaged (" + fault + "); save it again";
  return workbook;
}

}  // namespace pendulum
