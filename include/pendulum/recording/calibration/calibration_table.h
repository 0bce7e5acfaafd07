// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"

namespace pendulum {

/// Nobody sets more points by hand; a longer file is a recording.
inline constexpr Eigen::Index kMaxCalibrationPoints = 10'000;

/// The readings of a sensor at known angles. Invariant (MakeCalibrationTable): N >= 2, finite, no repeated reading.
/// Sorted by reading, the angles only rise or only fall (neighbours may be equal), and not all are equal.
struct CalibrationTable {
  std::string path;                ///< The source, as the user named it.
  std::string input, angle_unit;   ///< Units: counts or volts of the readings, deg or rad of the angles.
  Eigen::VectorXd reading, angle;  ///< N x 1, in the units `input` and angle_unit, in the order of the file.
  std::vector<std::size_t> line;   ///< N, line number of each point, 1-based.

  Eigen::Index size() const { return reading.size(); }

  /// "path:line" of a point.
  std::string Place(Eigen::Index point) const { return path + ":" + std::to_string(line[point]); }

  /// Indices of the points from the smallest reading to the largest.
  std::vector<Eigen::Index> ByReading() const;
};

/// Checks the invariant. kDataLoss: it is violated; the message names the lines of both points.
Result<CalibrationTable> MakeCalibrationTable(CalibrationTable table);

/// Reads a table from a CSV file; "-" is standard input. The first line names the columns in any order: one with the
/// suffix `_counts` or `_volts`, and one with `_deg` or `_rad`. As in a recording, `adc_counts`, `Pot (volts)` and
/// `counts` are equivalent. Columns without a unit in their name are ignored. Separators, decimal commas, quotes, #
/// comments, byte order mark and line ends are as in ReadRecording. kNotFound: no such file. kDataLoss: not readable as
/// above, no header, a column missing or repeated, one of another unit, more than kMaxCalibrationPoints rows, or not a
/// CalibrationTable. Messages begin "path:line:".
Result<CalibrationTable> ReadCalibrationTable(const std::filesystem::path& path);

/// The same from text in memory; `name` replaces the path. Never returns kNotFound.
Result<CalibrationTable> ParseCalibrationTable(std::string_view text, const std::string& name);

}  // namespace pendulum
