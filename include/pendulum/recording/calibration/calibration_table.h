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

/// More points than anybody sets by hand: what is longer is a recording.
inline constexpr Eigen::Index kMostCalibrationPoints = 10'000;

/// What a sensor read at known angles. Invariant (MakeCalibrationTable): N >= 2, finite, no reading twice; sorted by
/// reading, the angles rise throughout or fall throughout (neighbours may have the same angle), and not all are equal.
struct CalibrationTable {
  std::string path;                ///< Where it came from, as the user named it.
  std::string input, angle_unit;   ///< Units: counts or volts of the readings, deg or rad of the angles.
  Eigen::VectorXd reading, angle;  ///< N x 1, in the units `input` and angle_unit, in the order of the file.
  std::vector<std::size_t> line;   ///< N, where each stands, 1-based.

  Eigen::Index size() const { return reading.size(); }

  /// "path:line" of a point.
  std::string Place(Eigen::Index point) const { return path + ":" + std::to_string(line[point]); }

  /// The points from the least reading to the greatest.
  std::vector<Eigen::Index> ByReading() const;
};

/// Checks the invariant. kDataLoss: it does not hold; the message has the places of both points.
Result<CalibrationTable> MakeCalibrationTable(CalibrationTable table);

/// Reads a table from a CSV file; "-" is standard input. The first line names the columns in any order, one with the
/// suffix `_counts` or `_volts` and one with `_deg` or `_rad`; as in a recording `adc_counts`, `Pot (volts)` and
/// `counts` say the same. Columns whose names tell no unit are not read. Separators, decimal commas, quotes, #
/// comments, byte order mark and line ends are those of ReadRecording. kNotFound: no such file. kDataLoss: not readable
/// as above, no header, a column missing or there twice, one of another unit, more than kMostCalibrationPoints rows, or
/// not a CalibrationTable; messages begin "path:line:".
Result<CalibrationTable> ReadCalibrationTable(const std::filesystem::path& path);

/// The same from text in memory; `name` stands for the path. Not kNotFound.
Result<CalibrationTable> ParseCalibrationTable(std::string_view text, const std::string& name);

}  // namespace pendulum
