// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/format.h"
#include "pendulum/base/warning.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "recording/readers/columns/csv.h"
#include "recording/readers/columns/header.h"
#include "recording/readers/columns/layout.h"

/// Chooses the columns for time and quantity: by the user's options, else by their names, else by their numbers.
namespace pendulum::csv {

/// So many numbers of a table are enough to choose its columns, and are read at most for this.
inline constexpr std::size_t kMostCells = std::size_t{1} << 24;

/// The numbers of all columns of a table.
struct TableNumbers {
  std::vector<Eigen::VectorXd> columns;  // As wide as the table, of equal length; NaN where a cell has no number.
  std::vector<bool> is_clock;            // The column holds times of day; its numbers are seconds.
};

/// What a chooser knows of a table.
struct TableView {
  Line line;                       // The header, for messages.
  const std::vector<Name>& names;  // Empty without a header.
  bool has_rate = false;           // The file gives a sample rate.
  bool is_rate_weak = false;       // It is from the lines that a program writes above its tables; times count more.
  bool has_host = false;           // Lines begin with the stamp of a serial monitor.
  std::string raw_input;           // The input of the calibration that will be used, counts or volts; empty: none.
  std::string value_unit;          // Suffix of the unit that the file gives outside its header; empty: none.
  /// Reads the numbers. Called at most once, and only if the names and options do not decide.
  std::function<Result<TableNumbers>()> numbers;
  /// The first rows as text, for ReadOptions::preview.
  std::function<std::vector<std::vector<std::string>>()> first_rows;
};

/// Chooses the columns. Everything that was assumed is added to `warnings`, with the flag that says otherwise. Errors
/// as ReadRecording; they list all that is missing.
Result<void> ChooseColumns(const TableView& table, const ReadOptions& options, Layout& layout,
                           std::vector<Warning>& warnings);

}  // namespace pendulum::csv
