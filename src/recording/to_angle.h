// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "layout.h"
#include "metadata.h"
#include "pendulum/base/format.h"
#include "pendulum/recording/recording.h"

/// From the numbers of a file's value column to what a Recording holds.
namespace pendulum::csv {

/// The calibration that applies to a column of counts or volts, if any: the user's before the file's own.
inline const std::optional<Calibration>& ChosenCalibration(const ReadOptions& options, const Metadata& metadata) {
  return options.calibration ? options.calibration : metadata.calibration;
}

/// A calibration must be of the column's unit; the file's own may be about another column than that of angles.
inline Result<void> CheckCalibration(const Line& header, const Column& column, const ReadOptions& options,
                                     const Metadata& metadata, std::vector<Warning>& warnings) {
  const std::optional<Calibration>& calibration = ChosenCalibration(options, metadata);
  if (!calibration || calibration->input == column.unit->name) return {};
  const bool is_raw = column.unit->kind == Kind::kRaw;
  const std::string unit(column.unit->name);
  if (!is_raw && !options.calibration) {
    warnings.push_back({"metadata_not_applied", std::string(header.file) + ":" +
                                                    std::to_string(metadata.calibration_line) +
                                                    ": the metadata calibration is not applied to column " +
                                                    column.name + ", which is in " + unit + " already"});
    return {};
  }
  return header.Fault(header.text.data(), "column " + column.name + " is in " + unit +
                                              ", and the calibration is one of " + calibration->input +
                                              (is_raw ? "; give that of this sensor" : "; leave --calibration out"));
}

inline bool AllWhole(const Eigen::VectorXd& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == std::floor(value); });
}

/// Values that a unit alone turns into SI, or counts and volts as they are.
inline void ScaleValues(const Unit& unit, const Metadata& metadata, Recording& recording) {
  if (unit.ToSi(1) != 1) {
    for (double& value : recording.value) value = unit.ToSi(value);
  }
  recording.resolution = unit.ToSi(metadata.resolution.value_or(0));
  if (metadata.range) {
    recording.range = SensorRange{unit.ToSi(metadata.range->low), unit.ToSi(metadata.range->high)};
  }
}

/// Counts or volts through their calibration. The spacing of readings is that at the middle of the data.
inline void Calibrate(const Calibration& calibration, const Metadata& metadata, Recording& recording) {
  const auto [low, high] = std::minmax_element(recording.value.begin(), recording.value.end());
  const double slope = calibration.Slope(*low / 2 + *high / 2);
  recording.resolution *= std::abs(slope);
  std::optional<SensorRange> ends = calibration.input_range;
  if (metadata.range) ends = SensorRange{metadata.range->low, metadata.range->high};
  recording.range.reset();
  if (ends) {
    const auto [first, last] = std::minmax({calibration.Angle(ends->low), calibration.Angle(ends->high)});
    if (first < last) recording.range = SensorRange{first, last};
  }
  for (double& value : recording.value) value = calibration.Angle(value);
  recording.calibration = calibration;
}

/// Fills value, unit, quantity, resolution, range and calibration from the numbers that `value` holds.
inline void SetValues(const Column& column, const ReadOptions& options, const Metadata& metadata,
                      Recording& recording) {
  const Unit& unit = *column.unit;
  recording.quantity = unit.kind == Kind::kRate ? Quantity::kRate : Quantity::kAngle;
  recording.unit = unit.name;
  const bool is_whole = unit.name == "counts" && AllWhole(recording.value);
  ScaleValues(unit, metadata, recording);
  if (is_whole && !metadata.resolution) recording.resolution = 1;
  const std::optional<Calibration>& calibration = ChosenCalibration(options, metadata);
  if (unit.kind == Kind::kRaw && calibration) Calibrate(*calibration, metadata, recording);
}

}  // namespace pendulum::csv
