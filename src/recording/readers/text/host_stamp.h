// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "recording/readers/columns/clock_text.h"
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
  constexpr double kDay = 86400;
  const std::size_t arrow = line.find(kArrow);
  if (arrow == std::string_view::npos) return std::nullopt;
  const std::string_view stamp = Trim(line.substr(0, arrow));
  if (stamp.find_first_not_of("0123456789:.") != std::string_view::npos) return std::nullopt;
  HostStamp found{std::nullopt, line.substr(arrow + kArrow.size())};
  const bool has_hours = std::ranges::count(stamp, ':') == 2;
  if (has_hours) found.second_of_day = SecondOfDay(stamp);
  if (found.second_of_day && *found.second_of_day > kDay) found.second_of_day.reset();
  return found;
}

}  // namespace pendulum::csv
