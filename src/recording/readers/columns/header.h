// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

/// Splits the header of a table into names.
namespace pendulum::csv {

/// A name in the header and its position.
struct Name {
  std::string_view text;  // Determines quantity and unit; empty if the column has no name.
  const char* at;
  std::string_view written = text;  // As in the file, for messages and flags.
  bool is_hidden = false;           // The column cannot be used: it belongs to another run, or is a vector's length.
};

/// True for text that occurs only in a header: letters that are not part of a number.
bool IsName(std::string_view text);

/// Splits a header into names. If the separator is a blank, blanks before or inside brackets do not separate.
std::vector<Name> SplitHeader(std::string_view header, char separator);

}  // namespace pendulum::csv
