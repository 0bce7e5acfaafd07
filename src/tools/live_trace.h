// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// The last seconds of a recording in progress, as lines for a terminal.
class LiveTrace {
 public:
  static constexpr double kSeconds = 10;  ///< That are shown.

  /// `unit`: of the values, deg or counts.
  explicit LiveTrace(std::string_view unit) : unit_(unit) {}

  /// The next sample: time [s], value [unit], and its reading [counts, of `full_scale`].
  void Take(double time, double value, double counts, double full_scale);

  /// The plot, kRows lines of less than `width` columns and 77 at most; blank where nothing came.
  std::vector<std::string> Plot(std::size_t width = 80) const;

  /// "12.4 s  200 Hz  -12.3 deg  [     *          ]  none lost": time, samples a second of the last ones, value, where
  /// the reading is between 0 and full scale (LOW and HIGH at the ends), and what the caller has to say.
  std::string StatusLine(std::string_view remark) const;

  static constexpr std::size_t kRows = 12;  ///< Of Plot, with the line of times.

 private:
  struct Point {
    double time, value;
  };

  double Rate() const;
  std::string Level() const;

  std::string unit_;
  std::deque<Point> points_;  // of the last kSeconds
  double counts_ = 0, full_scale_ = 1;
};

/// Draws lines on a terminal over those drawn before.
class RedrawnLines {
 public:
  explicit RedrawnLines(int descriptor) : descriptor_(descriptor) {}

  /// What a line has beyond `width` columns, of one byte each, is left out, for it would be drawn on the next line.
  void Draw(const std::vector<std::string>& lines, std::size_t width);

 private:
  int descriptor_;
  std::size_t drawn_ = 0;  // lines
};

}  // namespace pendulum
