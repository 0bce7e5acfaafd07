// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/readers/columns/column_choice.h"
#include "recording/readers/text/host_stamp.h"
#include "recording/readers/text/tracker.h"
#include "recording/readers/text/vernier.h"

/// The structure of a file from its first lines: header, separator, number of fields.
namespace pendulum::csv {

/// True for an empty line, and for an empty row written by a spreadsheet.
inline bool IsEmptyRow(std::string_view line) { return line.find_first_not_of(" \t,;") == std::string_view::npos; }

/// The separator from a line such as `sep=;`, which spreadsheets write for themselves.
inline std::optional<char> SeparatorLine(std::string_view line) {
  constexpr std::string_view kKey = "sep=";
  line.remove_prefix(line.starts_with('"') ? 1 : 0);
  if (line.size() <= kKey.size() || !line.starts_with(kKey)) return std::nullopt;
  return line[kKey.size()];
}

/// One of the first lines, kept until their meaning is known.
struct HeadLine {
  std::string text;
  std::size_t number;
};

inline bool HasHostStamps(const std::vector<HeadLine>& head) {
  return std::ranges::any_of(head, [](const HeadLine& line) {
    const auto stamp = FindHostStamp(line.text);
    return stamp && stamp->second_of_day;
  });
}

/// The part of a line that the device sent.
inline std::string_view DevicePart(std::string_view line, bool has_host) {
  const auto stamp = has_host ? FindHostStamp(line) : std::nullopt;
  return stamp ? stamp->rest : line;
}

/// The result of examining the first lines.
struct Head {
  std::vector<TableColumn> columns;  // Empty without a header.
  std::size_t names_line = 0;        // Index of the line with the names.
  std::size_t first_row = 0;         // Index of the first line that is a row.
  bool may_have_gaps = false;        // Cells may be empty: some programs pad columns of different lengths.
};

/// The number of first lines needed to determine their meaning: a header and a row, or two rows of which the first may
/// be cut off. A third line is needed if a line of labels may precede the header.
inline std::size_t HeadLines(const HeadLine& first) {
  if (IsVernier(first.text)) return kVernierUnits + 2;
  const std::vector<Name> names = SplitHeader(first.text, Separator(first.text));
  const bool is_name =
      std::ranges::all_of(names, [](const Name& name) { return name.text.empty() || IsName(name.text); });
  const bool has_time = std::ranges::any_of(names, [](const Name& name) { return IsTime(SplitRun(name.text).rest); });
  return is_name && !has_time ? 3 : 2;
}

inline Head ParseVernierHead(const std::vector<HeadLine>& head, Layout& layout) {
  const std::size_t first = head.front().number;
  Head found;
  std::string_view units;
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (head[i].number == first + kVernierNames) found.names_line = i;
    if (head[i].number == first + kVernierUnits) units = head[i].text;
    if (head[i].number <= first + kVernierUnits) found.first_row = i + 1;
  }
  layout.separator = '\t';
  layout.has_header = true;
  found.columns = VernierColumns(head[found.names_line].text, units);
  layout.width = found.columns.size();
  found.may_have_gaps = true;
  return found;
}

/// The columns of an ordinary header, or of a header in the style of one of the known programs.
inline Head HeadOfNames(const std::vector<Name>& names) {
  // Phyphox quotes names and pads columns with NaN. People do not quote names, so a quoted time indicates phyphox.
  Head found;
  for (const Name& name : names) found.columns.push_back({std::string(name.text), std::string(name.text), "", name.at});
  found.first_row = 1;
  found.may_have_gaps = SplitRuns(found.columns);
  found.may_have_gaps |= !names.empty() && names.front().text == "Time (s)" && names.front().at[0] == '"';
  return found;
}

/// Sets separator, width and has_header from the first lines. `separator` is the one the file declares, or '\0'.
inline Head ParseHead(const std::vector<HeadLine>& head, bool has_host, char separator, Layout& layout) {
  if (IsVernier(head.front().text)) return ParseVernierHead(head, layout);
  const std::string_view first = DevicePart(head.front().text, has_host);
  const std::string_view second = DevicePart(head[std::min<std::size_t>(1, head.size() - 1)].text, has_host);
  if (head.size() > 2) {
    layout.separator = separator != '\0' ? separator : Separator(second);
    if (auto columns = LabelledColumns(first, second, head[2].text, layout.separator); !columns.empty()) {
      layout.has_header = true;
      layout.width = columns.size();
      return {std::move(columns), 1, 2, true};
    }
  }
  layout.separator = separator != '\0' ? separator : Separator(first);
  std::vector<Name> names = SplitHeader(first, layout.separator);
  layout.has_header = std::ranges::any_of(names, [](const Name& name) { return IsName(name.text); });
  if (layout.has_header) {
    // The name of a single column may contain blanks; the row below decides.
    const bool is_one_name = layout.separator == ' ' && head.size() > 1 && CountFields(second, ' ') == 1;
    if (is_one_name) names = {{Unquote(first), Trim(first).data()}};
    layout.width = names.size();
    return HeadOfNames(names);
  }
  if (separator == '\0') {
    std::optional<char> found = SeparatorOfNumbers(second);
    if (!found) found = SeparatorOfNumbers(first);
    layout.separator = found.value_or(Separator(second));
  }
  layout.width = std::max(CountFields(first, layout.separator), CountFields(second, layout.separator));
  return {};
}

}  // namespace pendulum::csv
