// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/table.h"

namespace pendulum {

/// Of one matrix: with more it is none of readings.
inline constexpr std::size_t kMostMatColumns = 100;

/// A column of numbers in a MAT-file, and what it is called there.
struct MatColumn {
  csv::TableColumn name;
  std::vector<double> values;
  bool is_unit_told = true;  // That of a time.
};

/// A variable that holds no columns, and what it is.
struct SkippedVariable {
  std::string name, kind;
  bool is_object = false;  // Whose numbers MATLAB can save.
};

/// What a MAT-file holds that may be a recording.
struct MatTable {
  std::vector<MatColumn> columns;
  std::vector<SkippedVariable> skipped;
  std::string complaint;  // Of matio; what it complains of cannot be trusted.
};

/// The table as bytes, for the way between processes, and back.
std::string Pack(const MatTable& table);
MatTable UnpackMatTable(std::string_view bytes);

}  // namespace pendulum
