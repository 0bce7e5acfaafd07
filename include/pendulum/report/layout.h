// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

struct Column {
  std::string header;
  bool right_aligned = false;
  int gap = 2;  ///< Blanks before it.
};

/// Columns a UTF-8 text takes on a terminal, each code point counted as one (no East Asian wide characters), ANSI
/// sequences of colour as none.
int DisplayWidth(std::string_view text);

/// Rows below the headers, every line begun with `indent` blanks and without blanks at its end. A column whose cells
/// are all empty is left out; so is the line of headers when all are empty. Each row has one cell per column.
std::string AlignedTable(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                         int indent);

/// The same in at most `width` columns where each column fits beside the first: those that do not go on below, a blank
/// line and the first column before them. A column with a gap of 1 stays beside the one before it; a row that has
/// nothing in the columns that go on is left out there.
std::string TableWithin(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                        int indent, int width);

/// Words filled into lines of at most `width` columns (a longer word has a line of its own), the first begun with
/// `first`, the others with as many blanks. Ends with a line break.
std::string Paragraph(std::string_view text, std::string_view first, int width);

inline constexpr std::string_view kNoBreak = "\xC2\xA0";  ///< U+00A0, a blank at which Paragraph breaks no line.

/// A text with blanks for no-break spaces.
std::string WithBlanks(std::string text);

/// A unit as the end of a key or a column: rad_s for rad/s.
std::string KeySuffix(std::string_view unit);

}  // namespace pendulum
