// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>

#include "recording/readers/columns/column_choice.h"
#include "recording/readers/text/vernier.h"

namespace pendulum::csv {

/// Reads the cells of one file that contain numbers.
struct Cells {
  Numbers numbers;
  bool is_gap = false;  // A cell of this row is empty.

  /// Reads a field, which may be quoted, empty or faulty.
  Result<void> Read(const Line& line, std::string_view field, const Column& column, double& number) {
    const std::string_view text = Unquote(field);
    if (numbers.Parse(text, number)) return {};
    if (IsMissing(text)) {
      is_gap = true;
      return {};
    }
    if (IsVernier(text)) {
      return line.Fault(Trim(field).data(), "a second data set begins here; export each data set to its own file");
    }
    return line.Fault(Trim(field).data(), "column " + column.name + " " + numbers.NumberFault(text));
  }

  /// Whether the row had an empty cell. Resets this for the next row.
  bool TakeGap() { return std::exchange(is_gap, false); }
};

}  // namespace pendulum::csv
