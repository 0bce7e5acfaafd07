// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/ros.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "recording/readers/columns/joint_table.h"

namespace pendulum::csv {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns
constexpr std::size_t kLongestSeconds = 15;      // Digits: longer numbers are nanoseconds.

/// The parts of a name between slashes and dots, in lower case.
struct Path {
  std::string before;  // All except the last part.
  std::string last;    // Without the index: `position` for `position[0]`, `position_0` and `position0`.
  std::string index;
};

Path PathOf(std::string_view name) {
  const std::string plain = PlainName(Trim(name));
  const std::size_t cut = plain.find_last_of("/.");
  Path path{cut == std::string::npos ? "" : plain.substr(0, cut), plain.substr(cut + 1), ""};
  const std::size_t end = path.last.find_last_not_of("0123456789[]_");
  if (end != std::string::npos && path.last.find_first_of("0123456789", end) != std::string::npos) {
    path.index = path.last.substr(end + 1);
    path.last.resize(end + 1);
  }
  return path;
}

bool IsOneOf(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// The first column whose last part is one of the words; kNoColumn if there is none.
std::size_t FindByLastPart(const std::vector<TableColumn>& columns, std::initializer_list<std::string_view> words) {
  const auto found = std::ranges::find_if(
      columns, [&](const TableColumn& column) { return IsOneOf(PathOf(column.written).last, words); });
  return found == columns.end() ? kNoColumn : found - columns.begin();
}

/// Text of the field with that index; empty if there is none.
std::string_view FieldOf(std::string_view row, char separator, std::size_t index) {
  FieldCutter fields(row, separator);
  for (std::size_t i = 0; !fields.done(); ++i) {
    const std::string_view field = fields.Next();
    if (i == index) return Unquote(field);
  }
  return {};
}

/// Whether the unit of a stamp is certain. Whole numbers with fewer digits than nanoseconds since 1970 may have any
/// unit, which the user must give.
bool HasKnownUnit(std::string_view stamp) {
  return stamp.find('.') != std::string_view::npos || stamp.size() > kLongestSeconds;
}

/// Finds the columns of stamps. The stamp in a message's header is preferred to the time of its arrival.
void FindStamps(const std::vector<TableColumn>& columns, std::string_view row, char separator, RosTable& table) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Path path = PathOf(columns[i].written);
    if (!IsOneOf(path.last, {"sec", "secs"})) continue;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const Path other = PathOf(columns[j].written);
      if (other.before != path.before || !IsOneOf(other.last, {"nanosec", "nanosecs", "nsec", "nsecs"})) continue;
      table.seconds = i;
      table.nanoseconds = j;
      return;
    }
  }
  for (const std::string_view word : {"stamp", "%time", "__time"}) {
    const std::size_t found = FindByLastPart(columns, {word});
    const std::string_view first = found == kNoColumn ? "" : FieldOf(row, separator, found);
    if (found == kNoColumn || (word == "stamp" && !first.empty() && !HasKnownUnit(first))) continue;
    table.seconds = found;
    table.is_nanoseconds = word == "%time";
    return;
  }
}

/// The name of a message field with its unit added; the name itself if the unit is not known.
std::string NameWithUnit(const std::string& written) {
  const Path path = PathOf(written);
  const std::string parent = PathOf(path.before).last;
  const bool is_axis = IsOneOf(path.last, {"x", "y", "z"});
  if (path.last == "position") return written + "_rad";
  if (path.last == "velocity" || (is_axis && parent == "angular_velocity")) return written + "_rad_s";
  // The sensor measures it including gravity (REP 145), although "linear" elsewhere means without gravity.
  if (is_axis && parent == "linear_acceleration") return "specific_force_" + path.last + "_m_s2";
  return written;
}

/// The column of joint names in a table with one joint per row; kNoColumn for other tables.
std::size_t FindJoint(const std::vector<TableColumn>& columns, std::string_view row, char separator) {
  const bool has_state =
      FindByLastPart(columns, {"position", "velocity"}) != kNoColumn || !CandidatesOf(columns, "").empty();
  const std::size_t joint = FindByLastPart(columns, {"joint", "joint_name", "name", "topic"});
  if (!has_state || joint == kNoColumn) return kNoColumn;
  return IsName(FieldOf(row, separator, joint)) ? joint : kNoColumn;
}

/// Hides a rate beside the angle of the same joint. Such a rate is usually the derivative of the angle, not the reading
/// of another sensor.
void HideRates(std::vector<TableColumn>& columns) {
  for (TableColumn& column : columns) {
    const Path rate = PathOf(column.written);
    if (rate.last != "velocity") continue;
    const bool has_angle = std::ranges::any_of(columns, [&](const TableColumn& other) {
      const Path angle = PathOf(other.written);
      return angle.last == "position" && angle.before == rate.before && angle.index == rate.index;
    });
    if (has_angle) column.meaning.clear();
  }
}

/// Converts a stamp to nanoseconds. The stamp is a decimal number of seconds or a long whole number of nanoseconds;
/// std::nullopt for other text.
std::optional<std::int64_t> Nanoseconds(std::string_view text, bool is_whole_nanoseconds) {
  constexpr std::size_t kDigits = 9;
  const std::size_t point = text.find('.');
  std::int64_t seconds = 0, fraction = 0;
  const char* const whole_end = text.data() + std::min(point, text.size());
  const auto [stop, error] = std::from_chars(text.data(), whole_end, seconds);
  if (error != std::errc() || stop != whole_end) return std::nullopt;
  const bool is_long = is_whole_nanoseconds || text.size() > kLongestSeconds;
  if (point == std::string_view::npos && is_long) return seconds;
  constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::int64_t>::max() / kSecond - 1;
  if (seconds > kMaxSeconds || seconds < -kMaxSeconds) return std::nullopt;
  if (point != std::string_view::npos) {
    std::string digits(text.substr(point + 1));
    if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
    digits.resize(kDigits, '0');
    std::from_chars(digits.data(), digits.data() + kDigits, fraction);
  }
  return seconds * kSecond + (text.starts_with('-') ? -fraction : fraction);
}

/// Uses the column that the user names as the time. It contains stamps, unless the user gives its unit or its unit is
/// not certain.
void UseNamedTime(const std::vector<TableColumn>& columns, std::string_view row, char separator,
                  const ReadOptions& options, RosTable& table) {
  const TimeFlag flag = TimeFlagOf(columns, options.time_column);
  const std::size_t named = flag.column.empty() ? columns.size() : IndexOf(columns, flag.column);
  if (named == columns.size() || (named == table.seconds && flag.unit == nullptr)) return;
  const std::string name = PathOf(columns[named].written).last;
  const bool is_stamp = IsOneOf(name, {"%time", "__time"}) ||
                        (IsOneOf(name, {"stamp", "time"}) && HasKnownUnit(FieldOf(row, separator, named)));
  table.seconds = is_stamp && flag.unit == nullptr ? named : kNoColumn;
  table.nanoseconds = kNoColumn;
  table.is_nanoseconds = name == "%time";
}

}  // namespace

std::optional<RosTable> FindRos(std::vector<TableColumn>& columns, std::string_view row, char separator,
                                const ReadOptions& options) {
  RosTable table;
  const auto is_time = [](const TableColumn& column) {
    const Unit* unit = FindUnit(column.meaning);
    const Path path = PathOf(column.written);
    const bool is_part = IsOneOf(path.last, {"sec", "secs", "nsec", "nsecs", "nanosec"});  // of a stamp
    return unit != nullptr && unit->kind == Kind::kTime && path.before.empty() && !is_part;
  };
  const bool has_time = std::ranges::any_of(columns, is_time);
  if (!has_time) FindStamps(columns, row, separator, table);
  table.joint = FindJoint(columns, row, separator);
  const bool has_paths = std::ranges::any_of(columns, [](const TableColumn& column) {
    return column.written.starts_with('/') && NameWithUnit(column.written) != column.written;
  });
  if (table.seconds == kNoColumn && table.joint == kNoColumn && !has_paths) return std::nullopt;
  for (TableColumn& column : columns) {
    if (FindUnit(column.meaning) == nullptr) column.meaning = NameWithUnit(column.written);
  }
  if (table.seconds == kNoColumn && !has_time) {
    const std::size_t plain = FindByLastPart(columns, {"time", "timestamp", "t"});
    const std::string_view first = plain == kNoColumn ? "" : FieldOf(row, separator, plain);
    if (HasKnownUnit(first)) table.seconds = plain;
  }
  UseNamedTime(columns, row, separator, options, table);
  if (table.seconds != kNoColumn) columns[table.seconds].meaning = "time_s";
  const bool is_joint = table.joint != kNoColumn;  // The user may then name a joint but no column.
  const std::string asked = is_joint ? ChoiceOf(columns, options.value_column).column : options.value_column;
  if (asked.empty() && options.unit.empty()) HideRates(columns);
  return table;
}

bool StampClock::Read(std::string_view seconds, std::string_view nanoseconds, double& time) {
  std::optional<std::int64_t> stamp = Nanoseconds(seconds, is_whole_nanoseconds_);
  std::int64_t beyond = 0;
  if (!nanoseconds.empty()) {
    const char* const end = nanoseconds.data() + nanoseconds.size();
    const auto [stop, error] = std::from_chars(nanoseconds.data(), end, beyond);
    if (error != std::errc() || stop != end || beyond < 0 || beyond >= kSecond) return false;
  }
  if (!stamp) {  // Written by a program that stores stamps as doubles: 1.6e+09.
    constexpr double kMaxSeconds = 9e9;
    double number = 0;
    if (!ParseNumber(seconds, number) || std::abs(number) > kMaxSeconds) return false;
    stamp = std::llround(number * kSecond);
  }
  std::int64_t now = 0;
  if (__builtin_add_overflow(*stamp, beyond, &now)) return false;
  if (!first_) first_ = now;
  // Stamps of one recording are near each other. If the difference overflows, the numbers are not stamps.
  std::int64_t since = 0;
  if (__builtin_sub_overflow(now, *first_, &since)) return false;
  time = static_cast<double>(since) / kSecond;
  return true;
}

}  // namespace pendulum::csv
