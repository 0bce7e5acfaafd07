// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

#include "csv.h"

/// The keys of `# key: value` lines, and what their values must look like.
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

inline bool IsObject(std::string_view text) { return text.starts_with('{') && text.ends_with('}'); }

struct MetadataKey {
  std::string_view key;
  bool (*is_well_formed)(std::string_view);
  std::string_view rule;
  bool changes_numbers;  // Not applied by this reader, so the user must know.
};

constexpr std::array kMetadataKeys = {
    MetadataKey{"resolution", IsZeroOrMore, "a number, 0 or more, in the unit of the file", false},
    MetadataKey{"range", IsRange, "two increasing numbers: low,high", false},
    MetadataKey{"sample_rate_hz", IsPositive, "a positive number", false},
    MetadataKey{"clock_scale", IsPositive, "a positive number", true},
    MetadataKey{"clock_scale_std_dev", IsZeroOrMore, "a number, 0 or more", true},
    MetadataKey{"lost_samples", IsCount, "a whole number, 0 or more", false},
    MetadataKey{"calibration", IsObject, "a JSON object on the same line", true},
    MetadataKey{"rig", IsObject, "a JSON object on the same line", true},
};

}  // namespace pendulum::csv
