// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/table.h"
#include "recording/readers/text/host_stamp.h"

/// The structure of a text, found in its first lines: what stands above the table, header, separator, number of fields.
namespace pendulum::csv {

/// True for an empty line, and for an empty row written by a spreadsheet.
inline bool IsEmptyRow(std::string_view line) { return line.find_first_not_of(" \t,;") == std::string_view::npos; }

/// The separator from a line such as `sep=;`, which spreadsheets write for themselves.
std::optional<char> SeparatorLine(std::string_view line);

/// A line of a text, without its end.
struct TextLine {
  std::string_view text;
  std::size_t number = 0;  // 1-based.
};

/// The structure of a text.
struct Head {
  std::vector<TableColumn> columns;  // Empty without a header.
  TextLine names;                    // The line with the names; without a header, the first row.
  TextLine first_row;                // Its number is 0 if there is no row.
  bool has_host = false;             // Lines begin with the stamp of a serial monitor.
  bool may_be_short = false;       // Rows may end early: columns of other lengths, and their separators, are left out.
  double sample_rate_hz = 0;       // From the lines above the table, as LabVIEW and oscilloscopes write it; 0: none.
  TextLine rate_line;              // The line that states this rate in words; its number is 0 if there is none.
  std::string value_unit;          // Suffix of a unit from the lines above the table; empty: none.
  std::size_t fields_of_text = 0;  // Of the first row, if it begins with text.
};

/// The part of a line that the device sent.
inline std::string_view DevicePart(std::string_view line, bool has_host) {
  const auto stamp = has_host ? FindHostStamp(line) : std::nullopt;
  return stamp ? stamp->rest : line;
}

/// The part of a line without the stamps that a host, or the device itself, puts before its remarks: "14:03:22.123 ->
/// ", "12:04:33 ". Where rows begin with a time of day, that is no stamp.
std::string_view RemarkPart(std::string_view line, const Head& head);

/// Whether a line from the first row on is text and no row: it begins with text other than a missing number. If rows
/// begin with text too, it has fewer fields.
bool IsTextAmongRows(std::string_view line, const Head& head, char separator);

/// Whether a line has the names of the columns, or the first line of names with line breaks.
bool IsHeaderAgain(std::string_view line, const Head& head, const Layout& layout);

/// Examines the first lines of a text. The table begins with the first two rows that have numbers where the later rows
/// have numbers; the names are in the line above, or in the one above a line of units, a rule or a few remarks. Sets
/// separator, width and has_header. `begin` must outlive the result.
Head ParseHead(std::string_view begin, Layout& layout);

/// Reads the numbers of the rows of a text from line `first_row` on, at most kMostCells; `number` is the number of the
/// text's first line.
TableNumbers ReadNumbers(std::string_view text, std::size_t number, const Head& head, const Layout& layout);

/// The cells of the first rows of a text, at most `most` rows, as they are written, without quotes. `text` begins with
/// line 1.
std::vector<std::vector<std::string>> FirstRows(std::string_view text, std::size_t most, const Head& head,
                                                const Layout& layout);

}  // namespace pendulum::csv
