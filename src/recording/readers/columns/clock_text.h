// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "recording/readers/columns/csv.h"

/// Times of day in a text.
namespace pendulum::csv {

/// The parts of a time of day, separated by colons: hours, minutes, seconds with a fraction. A fourth part is a
/// fraction too: 16:04:31:273. Two parts are minutes and seconds if the second has a fraction.
inline std::optional<double> SecondsOfParts(std::string_view text) {
  std::array<double, 4> parts{};
  std::size_t count = 0;
  for (std::size_t begin = 0; begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    std::string part(text.substr(begin, end - begin));
    std::ranges::replace(part, ',', '.');
    if (count == parts.size() || part.empty() || part.find_first_not_of("0123456789.") != std::string::npos) return {};
    if (count == 3) part.insert(0, "0.");
    if (!ParseNumber(part, parts.at(count))) return {};
    begin = end + 1;
  }
  const bool has_fraction = text.find_first_of(".,") != std::string_view::npos;
  if (count == 2 && has_fraction && parts[1] < 60) return parts[0] * 60 + parts[1];
  if (count < 3 || parts[1] >= 60 || parts[2] >= 61) return {};
  return (parts[0] * 60 + parts[1]) * 60 + parts[2] + parts[3];
}

/// The seconds since midnight of a time of day, alone or after a date: 16:04:31.273, 2024-03-01T16:04:31Z,
/// 01.03.2024 4:04:31,273 PM. A time zone is ignored; std::nullopt for other text.
inline std::optional<double> SecondOfDay(std::string_view text) {
  text = Trim(text);
  if (text.find(':') == std::string_view::npos) return std::nullopt;
  double half_day = -1;  // Hours to add: 0 for AM, 12 for PM.
  for (const auto& [word, hours] : {std::pair{"AM", 0.0}, {"am", 0.0}, {"PM", 12.0}, {"pm", 12.0}}) {
    if (!text.ends_with(word)) continue;
    half_day = hours;
    text = Trim(text.substr(0, text.size() - 2));
  }
  const std::size_t first_colon = text.find(':');
  const std::size_t before = text.find_last_of(" T\t", first_colon);
  if (before != std::string_view::npos) {
    const std::string_view date = text.substr(0, before);
    if (date.find_first_not_of("0123456789-/. ") != std::string_view::npos) return std::nullopt;
    text = text.substr(before + 1);
  }
  const std::size_t zone = text.find_first_of("Z+-");
  text = Trim(text.substr(0, zone));
  std::optional<double> seconds = SecondsOfParts(text);
  if (!seconds) return std::nullopt;
  constexpr double kHour = 3600, kHalfDay = 12;
  if (half_day >= 0) *seconds = std::fmod(*seconds, kHalfDay * kHour) + half_day * kHour;
  // Rounded to microseconds, so that the result is the double nearest to the time as written.
  constexpr double kFine = 1e6;
  return std::round(*seconds * kFine) / kFine;
}

/// Continues times of day over midnight.
class DayClock {
 public:
  /// Seconds since the midnight before the first time.
  double Continue(double second_of_day) {
    constexpr double kDay = 86400;
    double time = second_of_day + midnights_;
    if (has_begun_ && time < last_ - kDay / 2) {
      midnights_ += kDay;
      time += kDay;
    }
    has_begun_ = true;
    last_ = time;
    return time;
  }

 private:
  bool has_begun_ = false;
  double midnights_ = 0;  // s
  double last_ = 0;       // s
};

}  // namespace pendulum::csv
