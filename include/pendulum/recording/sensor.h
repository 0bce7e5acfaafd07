// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"

namespace pendulum {

/// The interval a sensor can show, in the unit of its reading. Values beyond it appear as the nearest end.
struct SensorRange {
  double low;
  double high;
};

/// Converts a sensor's reading to an angle: the sum of coefficients[k] inputᵏ.
struct Calibration {
  std::string input, angle_unit;           ///< Units: counts or volts of the reading, deg or rad of the sum.
  std::vector<double> coefficients;        ///< K >= 2, lowest order first, angle_unit per inputᵏ.
  Eigen::MatrixXd covariance;              ///< K x K, of the coefficients; 0 x 0 if not given.
  std::optional<double> residual_std_dev;  ///< Of the calibration's points about the curve, angle_unit.
  std::optional<SensorRange> input_range;  ///< The sensor's range, in the unit of the reading.
  nlohmann::ordered_json source;           ///< The calibration as read, for the report.
  std::string note;   ///< How it was made, a sentence for the report, if it was made from a table on the way.
  std::string doubt;  ///< Why that may be wrong, a sentence; often empty.

  /// The angle of a reading [rad], and its derivative there [rad per unit of the reading].
  double Angle(double reading) const;

  double Slope(double reading) const;

  /// The reading for an angle [rad]. If a curve has several, one near the reading `near`.
  double Reading(double angle, double near) const;

  /// rad in one angle_unit.
  double RadFromUnit() const;
};

/// Reads a calibration from JSON text: {"input": "counts"|"volts", "angle_unit": "deg"|"rad", "coefficients": [c0, c1,
/// ...]} with optional "schema_version": 1, "covariance": [[...]], "residual_std_dev" and "input_range": [low, high].
/// Optional values may be null. kDataLoss: not JSON (line and column), longer than 64 KiB, an unknown, missing or
/// repeated key, a value of another type, another schema_version, a curve without slope, or a covariance that is not
/// symmetric and K x K. The message begins with `name` and names the key.
Result<Calibration> ParseCalibration(std::string_view text, const std::string& name);

/// The same from a file. kNotFound: no such file. kDataLoss: as above, or it is a directory or cannot be read.
Result<Calibration> ReadCalibration(const std::filesystem::path& path);

}  // namespace pendulum
