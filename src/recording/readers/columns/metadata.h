// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/recording/oversampling.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/recording/sensor_errors.h"
#include "pendulum/recording/sensor_statement.h"
#include "recording/readers/columns/csv.h"

/// The keys of `# key: value` lines and the form of their values.
namespace pendulum::csv {

inline bool IsPositive(std::string_view text) {
  double number = 0;
  return ParseNumber(text, number) && number > 0;
}

inline bool IsZeroOrMore(std::string_view text) {
  double number = 0;
  return ParseNumber(text, number) && number >= 0;
}

inline bool IsCount(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The ends of the values a sensor can give, in the unit of the file.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

inline bool ParseRange(std::string_view text, Range& range) {
  const std::size_t comma = std::min(text.find(','), text.size());
  return ParseNumber(Trim(text.substr(0, comma)), range.low) &&
         ParseNumber(Trim(text.substr(std::min(comma + 1, text.size()))), range.high) && range.low < range.high;
}

inline bool IsRange(std::string_view text) {
  Range range;
  return ParseRange(text, range);
}

inline bool IsOversample(std::string_view text) {
  double number = 0;
  return IsCount(text) && ParseNumber(text, number) && number >= 1 && number <= kMostOversampling;
}

inline bool IsWindow(std::string_view text) { return ParseAveragingWindow(text).has_value(); }

inline bool IsObject(std::string_view text) { return text.starts_with('{') && text.ends_with('}'); }

/// Whether a value of `# sensor` is a statement: a kind or an object. Any other text is a comment, such as the name of
/// a chip.
inline bool IsSensor(std::string_view text) { return IsSensorKind(text) || text.starts_with('{'); }

struct MetadataKey {
  std::string_view key;
  bool (*is_well_formed)(std::string_view);
  std::string_view rule;
};

constexpr std::array kMetadataKeys = {
    MetadataKey{"resolution", IsZeroOrMore, "a number, 0 or more, in the unit of the file"},
    MetadataKey{"range", IsRange, "two increasing numbers: low,high"},
    MetadataKey{"sample_rate_hz", IsPositive, "a positive number"},
    MetadataKey{"clock_scale", IsPositive, "a positive number"},
    MetadataKey{"clock_scale_std_dev", IsZeroOrMore, "a number, 0 or more"},
    MetadataKey{"lost_samples", IsCount, "a whole number, 0 or more"},
    MetadataKey{"oversample", IsOversample, "a whole number, 1 to 64"},
    MetadataKey{"window_s", IsWindow, kAveragingWindowRule},
    MetadataKey{"calibration", IsObject, "a JSON object on the same line"},
    MetadataKey{"rig", IsObject, "a JSON object on the same line"},
    MetadataKey{"sensor", IsSensor, "a kind of sensor, or a JSON object on the same line"},
};

/// The values of the `# key: value` lines of one file.
struct Metadata {
  std::optional<double> resolution;  // In the unit of the file, like the range.
  std::optional<Range> range;
  double sample_rate_hz = 0;  // 0: not given.
  double clock_scale = 1;
  double clock_scale_std_dev = 0;
  std::string lost_samples;
  double oversample = 0;  // 0: not given.
  std::optional<AveragingWindow> window;
  std::optional<Calibration> calibration;
  std::size_t calibration_line = 0;
  std::string rig_json;
  std::optional<SensorStatement> sensor;
  std::string unknown_sensor;  // The text of a line `# sensor` that is no statement.
  std::array<bool, kMetadataKeys.size()> seen{};

  /// Whether the file has a line with this key of kMetadataKeys.
  bool Has(std::string_view key) const {
    return seen.at(std::ranges::find(kMetadataKeys, key, &MetadataKey::key) - kMetadataKeys.begin());
  }
};

/// Stores a value that has been checked.
inline Result<void> StoreMetadata(const Line& line, std::string_view key, std::string_view value, Metadata& metadata) {
  if (key == "resolution") ParseNumber(value, metadata.resolution.emplace());
  if (key == "range") ParseRange(value, metadata.range.emplace());
  if (key == "sample_rate_hz") ParseNumber(value, metadata.sample_rate_hz);
  if (key == "clock_scale") ParseNumber(value, metadata.clock_scale);
  if (key == "clock_scale_std_dev") ParseNumber(value, metadata.clock_scale_std_dev);
  if (key == "lost_samples") metadata.lost_samples = value;
  if (key == "oversample") ParseNumber(value, metadata.oversample);
  if (key == "window_s") metadata.window = ParseAveragingWindow(value);
  if (key == "rig") metadata.rig_json = value;
  if (key != "calibration" && key != "sensor") return {};
  const std::string name = std::string(line.file) + ":" + std::to_string(line.number) + ": # " + std::string(key);
  if (key == "sensor") {
    ASSIGN_OR_RETURN(SensorStatement sensor, ParseSensorStatement(value, name, "stated in the file"));
    metadata.sensor = std::move(sensor);
    return {};
  }
  ASSIGN_OR_RETURN(Calibration calibration, ParseCalibration(value, name));
  metadata.calibration = std::move(calibration);
  metadata.calibration_line = line.number;
  return {};
}

/// Reads the text after the `#` of a line; in most cases it is a comment.
inline Result<void> ReadMetadata(const Line& line, std::string_view comment, Metadata& metadata) {
  const std::size_t colon = std::min(comment.find(':'), comment.size());
  const auto* const entry = std::ranges::find(kMetadataKeys, Trim(comment.substr(0, colon)), &MetadataKey::key);
  if (entry == kMetadataKeys.end() || colon == comment.size()) return {};
  const std::string_view value = Trim(comment.substr(colon + 1));
  const std::string key(entry->key);
  if (key == "sensor" && !IsSensor(value)) {
    metadata.unknown_sensor = value;
    return {};
  }
  if (!entry->is_well_formed(value)) {
    return line.Fault(value.data(), "the metadata " + key + " is " + Quoted(value) + "; it must be " +
                                        std::string(entry->rule) + ": correct or delete this line");
  }
  bool& seen = metadata.seen.at(entry - kMetadataKeys.begin());
  if (seen) return line.Fault(comment.data(), "the metadata " + key + " is given twice; keep one of them");
  seen = true;
  return StoreMetadata(line, entry->key, value, metadata);
}

}  // namespace pendulum::csv
