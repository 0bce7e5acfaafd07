// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/column_choice.h"

/// The columns of a recording, for all file formats.
namespace pendulum::csv {

/// A column's name in its file and its meaning.
struct TableColumn {
  std::string written;       // As messages and flags use it.
  std::string meaning;       // The equivalent name in a header: `time_s` for Tracker's `t`; empty: not to be read.
  std::string run;           // The run to which the column belongs; empty: all runs.
  const char* at = nullptr;  // Its position in the line of names.
};

/// The index of the column that the user names, by name or 1-based number; the number of columns if there is none.
std::size_t IndexOf(const std::vector<TableColumn>& columns, const std::string& name);

/// NAME or NUMBER, optionally followed by the unit of the times: :s, :ms or :us.
struct TimeFlag {
  std::string column;
  const Unit* unit = nullptr;
};

/// Interprets --time_column for these columns; a colon may be part of a name.
TimeFlag TimeFlagOf(const std::vector<TableColumn>& columns, const std::string& time_column);

/// The columns that could be the quantity. If any column has the requested unit, only columns with this unit.
std::vector<std::size_t> CandidatesOf(const std::vector<TableColumn>& columns, const std::string& unit);

/// The runs beside each other that the columns belong to; they refer to `columns`.
std::set<std::string_view> RunsOf(const std::vector<TableColumn>& columns);

/// The names from which ChooseColumns chooses; they refer to `columns`. If there are several runs, only one run can
/// be chosen: the run of the requested column or of the only candidate. Lengths of vectors are excluded. kDataLoss:
/// several runs have a candidate. kInvalidArgument: the user requests the length of a vector.
Result<std::vector<Name>> NamesOf(const Line& line, const std::vector<TableColumn>& columns,
                                  const ReadOptions& options);

}  // namespace pendulum::csv
