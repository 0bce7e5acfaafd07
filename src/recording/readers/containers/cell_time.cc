// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/cell_time.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <system_error>

namespace pendulum {
namespace {

constexpr std::int64_t kUsPerSecond = 1'000'000;  // us
constexpr std::int64_t kUsPerDay = 86'400 * kUsPerSecond;

std::string Padded(std::int64_t number, std::size_t digits) {
  std::string text = std::to_string(number);
  return text.size() < digits ? std::string(digits - text.size(), '0') + text : text;
}

/// The time since midnight, or a duration, as hours, minutes and seconds. `part` is the fraction of a second in units
/// of 10^-digits.
std::string ClockText(std::int64_t seconds, std::int64_t part, std::size_t digits) {
  const std::string text = Padded(seconds / 3600, 2) + ':' + Padded(seconds / 60 % 60, 2) + ':' +
                           Padded(seconds % 60, 2) + '.' + Padded(part, digits);
  return std::string(WithoutEndZeros(text));
}

std::string ClockText(std::int64_t us) { return ClockText(us / kUsPerSecond, us % kUsPerSecond, 6); }

/// A date has more than 16 digits in this unit, so the last ones are noise.
std::int64_t Microseconds(double days) {
  constexpr double kNoise = 2;  // us
  const double us = days * static_cast<double>(kUsPerDay);
  const double ms = std::round(us / 1000) * 1000;
  return std::llround(std::abs(us - ms) <= kNoise ? ms : us);
}

/// The end of a part of a format that is text: "...", [...], an escaped or repeated character.
std::size_t SkipText(std::string_view format, std::size_t at) {
  const auto after = [&](char closing) { return std::min(format.find(closing, at + 1), format.size()); };
  switch (format[at]) {
    case '"': return after('"');
    case '[': return after(']');
    case '\\':
    case '_':
    case '*': return at + 1;
    default: return at;
  }
}

/// True for [h], [mm] and [ss], but not for [Red] or [$-409].
bool IsDuration(std::string_view bracket) {
  const std::size_t end = bracket.find(']');
  return end != std::string_view::npos && end > 1 && bracket.find_first_not_of("hmsHMS", 1) == end;
}

}  // namespace

bool IsTimeFormat(std::string_view format) {
  const auto is_unit = [](char c) { return std::string_view("ydhsmYDHSM").find(c) != std::string_view::npos; };
  if (format == "General" || format == "GENERAL") return false;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] == '[' && IsDuration(format.substr(i))) return true;
    const std::size_t end = SkipText(format, i);
    if (end != i) {
      i = end;
    } else if (is_unit(format[i])) {
      return true;
    }
  }
  return false;
}

/// ECMA-376 part 1, 18.8.30: 14 to 22 and 45 to 47; 27 to 36 and 50 to 58 in East Asia.
bool IsTimeFormat(int built_in_format) {
  const auto is_within = [&](int first, int last) { return built_in_format >= first && built_in_format <= last; };
  return is_within(14, 22) || is_within(27, 36) || is_within(45, 47) || is_within(50, 58);
}

std::string_view WithoutEndZeros(std::string_view text) {
  if (text.find('.') == std::string_view::npos) return text;
  while (text.ends_with('0')) text.remove_suffix(1);
  if (text.ends_with('.')) text.remove_suffix(1);
  return text;
}

std::string DateText(std::int64_t seconds, std::int64_t part, std::size_t digits) {
  const std::chrono::sys_seconds moment{std::chrono::seconds(seconds)};
  const auto day = std::chrono::floor<std::chrono::days>(moment);
  const std::chrono::year_month_day date(day);
  const std::string text = Padded(static_cast<int>(date.year()), 4) + '-' +
                           Padded(static_cast<unsigned>(date.month()), 2) + '-' +
                           Padded(static_cast<unsigned>(date.day()), 2);
  return text + 'T' + ClockText((moment - day).count(), part, digits);
}

std::string TimeText(double days, bool is_1904) {
  using std::chrono::sys_days, std::chrono::year;
  constexpr double kFirstDate = 60;      // Below it is a duration. Excel has a day 60 that never existed.
  constexpr double kLastDate = 2958466;  // 31 December 9999
  if (!(days >= 0) || days >= kLastDate) return "";
  const std::int64_t us = Microseconds(days);
  if (days < kFirstDate) return ClockText(us);
  constexpr sys_days kOrigin = year(1899) / 12 / 30;
  constexpr sys_days kOrigin1904 = year(1904) / 1 / 1;
  const std::chrono::sys_seconds origin = is_1904 ? kOrigin1904 : kOrigin;
  return DateText(origin.time_since_epoch().count() + us / kUsPerSecond, us % kUsPerSecond, 6);
}

std::string DurationText(std::string_view duration) {
  double seconds = 0;
  const bool is_negative = duration.starts_with('-');
  duration.remove_prefix(is_negative ? 1 : 0);
  if (!duration.starts_with("PT")) return "";
  duration.remove_prefix(2);
  while (!duration.empty()) {
    double number = 0;
    const auto [end, error] = std::from_chars(duration.data(), duration.data() + duration.size(), number);
    if (error != std::errc() || end == duration.data() + duration.size()) return "";
    if (*end != 'H' && *end != 'M' && *end != 'S') return "";
    seconds += number * (*end == 'H' ? 3600 : *end == 'M' ? 60 : 1);
    duration.remove_prefix(end + 1 - duration.data());
  }
  if (!(seconds >= 0 && seconds < 1e9)) return "";
  return (is_negative ? "-" : "") + ClockText(std::llround(seconds * static_cast<double>(kUsPerSecond)));
}

}  // namespace pendulum
