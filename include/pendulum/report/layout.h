// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

struct Column {
  std::string header;
  bool right_aligned = false;
  int gap = 2;  ///< Number of blanks before the column.
};

/// Columns of a UTF-8 text on a terminal. Each code point counts as one (no East Asian wide characters), ANSI colour
/// sequences count as none.
int DisplayWidth(std::string_view text);

/// Rows below the headers. Every line begins with `indent` blanks and has no trailing blanks. Empty columns are left
/// out, and so is an empty line of headers. Each row has one cell per column.
std::string AlignedTable(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                         int indent);

/// AlignedTable with lines of at most `width` characters, provided that each column fits next to the first. Columns
/// that do not fit are printed below a blank line, again next to the first column; rows that are empty in these columns
/// are left out there. A column with a gap of 1 stays next to the previous column.
std::string TableWithin(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                        int indent, int width);

/// A text wrapped to lines of at most `width` characters (a longer word gets a separate line). The first line begins
/// with `first`, the others with equally many blanks. Ends with a line break.
std::string Paragraph(std::string_view text, std::string_view first, int width);

inline constexpr std::string_view kNoBreak = "\xC2\xA0";  ///< U+00A0, a blank where Paragraph does not break a line.

/// The text with no-break spaces replaced by blanks.
std::string WithBlanks(std::string text);

/// A unit as the end of a key or a column name: rad_s for rad/s, m_s2 for m/s^2.
std::string KeySuffix(std::string_view unit);

}  // namespace pendulum
