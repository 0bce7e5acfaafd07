// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/table.h"

namespace pendulum {

/// Limit for one matrix; with more columns it is not a matrix of readings.
inline constexpr std::size_t kMaxMatColumns = 100;

/// A column of numbers in a MAT-file, and its name in the file.
struct MatColumn {
  csv::TableColumn name;
  std::vector<double> values;
  bool is_unit_known = true;  // For a time: its unit is certain.
};

/// A variable without columns, and its kind.
struct SkippedVariable {
  std::string name, kind;
  bool is_object = false;  // The user can save its numbers as a matrix in MATLAB.
};

/// The contents of a MAT-file that may be a recording.
struct MatTable {
  std::vector<MatColumn> columns;
  std::vector<SkippedVariable> skipped;
  std::string complaint;  // A message of matio; empty: none. After a complaint, the data cannot be trusted.
};

/// Converts the table to bytes, to send it between processes, and back.
std::string Pack(const MatTable& table);
MatTable UnpackMatTable(std::string_view bytes);

}  // namespace pendulum
