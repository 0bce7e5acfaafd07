// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// A column of a table in plain text.
struct Column {
  std::string header;
  bool right_aligned = false;
  int gap = 2;  ///< Blanks before it.
};

/// Columns a UTF-8 text takes on a terminal, each code point counted as one (no East Asian wide characters).
int DisplayWidth(std::string_view text);

/// Rows below the headers, every line begun with `indent` blanks and without blanks at its end. A column whose cells
/// are all empty is left out; so is the line of headers when all are empty. Each row has one cell per column.
std::string AlignedTable(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows,
                         int indent);

/// Words filled into lines of at most `width` columns (a longer word has a line of its own), the first begun with
/// `first`, the others with as many blanks. Ends with a line break.
std::string Paragraph(std::string_view text, std::string_view first, int width);

/// A unit as the end of a key or a column: rad_s for rad/s.
std::string KeySuffix(std::string_view unit);

}  // namespace pendulum
