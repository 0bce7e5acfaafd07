// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/warning.h"
#include "recording/readers/columns/column_choice.h"

/// What the choosers of time and quantity share.
namespace pendulum::csv {

/// Indices of columns.
using Columns = std::vector<std::size_t>;

/// The meanings of the names, then those of columns without a name up to `width`.
std::vector<NameMeaning> MeaningsOf(const std::vector<Name>& names, std::size_t width);

/// The columns x, y and z, if all have no unit: the axes of a gyro or an accelerometer, or the coordinates of a point.
std::optional<std::array<std::size_t, 3>> FindAxes(const std::vector<NameMeaning>& meanings);

/// Whether a name without a unit is no more than `ax`, `a_y` or `aZ`: an acceleration, but perhaps the point or the
/// azimuth `a`.
bool IsShortAcceleration(const NameMeaning& meaning);

/// A choice of columns that is being made: the table, what has been chosen and assumed, and what the user must tell.
struct Choice {
  const TableView& table;
  const ReadOptions& options;
  Layout& layout;
  std::vector<Warning>& warnings;
  const std::vector<Name>& names = table.names;
  const std::vector<NameMeaning> meanings = MeaningsOf(table.names, layout.width);
  std::optional<std::size_t> time = {};      // The column of times, if the user named it or it has been chosen.
  std::optional<std::size_t> value = {};     // The column of the quantity.
  std::optional<std::size_t> vertical = {};  // The other coordinate of a point that no name shows.
  Columns axes = {};                         // The other axes of a rotation.
  std::optional<TableNumbers> numbers = {};
  std::optional<std::size_t> example = {};   // Of a column that the user may choose.
  std::vector<ReadQuestion> questions = {};  // What the user must tell.

  // ---- Names

  std::string NameOf(std::size_t index) const;
  std::vector<std::string> NamesOf(const Columns& columns) const;

  /// The column as a flag names it: its name, or its number if it has none of its own, a very
  /// long one, or one that is not UTF-8, which JSON could not return.
  std::string FlagValueOf(std::size_t index) const;

  /// All names, for messages.
  std::string ColumnNames() const;

  const NameMeaning& Meaning(std::size_t index) const { return meanings.at(index); }

  /// Finds a column by its name or its number. kInvalidArgument: there is no such column.
  Result<std::size_t> FindColumn(const std::string& flag, std::string_view name) const;

  /// The columns whose names say that they are times.
  Columns TimesByName() const;

  // ---- Messages

  const char* PlaceOf(std::size_t index) const;
  tl::unexpected<Status> WrongFlag(std::size_t index, const std::string& sentence) const;

  /// Warns of an assumption about this file.
  void Assume(Warning assumption);

  /// Notes what the user must tell, and an example of the flags that tell it. Without an example, `option` is the name
  /// of the flag.
  void Ask(const std::string& sentence, const std::vector<std::string>& flags, std::string_view option = "");

  /// Asks which column the quantity is; `best` is the example. The sentence says why.
  void AskForColumn(const std::string& sentence, std::size_t best);

  /// The error that lists all questions, if there are any; `place` is the column to which it points.
  Result<void> Answer(std::size_t place) const;

  // ---- Numbers

  /// Reads the numbers unless they have been read. The functions below need them.
  Result<void> NeedNumbers();

  const Eigen::VectorXd& NumbersOf(std::size_t index) const { return numbers->columns[index]; }

  /// A column in SI units, as far as its unit is known.
  Eigen::VectorXd SwingOf(std::size_t index) const;

  /// Whether at least every twentieth cell of a column is a number.
  bool IsNumeric(std::size_t index) const;

  /// Whether a column holds times of day.
  bool IsClock(std::size_t index) const { return numbers->is_clock[index]; }

  /// Whether the name of a column leaves open that it is the time: it says nothing, or only x.
  bool MayBeTime(std::size_t index) const;

  /// Whether the numbers of a column increase, as times do; at most one in a hundred is smaller than the one before.
  bool IsIncreasing(std::size_t index) const;

  /// Whether a column counts the rows: whole numbers that increase by 1.
  bool IsRowNumber(std::size_t index) const;
};

/// Whether quantities lie between columns of times, so that each time belongs to a run beside the others.
bool AreSeparated(const Columns& times);

/// The last of the times before this column, otherwise the first.
std::size_t TimeBefore(const Columns& times, std::size_t value);

}  // namespace pendulum::csv
