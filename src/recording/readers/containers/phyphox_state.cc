// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/phyphox_state.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/xml_parser.h"

namespace pendulum {
namespace {

struct ExportedColumn {
  std::string name, buffer;
};

struct ExportedSet {
  std::string name;
  std::vector<ExportedColumn> columns;
};

/// What a saved state contains.
struct PhyphoxState {
  std::vector<std::string> buffers;            // In the order of the file.
  std::map<std::string, std::string> content;  // Numbers separated by commas, by name of the buffer.
  std::vector<ExportedSet> sets;
};

std::string ParsePhyphoxState(std::string_view xml, PhyphoxState& state) {
  std::string text, init, column;
  bool is_in_export = false;
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes& attributes) {
    text.clear();
    if (element == "container") init = attributes["init"];
    if (element == "export") is_in_export = true;
    if (element == "set" && is_in_export) state.sets.push_back({std::string(attributes["name"]), {}});
    if (element == "data") column = attributes["name"];
  };
  handlers.text = [&](std::string_view piece) { text += piece; };
  handlers.end = [&](std::string_view element) {
    if (element == "export") is_in_export = false;
    const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    const std::string name = text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
    if (element == "container" && state.content.emplace(name, std::move(init)).second) state.buffers.push_back(name);
    if (element == "data" && is_in_export && !state.sets.empty()) state.sets.back().columns.push_back({column, name});
    init.clear();
  };
  return ParseXml(xml, std::move(handlers));
}

/// The numbers of a buffer; NaN where there is none.
std::vector<double> NumbersOf(std::string_view content) {
  std::vector<double> numbers;
  while (!content.empty()) {
    const std::size_t end = std::min(content.find(','), content.size());
    std::string_view cell = content.substr(0, end);
    while (cell.starts_with(' ')) cell.remove_prefix(1);
    double number = 0;
    const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    numbers.push_back(error == std::errc() ? number : std::numeric_limits<double>::quiet_NaN());
    content.remove_prefix(std::min(end + 1, content.size()));
  }
  return numbers;
}

/// Writes the columns of a set. Returns the number of rows.
std::size_t WriteSet(const ExportedSet& set, const PhyphoxState& state, CsvText& csv) {
  std::vector<std::vector<double>> columns;
  std::size_t rows = 0;
  for (std::size_t i = 0; i < set.columns.size(); ++i) {
    csv.AddText(0, i, set.columns[i].name);
    const auto buffer = state.content.find(set.columns[i].buffer);
    columns.push_back(buffer == state.content.end() ? std::vector<double>() : NumbersOf(buffer->second));
    rows = std::max(rows, columns.back().size());
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (row < columns[i].size()) csv.AddNumber(row + 1, i, columns[i][row]);
    }
  }
  return rows;
}

}  // namespace

Workbook ReadPhyphoxState(std::string_view xml, std::size_t max_bytes) {
  constexpr std::size_t kNoRecording = 1;  // An experiment has constants, buffers with one number.
  Workbook workbook;
  PhyphoxState state;
  const std::string fault = ParsePhyphoxState(xml, state);
  if (!fault.empty()) {
    workbook.complaint = "this saved state of phyphox is damaged (" + fault + "); save it again";
    return workbook;
  }
  if (std::ranges::all_of(state.sets, [](const ExportedSet& set) { return set.columns.empty(); })) {
    ExportedSet& all = state.sets.emplace_back();
    for (const std::string& buffer : state.buffers) all.columns.push_back({buffer, buffer});
  }
  for (const ExportedSet& set : state.sets) {
    CsvText csv(max_bytes);
    if (WriteSet(set, state, csv) <= kNoRecording) continue;
    Sheet sheet{set.name, ""};
    if (!FinishSheet(csv, max_bytes, sheet, workbook)) return workbook;
    workbook.sheets.push_back(std::move(sheet));
  }
  if (workbook.sheets.empty()) {
    workbook.complaint =
        "this is a phyphox experiment without a recording; run it in phyphox, then export the data as CSV or Excel, or "
        "save the state";
  }
  return workbook;
}

}  // namespace pendulum
