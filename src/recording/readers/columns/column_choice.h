// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/format.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "recording/readers/columns/column.h"
#include "recording/readers/columns/csv.h"

/// Chooses the columns for time and quantity: by the user's options, else by their names, else by their numbers.
namespace pendulum::csv {

struct Column {
  std::size_t index = 0;
  std::string name;  // As messages show it.
  const Unit* unit = nullptr;
  bool is_gyro = false;             // According to its name.
  bool is_without_gravity = false;  // According to its name: a linear acceleration.
};

struct Layout {
  char separator = ',';
  std::size_t width = 0;
  bool has_header = false;
  std::optional<Column> time;  // std::nullopt: times come from a sample rate or from the host.
  bool is_clock = false;       // The times are times of day: 16:04:31.273.
  bool is_from_first = false;  // Times count from the first row, because they began at midnight or in 1970.
  Column value;
  std::optional<Column> second;  // The vertical coordinate of a point whose horizontal one is `value`.
  /// Other axes of a gyro whose first one is `value`, and the direction of the rotation in them, a unit vector of
  /// 1 + axes.size() components; empty if `value` alone is read.
  std::vector<Column> axes;
  Eigen::VectorXd direction;
};

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

std::size_t CountFields(std::string_view row, char separator);

/// The separator with which every field of a row is a number, if any.
std::optional<char> SeparatorOfNumbers(std::string_view row);

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
  bool has_host = false;           // Lines begin with the stamp of a serial monitor.
  std::string raw_input;           // The input of the calibration that will be used, counts or volts; empty: none.
  std::string value_unit;          // Suffix of the unit that the file gives outside its header; empty: none.
  /// Reads the numbers. Called at most once, and only if the names and options do not decide.
  std::function<Result<TableNumbers>()> numbers;
};

/// Chooses the columns. Everything that was assumed is added to `warnings`, with the flag that says otherwise. Errors
/// as ReadRecording; they list all that is missing.
Result<void> ChooseColumns(const TableView& table, const ReadOptions& options, Layout& layout,
                           std::vector<Warning>& warnings);

}  // namespace pendulum::csv
