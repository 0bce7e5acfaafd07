// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// A plot of the last seconds of a recording in progress, for a terminal.
class LiveTrace {
 public:
  static constexpr double kSeconds = 10;  ///< Shown duration.

  /// `unit`: unit of the values, deg or counts.
  explicit LiveTrace(std::string_view unit) : unit_(unit) {}

  /// Adds a sample: time [s], value [unit], and the converter's reading from 0 to `full_scale` [counts].
  void Add(double time, double value, double counts, double full_scale);

  /// The plot: kRows lines of less than `width` and at most 77 columns; blank without samples.
  std::vector<std::string> Plot(std::size_t width = 80) const;

  /// "12.4 s  200 Hz  -12.3 deg  [     *          ]  none lost": time, current sampling rate, value, position of the
  /// reading between 0 and full scale (LOW and HIGH at the ends), and `remark`.
  std::string StatusLine(std::string_view remark) const;

  static constexpr std::size_t kRows = 12;  ///< Lines of Plot, including the time axis.

 private:
  struct Point {
    double time, value;
  };

  double Rate() const;
  std::string Level() const;

  std::string unit_;
  std::deque<Point> points_;  // samples of the last kSeconds
  double counts_ = 0, full_scale_ = 1;
};

/// Redraws lines on a terminal over the previous ones.
class RedrawnLines {
 public:
  explicit RedrawnLines(int descriptor) : descriptor_(descriptor) {}

  /// Lines are cut to less than `width` bytes, each byte one column, because a longer line would continue on the next
  /// line.
  void Draw(const std::vector<std::string>& lines, std::size_t width);

 private:
  int descriptor_;
  std::size_t drawn_ = 0;  // lines
};

}  // namespace pendulum
