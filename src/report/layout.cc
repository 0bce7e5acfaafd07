// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/layout.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pendulum {
namespace {

std::string Blanks(int count) {
  std::string blanks;
  return blanks.append(static_cast<std::size_t>(std::max(count, 0)), ' ');
}

std::string Padded(const std::string& cell, int width, bool right_aligned) {
  const std::string blanks = Blanks(width - DisplayWidth(cell));
  return right_aligned ? blanks + cell : cell + blanks;
}

/// The width of each column; 0 if it is empty.
std::vector<int> ColumnWidths(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows) {
  std::vector<int> widths;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    int width = 0;
    for (const auto& row : rows) width = std::max(width, DisplayWidth(row[i]));
    widths.push_back(width == 0 ? 0 : std::max(width, DisplayWidth(columns[i].header)));
  }
  return widths;
}

std::string Line(const std::vector<Column>& columns, const std::vector<int>& widths,
                 const std::vector<std::string>& cells, int indent) {
  std::string line;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (widths[i] == 0) continue;
    line += (line.empty() ? Blanks(indent) : Blanks(columns[i].gap)) +
            Padded(cells[i], widths[i], columns[i].right_aligned);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

/// Columns shown together next to the first one.
using Group = std::vector<std::size_t>;

/// Distributes columns to groups; each fits next to the first column within `width`.
std::vector<Group> GroupsWithin(const std::vector<Column>& columns, const std::vector<int>& widths, int indent,
                                int width) {
  std::vector<Group> groups(1);
  const int first = indent + widths[0];
  int used = first;
  for (std::size_t i = 1; i < columns.size();) {
    std::size_t end = i;
    int needed = 0;
    do {
      if (widths[end] > 0) needed += columns[end].gap + widths[end];
      ++end;
    } while (end < columns.size() && columns[end].gap == 1);
    if (used + needed > width && !groups.back().empty() && used > first) {
      groups.emplace_back();
      used = first;
    }
    used += needed;
    for (; i < end; ++i) groups.back().push_back(i);
  }
  return groups;
}

/// A table of the first column and a group.
std::string GroupTable(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                       const Group& group, bool keep_empty, int indent) {
  std::vector<Column> shown = {columns[0]};
  for (const std::size_t i : group) shown.push_back(columns[i]);
  std::vector<std::vector<std::string>> shown_rows;
  for (const auto& row : rows) {
    std::vector<std::string> cells = {row[0]};
    for (const std::size_t i : group) cells.push_back(row[i]);
    const bool has_text = std::any_of(cells.begin() + 1, cells.end(), [](const auto& cell) { return !cell.empty(); });
    if (has_text || keep_empty) shown_rows.push_back(std::move(cells));
  }
  return AlignedTable(shown, shown_rows, indent);
}

}  // namespace

int DisplayWidth(std::string_view text) {
  int width = 0;
  bool in_sequence = false;
  for (const char c : text) {
    const bool continues = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
    if (c == '\x1B') in_sequence = true;
    if (!in_sequence && !continues) ++width;
    if (c == 'm') in_sequence = false;
  }
  return width;
}

std::string AlignedTable(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                         int indent) {
  const std::vector<int> widths = ColumnWidths(columns, rows);
  std::vector<std::string> headers;
  headers.reserve(columns.size());
  for (const Column& column : columns) headers.push_back(column.header);
  std::string table = Line(columns, widths, headers, indent);
  if (table == "\n") table.clear();
  for (const auto& row : rows) table += Line(columns, widths, row, indent);
  return table;
}

std::string TableWithin(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                        int indent, int width) {
  if (columns.empty()) return "";
  const std::vector<Group> groups = GroupsWithin(columns, ColumnWidths(columns, rows), indent, width);
  std::string table;
  for (const Group& group : groups) {
    const bool is_first = table.empty();
    table += (is_first ? "" : "\n") + GroupTable(columns, rows, group, is_first, indent);
  }
  return table;
}

std::string Paragraph(std::string_view text, std::string_view first, int width) {
  std::string paragraph;
  std::string line(first);
  bool has_word = false;
  for (std::size_t begin = text.find_first_not_of(' '); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (has_word && DisplayWidth(line) + 1 + DisplayWidth(word) > width) {
      paragraph += line + "\n";
      line = Blanks(DisplayWidth(first));
      has_word = false;
    }
    line.append(has_word ? " " : "").append(word);
    has_word = true;
    begin = text.find_first_not_of(' ', end);
  }
  return paragraph + line + "\n";
}

std::string WithBlanks(std::string text) {
  for (std::size_t at = text.find(kNoBreak); at != std::string::npos; at = text.find(kNoBreak, at)) {
    text.replace(at, kNoBreak.size(), " ");
  }
  return text;
}

std::string KeySuffix(std::string_view unit) {
  std::string suffix(unit);
  std::ranges::replace(suffix, '/', '_');
  std::erase(suffix, '^');
  return suffix;
}

}  // namespace pendulum
