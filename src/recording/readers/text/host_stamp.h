// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "recording/readers/columns/csv.h"

/// The time stamp that a serial monitor puts before each line: "14:03:22.123 -> ".
namespace pendulum::csv {

struct HostStamp {
  std::optional<double> second_of_day;  // std::nullopt if only the end of a stamp remains.
  std::string_view rest;                // The text from the device.
};

/// The stamp at the beginning of a line, or what remains of a cut-off stamp; std::nullopt if there is neither.
inline std::optional<HostStamp> FindHostStamp(std::string_view line) {
  constexpr std::string_view kArrow = "->";
  const std::size_t arrow = line.find(kArrow);
  if (arrow == std::string_view::npos) return std::nullopt;
  const std::string_view stamp = Trim(line.substr(0, arrow));
  if (stamp.find_first_not_of("0123456789:.") != std::string_view::npos) return std::nullopt;
  HostStamp found{std::nullopt, line.substr(arrow + kArrow.size())};
  const std::size_t hour_end = stamp.find(':');
  const std::size_t minute_end = stamp.find(':', hour_end + 1);
  if (hour_end == std::string_view::npos || minute_end == std::string_view::npos) return found;
  std::array<double, 3> parts{};
  const std::array<std::string_view, 3> texts = {
      stamp.substr(0, hour_end), stamp.substr(hour_end + 1, minute_end - hour_end - 1), stamp.substr(minute_end + 1)};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!ParseNumber(texts.at(i), parts.at(i))) return found;
  }
  if (parts[0] < 24 && parts[1] < 60 && parts[2] < 61) {
    // Rounded to microseconds, so that the result is the double nearest to the time as written.
    constexpr double kFine = 1e6;
    found.second_of_day = std::round(((parts[0] * 60 + parts[1]) * 60 + parts[2]) * kFine) / kFine;
  }
  return found;
}

}  // namespace pendulum::csv
