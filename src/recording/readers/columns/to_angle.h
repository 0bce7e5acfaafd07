// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/warning.h"
#include "pendulum/recording/arc.h"
#include "pendulum/recording/oversampling.h"
#include "pendulum/recording/recording.h"
#include "pendulum/recording/resolution.h"
#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/metadata.h"

/// Converts the numbers of a file's value column to the contents of a Recording.
namespace pendulum::csv {

/// The calibration for a column of counts or volts, if any: the user's, otherwise the file's own.
inline const std::optional<Calibration>& ChosenCalibration(const ReadOptions& options, const Metadata& metadata) {
  return options.calibration ? options.calibration : metadata.calibration;
}

/// Checks that a calibration has the column's unit. The file's own calibration may belong to another column, so it only
/// causes a warning if the column is not in counts or volts.
inline Result<void> CheckCalibration(const Line& header, const Column& column, const ReadOptions& options,
                                     const Metadata& metadata, std::vector<Warning>& warnings) {
  const std::optional<Calibration>& calibration = ChosenCalibration(options, metadata);
  if (!calibration || calibration->input == column.unit->name) return {};
  const bool is_raw = column.unit->kind == Kind::kRaw;
  const std::string unit(column.unit->name);
  if (!is_raw && !options.calibration) {
    warnings.push_back({.code = "metadata_not_applied",
                        .finding = "the metadata calibration is not applied to column " + column.name +
                                   ", which is in " + unit + " already",
                        .assumed = "the file's calibration does not apply, as readings are in " + unit,
                        .about = {.file = std::string(header.file), .line = metadata.calibration_line}});
    return {};
  }
  return header.Fault(header.text.data(),
                      "column " + column.name + " is in " + unit + ", but the calibration is for " +
                          calibration->input +
                          (is_raw ? "; give the calibration of this sensor" : "; leave --calibration out"));
}

inline bool AllWhole(const Eigen::VectorXd& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == std::floor(value); });
}

/// Warns if the values contradict the given resolution, which is still used.
inline void WarnOfResolution(double found, Recording& recording) {
  constexpr double kAlike = 0.1;
  if (found == 0 || std::abs(recording.resolution - found) <= kAlike * found) return;
  const std::string who = recording.resolution_source == "given" ? "as given" : "as the file says";
  recording.warnings.push_back({.code = "resolution_disagrees",
                                .finding = "the resolution " + NumberText(recording.resolution, 4) + ", " + who +
                                           ", is used, but the values are " + NumberText(found, 4) +
                                           " apart (in the file's unit)",
                                .explanation = "a wrong resolution makes the error bars wrong",
                                .advice = "correct the resolution"});
}

/// Sets the resolution and its source: the user, the file, or the values themselves. Whole counts have a resolution of
/// at least 1. spacing: FindResolution of the values.
inline void SetResolution(const Unit& unit, const ReadOptions& options, const Metadata& metadata, double spacing,
                          Recording& recording) {
  if (options.resolution || metadata.resolution) {
    recording.resolution = options.resolution ? *options.resolution : *metadata.resolution;
    recording.resolution_source = options.resolution ? "given" : "file";
    WarnOfResolution(spacing, recording);
    return;
  }
  recording.resolution = spacing;
  if (recording.resolution == 0 && unit.name == "counts" && AllWhole(recording.value)) recording.resolution = 1;
  recording.resolution_source = "found";
}

/// The range of a converter if counts reach one of its ends repeatedly.
inline std::optional<SensorRange> ConverterRange(const Eigen::VectorXd& counts) {
  constexpr std::array kFullScales = {1023.0, 4095.0, 16383.0, 65535.0};
  constexpr Eigen::Index kOften = 2;
  const double largest = counts.maxCoeff();
  const auto* const full = std::ranges::find_if(kFullScales, [&](double scale) { return largest <= scale; });
  if (full == kFullScales.end() || counts.minCoeff() < 0 || !AllWhole(counts)) return std::nullopt;
  const bool reached = (counts.array() == 0).count() >= kOften || (counts.array() == *full).count() >= kOften;
  return reached ? std::optional(SensorRange{0, *full}) : std::nullopt;
}

inline void SetRange(const Unit& unit, const ReadOptions& options, const Metadata& metadata, Recording& recording) {
  if (options.range) {
    recording.range = options.range;
  } else if (metadata.range) {
    recording.range = SensorRange{metadata.range->low, metadata.range->high};
  } else if (unit.name == "counts") {
    recording.range = ConverterRange(recording.value);
  }
  if (!recording.range) return;
  const auto [low, high] = *recording.range;
  const double slack = recording.resolution + 1e-6 * (high - low);
  const auto outside = (recording.value.array() < low - slack || recording.value.array() > high + slack).count();
  if (outside == 0) return;
  recording.warnings.push_back({.code = "range_disagrees",
                                .finding = std::to_string(outside) + " readings are outside the range " +
                                           NumberText(low, 4) + " to " + NumberText(high, 4) +
                                           " (in the file's unit), so the range is ignored"});
  recording.range.reset();
}

/// Says that a flag and a line of the file disagree about the averaging; the flag is used.
inline void WarnOfAveraging(const std::string& flag, const std::string& given, const std::string& line,
                            Recording& recording) {
  recording.warnings.push_back({.code = "averaging_disagrees",
                                .finding = "--" + flag + " is " + given + ", but the file says " + line,
                                .explanation = "the flag is used",
                                .advice = "correct whichever is wrong",
                                .flags = {flag}});
}

inline std::string WindowText(const AveragingWindow& window) {
  return NumberText(window.from) + "," + NumberText(window.to) + " s";
}

/// Notices rows that look like means although nobody says so. They are taken for means if the count of a single reading
/// is known; otherwise single readings may look the same, as an encoder's angles with too few digits do. spacing:
/// FindResolution of the values.
inline void NoticeMeans(const Unit& unit, double spacing, Recording& recording) {
  constexpr double kAlike = 0.1;
  const bool has_counts = unit.name == "counts", is_found = recording.resolution_source == "found";
  const int readings = ReadingsPerMean(recording.value, spacing);
  if (readings == 1) return;
  const std::string n = std::to_string(readings);
  const std::string finding = "of the values that are possible one in " + n +
                              " occurs much more often than the others, as in means of " + n +
                              " readings that were rounded one by one";
  if (is_found && !has_counts) {
    recording.warnings.push_back({.code = "means_possible",
                                  .finding = finding,
                                  .explanation = "each row is taken for one reading",
                                  .advice = "if rows are means, give --oversample " + n + " (or a multiple of it)",
                                  .flags = {"oversample"}});
    return;
  }
  const double count = has_counts ? 1 : recording.resolution;
  if (std::abs(count / spacing - readings) > kAlike) return;
  recording.oversampling.readings = readings;
  recording.warnings.push_back(
      {.code = "means_assumed",
       .finding = finding,
       .explanation = "each row is taken for such a mean",
       .advice = "say it in the file (# oversample: " + n + "), or give --oversample 1 if each row is one reading",
       .flags = {"oversample"},
       .assumed = "rows that are means of " + n + " readings (--oversample)"});
}

/// Sets how rows are means of readings. The resolution is then that of the means, whether the file gives theirs or that
/// of one reading. spacing: FindResolution of the values.
inline void SetOversampling(const Unit& unit, const ReadOptions& options, const Metadata& metadata, double spacing,
                            Recording& recording) {
  Oversampling& oversampling = recording.oversampling;
  const auto by_file = static_cast<int>(metadata.oversample);
  oversampling.readings = options.oversample > 0 ? options.oversample : std::max(by_file, 1);
  oversampling.window = options.averaging_window ? options.averaging_window : metadata.window;
  if (options.oversample > 0 && by_file > 0 && options.oversample != by_file) {
    WarnOfAveraging("oversample", std::to_string(options.oversample), "# oversample: " + std::to_string(by_file),
                    recording);
  }
  if (options.averaging_window && metadata.window) {
    const auto [from, to] = *options.averaging_window;
    if (from != metadata.window->from || to != metadata.window->to) {
      WarnOfAveraging("window_s", WindowText({from, to}), "# window_s: " + WindowText(*metadata.window), recording);
    }
  }
  if (options.oversample == 0 && by_file == 0) NoticeMeans(unit, spacing, recording);
  FindCountLevels(unit.name == "counts", recording);
  if (oversampling.count > 0)
    std::erase_if(recording.warnings, [](const Warning& warning) { return warning.code == "resolution_disagrees"; });
}

/// Converts values to SI by their unit. Counts and volts stay as they are.
inline void ScaleValues(const Unit& unit, Recording& recording) {
  if (unit.ToSi(1) == 1) return;
  for (double& value : recording.value) value = unit.ToSi(value);
  recording.resolution = unit.ToSi(recording.resolution);
  recording.oversampling.count = unit.ToSi(recording.oversampling.count);
  recording.oversampling.level = unit.ToSi(recording.oversampling.level);
  if (recording.range) recording.range = SensorRange{unit.ToSi(recording.range->low), unit.ToSi(recording.range->high)};
}

/// Converts counts or volts with their calibration. The resolution uses the slope in the middle of the readings.
inline void Calibrate(const Calibration& calibration, Recording& recording) {
  const auto [low, high] = std::minmax_element(recording.value.begin(), recording.value.end());
  const double slope = calibration.Slope(*low / 2 + *high / 2);
  recording.resolution *= std::abs(slope);
  Oversampling& oversampling = recording.oversampling;
  const bool is_straight = calibration.coefficients.size() == 2;
  oversampling.count *= is_straight ? std::abs(slope) : 0;  // on a curve counts are not evenly spaced
  oversampling.level = calibration.Angle(oversampling.level);
  const std::optional<SensorRange> ends = recording.range ? recording.range : calibration.input_range;
  recording.range.reset();
  if (ends) {
    const auto [first, last] = std::minmax({calibration.Angle(ends->low), calibration.Angle(ends->high)});
    if (first < last) recording.range = SensorRange{first, last};
  }
  for (double& value : recording.value) value = calibration.Angle(value);
  recording.calibration = calibration;
}

/// The quantity that a column with this name measures: a gyro's volts are a rate.
inline Quantity QuantityOf(const Column& column) {
  switch (column.unit->kind) {
    case Kind::kRate: return Quantity::kRate;
    case Kind::kAcceleration: return Quantity::kAcceleration;
    case Kind::kLength: return Quantity::kPosition;
    case Kind::kRaw: return column.is_gyro ? Quantity::kRate : Quantity::kAngle;
    default: return Quantity::kAngle;
  }
}

/// Converts both coordinates of a point to the angle about the centre of its circle.
inline Result<void> TurnIntoAngles(const Column& vertical, const Eigen::VectorXd& y, Recording& recording) {
  const Unit& unit = *vertical.unit;
  const Eigen::VectorXd height = y.unaryExpr([&](double number) { return unit.ToSi(number); });
  Result<Arc> arc = FitArc(recording.value, height);
  if (!arc) return Within(recording.path, arc.error());
  for (Eigen::Index i = 0; i < height.size(); ++i) recording.value[i] = arc->Angle(recording.value[i], height[i]);
  recording.quantity = Quantity::kAngle;
  recording.resolution = 0;  // levels of coordinates are not levels of the angle
  recording.resolution_source.clear();
  recording.oversampling.count = 0;
  recording.range.reset();
  recording.arc = *std::move(arc);
  return {};
}

/// Sets value, unit, quantity, resolution, range and calibration from the numbers in `value`.
inline void SetValues(const Layout& layout, const ReadOptions& options, const Metadata& metadata,
                      Recording& recording) {
  const Column& column = layout.value;
  const Unit& unit = *column.unit;
  recording.quantity = QuantityOf(column);
  recording.shows_gravity = !column.is_without_gravity;
  recording.unit = unit.name;
  const double spacing = FindResolution(recording.value);
  SetResolution(unit, options, metadata, spacing, recording);
  SetOversampling(unit, options, metadata, spacing, recording);
  SetRange(unit, options, metadata, recording);
  ScaleValues(unit, recording);
  const std::optional<Calibration>& calibration = ChosenCalibration(options, metadata);
  if (unit.kind == Kind::kRaw && calibration) Calibrate(*calibration, recording);
}

}  // namespace pendulum::csv
