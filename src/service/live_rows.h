// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pendulum/recording/sensor.h"
#include "service/live_points.h"

namespace pendulum {

/// The lines of a recording as record_pendulum writes it: comments, the names of the columns, rows of time and value.
class LiveRows {
 public:
  /// The sample of a line; none where it is a comment, the names, or no row that follows the last in time.
  std::optional<LivePoint> Take(std::string_view line);

  bool has_begun() const { return has_names_; }                ///< The names of the columns were there.
  const std::string& unit() const { return unit_; }            ///< Of the values.
  const std::optional<double>& rate() const { return rate_; }  ///< Hz

 private:
  void TakeComment(std::string_view text);
  void TakeNames(std::string_view line);

  bool has_names_ = false;
  std::string unit_;
  std::optional<double> rate_;
  std::optional<Calibration> calibration_;  // Of the values; none: they are shown as they are.
  std::optional<double> last_time_;         // s
};

}  // namespace pendulum
