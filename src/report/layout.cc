// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/layout.h"

#include <algorithm>
#include <cstddef>

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

/// The width of each column; 0 for one that is empty.
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

}  // namespace

int DisplayWidth(std::string_view text) {
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  return static_cast<int>(text.size()) - static_cast<int>(std::count_if(text.begin(), text.end(), continues));
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

std::string KeySuffix(std::string_view unit) {
  std::string suffix(unit);
  std::ranges::replace(suffix, '/', '_');
  return suffix;
}

}  // namespace pendulum
