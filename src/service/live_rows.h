// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pendulum/recording/sensor.h"
#include "service/live_points.h"

namespace pendulum {

/// Reads the lines of a recording from record_pendulum: comments, column names, rows of time and value.
class LiveRows {
 public:
  /// The sample of a line; std::nullopt for comments, column names, and rows that are invalid or not later than the
  /// last one.
  std::optional<LivePoint> Read(std::string_view line);

  bool has_begun() const { return has_names_; }                ///< The column names were read.
  const std::string& unit() const { return unit_; }            ///< Unit of the values.
  const std::optional<double>& rate() const { return rate_; }  ///< Hz

 private:
  void ReadComment(std::string_view text);
  void ReadNames(std::string_view line);

  bool has_names_ = false;
  std::string unit_;
  std::optional<double> rate_;
  std::optional<Calibration> calibration_;  // Calibration of the values; std::nullopt: they are shown unchanged.
  std::optional<double> last_time_;         // s
};

}  // namespace pendulum
