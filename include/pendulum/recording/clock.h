// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"

namespace pendulum {

/// The line of its file that each row stands on; remembered only where lines are skipped.
class LineNumbers {
 public:
  /// The next row, 0, 1, ..., stands on this line, which is beyond those before.
  void Add(std::size_t line) {
    if (line != last_line_ + 1 || size_ == 0) jumps_.emplace_back(size_, line);
    last_line_ = line;
    ++size_;
  }

  std::size_t LineOf(Eigen::Index row) const;

  Eigen::Index size() const { return size_; }

 private:
  std::vector<std::pair<Eigen::Index, std::size_t>> jumps_;  // Rows that do not follow on the line before, and lines.
  Eigen::Index size_ = 0;
  std::size_t last_line_ = 0;
};

/// Rows of a file before their times are trusted.
struct RawSamples {
  std::string name;             ///< Of the file, for messages.
  std::string time_unit = "s";  ///< s, ms or us.
  Eigen::VectorXd time;         ///< N x 1, in time_unit, finite, as the file has them.
  Eigen::VectorXd value;        ///< N x 1, finite, in any unit.
  Eigen::VectorXd second;       ///< N x 1 beside it, or 0 x 1: the other coordinate of a point.
  LineNumbers lines;            ///< N of them.
  double clock_std_dev = 0;     ///< Of a clock rebuilt from coarse stamps: relative standard deviation of its rate.
  std::vector<Warning> warnings;
};

/// Makes the times increase where that is safe, with a warning that has the count and the first line: time_wrapped:
/// whole ms or us that begin again after 2³² or 2¹⁶ are counted on, where the step across looks like the others.
/// time_rounded: stamps on a grid that is coarse against the sampling interval are replaced by the middle of the
/// uniform clocks that agree with all of them, whose spread is clock_std_dev; where none does and they increase, they
/// are kept. time_repeated: rows that share a stamp are left out, of equal ones one is kept, up to a fifth of all.
/// time_not_increasing: the fewest rows are left out where stamps go back by at most kMostStepsBack sampling intervals,
/// up to a twentieth of all. A gap, and sampling at uneven intervals, is ordinary. kDataLoss: any other stamps that do
/// not increase; the message has the line, both times and what to do. Cost: one pass, about twenty if not uniform.
Result<RawSamples> RepairClock(RawSamples samples);

/// Beyond so many sampling intervals (median) a clock did not stumble, it was set back.
inline constexpr int kMostStepsBack = 5;

}  // namespace pendulum
