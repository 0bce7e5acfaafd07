// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"

namespace pendulum {

/// The line number of each row. Only jumps are stored.
class LineNumbers {
 public:
  /// Adds the next row (0, 1, ...). Its line comes after those of the previous rows.
  void Add(std::size_t line) {
    if (line != last_line_ + 1 || size_ == 0) jumps_.emplace_back(size_, line);
    last_line_ = line;
    ++size_;
  }

  std::size_t LineOf(Eigen::Index row) const;

  Eigen::Index size() const { return size_; }

 private:
  /// Rows that are not on the line after the previous row, and their lines.
  std::vector<std::pair<Eigen::Index, std::size_t>> jumps_;
  Eigen::Index size_ = 0;
  std::size_t last_line_ = 0;
};

/// Rows of a file before their times are checked.
struct RawSamples {
  std::string name;             ///< Of the file, for messages.
  std::string time_unit = "s";  ///< s, ms or us.
  Eigen::VectorXd time;         ///< N x 1, in time_unit, finite, as in the file.
  Eigen::VectorXd value;        ///< N x 1, finite, in any unit.
  Eigen::VectorXd second;       ///< N x 1, the other coordinate of a point; or 0 x 1.
  LineNumbers lines;            ///< Line number of each of the N rows.
  double clock_std_dev = 0;     ///< Relative; of the rate of a clock computed from coarse time stamps.
  std::vector<Warning> warnings;
  std::size_t left_out = 0;  ///< Rows between these that have no reading; their times are missing here.
};

/// The part of a recording that is used, s on the file's clock; NaN leaves that end open.
struct ClockWindow {
  double from = std::numeric_limits<double>::quiet_NaN();
  double to = std::numeric_limits<double>::quiet_NaN();

  bool IsOpen() const { return std::isnan(from) && std::isnan(to); }
};

/// Makes the times increase where that is safe. Each warning gives a count and the first line. time_wrapped: whole ms
/// or us that start again after 2³² or 2¹⁶ are continued, if the step across the restart is like the other steps.
/// time_rounded: time stamps on a grid that is coarse compared with the sampling interval. They are replaced by the
/// middle of the uniform clocks that agree with all of them; clock_std_dev gives the spread of these clocks. If no
/// clock agrees and the stamps increase, they are kept; also if rows were left out, which leaves gaps like those of
/// rounding. Times with few significant digits are treated in the same way.
/// time_bursts: rows that a host stamped in packets. The stamps are replaced by the uniform clock of the device, with
/// its standard error in clock_std_dev, if nothing contradicts uniform sampling without lost rows. Otherwise stamps
/// that increase within packets are kept although they are wrong, and the warning says so. rows_repeated: at least 3
/// rows at the start or the end that repeat one row, time and value, are left out. time_repeated: rows that share a
/// time stamp are left out, up to a fifth of all; of identical rows one is kept. time_not_increasing: stamps go back by
/// at most kMaxStepsBack sampling intervals, or a few rows in succession have stamps far from those around them. As few
/// rows as possible are left out, up to a twentieth of all. Gaps and
/// uneven sampling cause no warning. kDataLoss: any other stamps that do not increase, one or two rows at an end whose
/// distance from the others is ten times the time of all others and a million sampling intervals, and a gap of 1e9
/// intervals; the message has the line, the times and what to do. Cost: one pass, about twenty if the stamps are not
/// uniform.
///
/// If the stamps of the whole file cannot be repaired, those in the window are. time_outside_window: only its rows are
/// returned.
Result<RawSamples> RepairClock(RawSamples samples, const ClockWindow& window = {});

/// A clock that goes back by more sampling intervals (median) than this was set back.
inline constexpr int kMaxStepsBack = 5;

}  // namespace pendulum
