// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "recording/readers/columns/column_choice.h"

/// The columns of a recording, whatever the file that they come from.
namespace pendulum::csv {

/// A column as its file names it, and what the name means.
struct TableColumn {
  std::string written;       // As messages show it and flags choose it.
  std::string meaning;       // What a header would say for it: `time_s` for Tracker's `t`; empty: not to be read.
  std::string run;           // Of several runs side by side that which it belongs to; empty: all of them.
  const char* at = nullptr;  // Where it stands in the line of names.
};

/// The one that the user names, by name or by 1-based number; its index or the number of columns.
std::size_t IndexOf(const std::vector<TableColumn>& columns, const std::string& name);

/// NAME, NUMBER, or either with the unit of the times after it: :s, :ms or :us.
struct TimeFlag {
  std::string column;
  const Unit* unit = nullptr;
};

/// What --time_column says of these columns; a colon may be part of a name.
TimeFlag TimeFlagOf(const std::vector<TableColumn>& columns, const std::string& time_column);

/// Those that could be the quantity, of the unit that the user asks for if there are any.
std::vector<std::size_t> CandidatesOf(const std::vector<TableColumn>& columns, const std::string& unit);

/// The names that a ColumnChooser chooses from, which refer to `columns`: of several runs the columns of one, that of
/// the chosen column or of the only candidate; the length of a vector is none. kDataLoss: several runs have a
/// candidate. kInvalidArgument: the length of a vector is asked for.
Result<std::vector<Name>> NamesOf(const Line& line, const std::vector<TableColumn>& columns,
                                  const ReadOptions& options);

}  // namespace pendulum::csv
