// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/table.h"

/// Tables from ROS: rostopic echo -p, bags converted to CSV, PlotJuggler. Names are paths, times are stamps since 1970,
/// angles are in rad and rates in rad/s (REP 103). A row may belong to one of several joints.
namespace pendulum::csv {

inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

struct RosTable {
  std::size_t seconds = kNoColumn;      // Column of stamps: seconds, or nanoseconds since 1970.
  std::size_t nanoseconds = kNoColumn;  // Column of the part of a stamp below one second.
  bool is_nanoseconds = false;          // `seconds` contains whole nanoseconds, as `%time` of rostopic.
  std::size_t joint = kNoColumn;        // Column of joint names, if each row belongs to one joint.
};

/// Detects a table from ROS and gives its columns a meaning. If there are an angle and a rate of one joint, the angle
/// is the quantity unless the user requests another. `row` is the first row.
std::optional<RosTable> FindRos(std::vector<TableColumn>& columns, std::string_view row, char separator,
                                const ReadOptions& options);

/// Converts stamps to seconds since the first stamp, exactly. A double could store stamps since 1970 only to 256 ns.
class StampClock {
 public:
  explicit StampClock(bool is_whole_nanoseconds = false) : is_whole_nanoseconds_(is_whole_nanoseconds) {}

  /// Returns false if the text is not a stamp. A whole number of 16 digits or more is in nanoseconds.
  bool Read(std::string_view seconds, std::string_view nanoseconds, double& time);

 private:
  bool is_whole_nanoseconds_;
  std::optional<std::int64_t> first_;  // ns
};

}  // namespace pendulum::csv
