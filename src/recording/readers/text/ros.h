// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/table.h"

/// Tables that come from ROS: rostopic echo -p, bags made CSV, PlotJuggler. Names are paths, times are stamps since
/// 1970, angles are rad and rates rad/s (REP 103), and a row may be of one joint among several.
namespace pendulum::csv {

inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

struct RosTable {
  std::size_t seconds = kNoColumn;      // Column of stamps: seconds, or nanoseconds since 1970.
  std::size_t nanoseconds = kNoColumn;  // Column of what a stamp has beyond whole seconds.
  bool is_nanoseconds = false;    // A whole number in the first of these columns is in nanoseconds, however small:
                                  // those of `%time`, which rostopic writes.
  std::size_t joint = kNoColumn;  // Column of names, where each row is one joint's.
};

/// Looks for such a table, whose columns get a meaning: of a joint's angle and rate the angle is its quantity, unless
/// the user asks for another. `row` is the first row.
std::optional<RosTable> FindRos(std::vector<TableColumn>& columns, std::string_view row, char separator,
                                const ReadOptions& options);

/// Stamps in seconds since the first of them, exactly: a double holds those since 1970 to no better than 256 ns.
class StampClock {
 public:
  explicit StampClock(bool is_whole_nanoseconds = false) : is_whole_nanoseconds_(is_whole_nanoseconds) {}

  /// False for what is no stamp. A whole number of 16 digits or more is in nanoseconds.
  bool Read(std::string_view seconds, std::string_view nanoseconds, double& time);

 private:
  bool is_whole_nanoseconds_;
  std::optional<std::int64_t> first_;  // ns
};

}  // namespace pendulum::csv
