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

/// What the first lines of a file tell: whether there is a header, what separates fields, how many there are.
namespace pendulum::csv {

/// True for a line without anything in it, and for what a spreadsheet leaves of an empty row.
inline bool IsEmptyRow(std::string_view line) { return line.find_first_not_of(" \t,;") == std::string_view::npos; }

/// What a line such as `sep=;`, which a spreadsheet writes for itself, says of the separator.
inline std::optional<char> SeparatorLine(std::string_view line) {
  constexpr std::string_view kKey = "sep=";
  line.remove_prefix(line.starts_with('"') ? 1 : 0);
  if (line.size() <= kKey.size() || !line.starts_with(kKey)) return std::nullopt;
  return line[kKey.size()];
}

/// One of the first lines, which are kept until it is known what they are.
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

/// What the device sent of a line.
inline std::string_view DevicePart(std::string_view line, bool has_host) {
  const auto stamp = has_host ? FindHostStamp(line) : std::nullopt;
  return stamp ? stamp->rest : line;
}

/// What the first lines say of the rows below them.
struct Head {
  std::vector<TableColumn> columns;  // None without a header.
  std::size_t names_line = 0;        // Of these lines that with the names.
  std::size_t first_row = 0;         // Of these lines the first that is a row.
  bool may_have_gaps = false;        // Cells may be empty: the programs pad columns of different lengths.
};

/// How many lines must be seen before it is known what they are: a header and a row, or two rows of which the first may
/// be cut off; a third where a label may stand above the header.
inline std::size_t HeadLines(const HeadLine& first) {
  if (IsVernier(first.text)) return kVernierUnits + 2;
  const std::vector<Name> names = SplitHeader(first.text, Separator(first.text));
  const bool is_name =
      std::ranges::all_of(names, [](const Name& name) { return name.text.empty() || IsName(name.text); });
  const bool has_time = std::ranges::any_of(names, [](const Name& name) { return IsTime(SplitRun(name.text).rest); });
  return is_name && !has_time ? 3 : 2;
}

inline Head LookAtVernier(const std::vector<HeadLine>& head, Layout& layout) {
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

/// The names of an ordinary header, or of one of the programs that write it in a way of their own.
inline Head HeadOfNames(const std::vector<Name>& names) {
  // Phyphox quotes names and pads with NaN; nobody quotes the time by hand.
  Head found;
  for (const Name& name : names) found.columns.push_back({std::string(name.text), std::string(name.text), "", name.at});
  found.first_row = 1;
  found.may_have_gaps = SplitRuns(found.columns);
  found.may_have_gaps |= !names.empty() && names.front().text == "Time (s)" && names.front().at[0] == '"';
  return found;
}

/// Fills separator, width and has_header from the first lines. `separator` is what the file itself says, or '\0'.
inline Head LookAtHead(const std::vector<HeadLine>& head, bool has_host, char separator, Layout& layout) {
  if (IsVernier(head.front().text)) return LookAtVernier(head, layout);
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
    // Blanks stand in the name of a single column too; the row below it tells.
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
