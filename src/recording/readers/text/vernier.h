// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/runs.h"

/// The text that Logger Pro exports. Its lines are "Vernier Format 2", source and date, name of the data set, long
/// names, short names, units, a blank line, and the rows. Columns are separated by tabs.
namespace pendulum::csv {

inline constexpr std::size_t kVernierNames = 3, kVernierUnits = 5;  // Distances from the first line.

inline bool IsVernier(std::string_view line) { return Trim(line).starts_with("Vernier Format"); }

/// `names` is the line of long names, `units` the line of units.
inline std::vector<TableColumn> VernierColumns(std::string_view names, std::string_view units) {
  std::vector<TableColumn> columns;
  FieldCutter unit(units, '\t');
  for (const Name& name : SplitHeader(names, '\t')) {
    const std::string_view text = unit.done() ? std::string_view() : Unquote(unit.Next());
    std::string written(name.text);
    if (!text.empty()) written += " (" + std::string(text) + ")";
    columns.push_back({written, PlainUnits(written), "", name.at});
  }
  return columns;
}

}  // namespace pendulum::csv
