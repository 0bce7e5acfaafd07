// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "recording/readers/columns/column.h"
#include "recording/readers/columns/csv.h"

/// Chooses the columns for time and quantity from the header and the user's options.
namespace pendulum::csv {

struct Column {
  std::size_t index = 0;
  std::string name;  // As messages show it.
  const Unit* unit = nullptr;
  bool is_gyro = false;             // According to its name.
  bool is_without_gravity = false;  // According to its name: a linear acceleration.
};

struct Layout {
  char separator = ',';
  std::size_t width = 0;
  bool has_header = false;
  std::optional<Column> time;  // std::nullopt: times come from a sample rate or from the host.
  bool is_time_unit_known = true;
  Column value;
  std::optional<Column> second;  // The vertical coordinate of a point whose horizontal one is `value`.
};

/// A name in the header and its position.
struct Name {
  std::string_view text;  // Determines quantity and unit; empty if the column cannot be used.
  const char* at;
  std::string_view written = text;  // As in the file, for messages and flags.
};

/// True for text that occurs only in a header: letters that are not part of a number.
inline bool IsName(std::string_view text) {
  text = Unquote(text);
  return text.find_first_not_of("0123456789+-.,;eE:> \t") != std::string_view::npos ||
         (!text.empty() && text.find_first_not_of("eE") == std::string_view::npos);
}

/// Splits a header at blanks, except those before or inside brackets.
inline std::vector<Name> SplitAtBlanks(std::string_view header) {
  std::vector<Name> names;
  header = Trim(header);
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= header.size(); ++i) {
    const bool is_end = i == header.size();
    if (!is_end && (header[i] == '(' || header[i] == '[')) ++depth;
    if (!is_end && (header[i] == ')' || header[i] == ']')) --depth;
    if (!is_end && (!IsBlank(header[i]) || depth > 0)) continue;
    const std::size_t next = std::min(header.find_first_not_of(" \t", i), header.size());
    if (next < header.size() && (header[next] == '(' || header[next] == '[')) continue;
    names.push_back({Unquote(header.substr(begin, i - begin)), header.data() + begin});
    begin = next;
    i = next;
  }
  return names;
}

inline std::vector<Name> SplitHeader(std::string_view header, char separator) {
  if (separator == ' ') return SplitAtBlanks(header);
  std::vector<Name> names;
  for (FieldCutter fields(header, separator); !fields.done();) {
    const std::string_view field = fields.Next();
    names.push_back({Unquote(field), Trim(field).data()});
  }
  return names;
}

inline std::size_t CountFields(std::string_view row, char separator) {
  std::size_t count = 0;
  for (FieldCutter fields(row, separator); !fields.done(); ++count) fields.Next();
  return count;
}

/// The separator with which every field of a row is a number, if any.
inline std::optional<char> SeparatorOfNumbers(std::string_view row) {
  for (const char separator : {'\t', ';', ',', ' '}) {
    if (separator != ' ' && row.find(separator) == std::string_view::npos) continue;
    Numbers numbers(separator != ',');
    bool all_numbers = true;
    for (FieldCutter fields(row, separator); !fields.done() && all_numbers;) {
      const std::string_view field = Unquote(fields.Next());
      double number = 0;
      all_numbers = numbers.Parse(field, number) || (field.empty() && fields.done());
    }
    if (all_numbers) return separator;
  }
  return std::nullopt;
}

/// Chooses the columns of one file. Errors as ReadRecording.
class ColumnChooser {
 public:
  /// `names` is empty without a header. The times need no column if the metadata give a sample rate (`has_rate`) or
  /// lines begin with the stamp of a serial monitor (`has_host`).
  ColumnChooser(const Line& line, const std::vector<Name>& names, const ReadOptions& options, bool has_rate,
                bool has_host)
      : line_(line), names_(names), options_(options), has_rate_(has_rate), has_host_(has_host) {}

  Result<void> Choose(Layout& layout);

 private:
  using Check = Result<void>;

  std::string ColumnNames() const;
  std::string NameOf(std::size_t index) const;
  const char* PlaceOf(std::size_t index) const;
  tl::unexpected<Status> WrongFlag(std::size_t index, const std::string& sentence) const;
  tl::unexpected<Status> Ambiguous(std::size_t one, std::size_t other, const std::string& role,
                                   const std::string& flag) const;
  Result<std::size_t> FindColumn(const std::string& flag, std::string_view name, Layout& layout) const;
  std::vector<std::size_t> Columns(Kind first, Kind last) const;
  Check CheckHeaderOrFlags(const Layout& layout) const;
  Check ChooseTime(Layout& layout);
  Check ChooseNamedTime(Layout& layout);
  Check ChooseValue(Layout& layout);
  Result<std::size_t> FindValue(Layout& layout) const;
  Result<std::size_t> OnlyColumnWithoutUnit(const Layout& layout) const;
  bool WantsColumnWithoutUnit(const std::vector<std::size_t>& columns, const Layout& layout) const;
  std::optional<std::size_t> FindVertical(std::size_t horizontal) const;
  Check CheckCoordinate(std::size_t index) const;
  Check SetValueUnit(Layout& layout, std::size_t index);

  const Line& line_;
  const std::vector<Name>& names_;
  const ReadOptions& options_;
  bool has_rate_;
  bool has_host_;
};

/// The header's names as messages show them.
inline std::string ColumnChooser::ColumnNames() const {
  constexpr std::size_t kShown = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(names_.size(), kShown); ++i) list += (i == 0 ? "" : ", ") + NameOf(i);
  return list + (names_.size() > kShown ? ", ..." : "");
}

inline std::string ColumnChooser::NameOf(std::size_t index) const {
  return index < names_.size() ? Quoted(names_[index].written) : std::to_string(index + 1);
}

inline const char* ColumnChooser::PlaceOf(std::size_t index) const {
  return index < names_.size() ? names_[index].at : line_.text.data();
}

inline tl::unexpected<Status> ColumnChooser::WrongFlag(std::size_t index, const std::string& sentence) const {
  return line_.Fault(PlaceOf(index), sentence, StatusCode::kInvalidArgument);
}

inline tl::unexpected<Status> ColumnChooser::Ambiguous(std::size_t one, std::size_t other, const std::string& role,
                                                       const std::string& flag) const {
  return line_.Fault(PlaceOf(other), "columns " + NameOf(one) + " and " + NameOf(other) + " could both be the " + role +
                                         "; choose one with " + flag);
}

/// Finds a column by its name or its number.
inline Result<std::size_t> ColumnChooser::FindColumn(const std::string& flag, std::string_view name,
                                                     Layout& layout) const {
  const auto found = std::ranges::find(names_, name, &Name::written);
  if (found != names_.end()) return found - names_.begin();
  double number = 0;
  if (!ParseNumber(name, number) || number < 1 || number > static_cast<double>(layout.width) ||
      number != static_cast<double>(static_cast<std::size_t>(number))) {
    const std::string count = std::to_string(layout.width) + (layout.width == 1 ? " column" : " columns");
    return WrongFlag(0, flag + " is " + Quoted(name) + ", which is none of the " + count +
                            (names_.empty() ? "; give its number, the first is 1"
                                            : " " + ColumnNames() + "; give a name, or a number from 1 on"));
  }
  return static_cast<std::size_t>(number) - 1;
}

/// The columns whose names contain a unit of these kinds.
inline std::vector<std::size_t> ColumnChooser::Columns(Kind first, Kind last) const {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const Unit* unit = FindUnit(names_[i].text);
    if (unit != nullptr && unit->kind >= first && unit->kind <= last) columns.push_back(i);
  }
  return columns;
}

/// A file without a header is read if the user's options replace the header completely. Otherwise the message lists the
/// missing options.
inline Result<void> ColumnChooser::CheckHeaderOrFlags(const Layout& layout) const {
  if (layout.has_header) return {};
  const bool needs_time =
      options_.time_column.empty() && options_.sample_rate_hz == 0 && !has_rate_ && !(has_host_ && layout.width == 1);
  const std::size_t times = options_.time_column.empty() || options_.time_column == "none" ? 0 : 1;
  const bool needs_value = options_.value_column.empty() && layout.width > 1 + times;
  const bool host_is_time = has_host_ && !options_.value_column.empty();
  std::vector<std::string> needed;
  if (needs_time && !host_is_time) needed.emplace_back("--time_column or --sample_rate_hz");
  if (needs_value && (layout.width > 2 || !needs_time)) needed.emplace_back("--value_column");
  if (options_.unit.empty()) needed.emplace_back("--unit");
  if (needed.empty()) return {};
  std::string flags;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    flags += (i == 0 ? "" : i + 1 == needed.size() ? " and " : ", ") + needed[i];
  }
  return line_.Fault(line_.text.data(),
                     "the first row has numbers instead of column names; put a header above it, such as "
                     "time_s,angle_deg, or describe the columns: give " +
                         flags);
}

inline Result<void> ColumnChooser::Choose(Layout& layout) {
  if (Check checked = CheckHeaderOrFlags(layout); !checked) return checked;
  if (Check chosen = ChooseTime(layout); !chosen) return chosen;
  return ChooseValue(layout);
}

/// NAME or NUMBER, optionally with :s, :ms or :us.
inline Result<void> ColumnChooser::ChooseNamedTime(Layout& layout) {
  std::string_view name = options_.time_column;
  const Unit* given_unit = nullptr;
  const std::size_t colon = name.rfind(':');
  if (colon != std::string_view::npos && std::ranges::find(names_, name, &Name::written) == names_.end()) {
    given_unit = UnitOfSuffix(name.substr(colon + 1));
    if (given_unit != nullptr && given_unit->kind != Kind::kTime) given_unit = nullptr;
    if (given_unit != nullptr) name = name.substr(0, colon);
  }
  const Result<std::size_t> index = FindColumn("--time_column", name, layout);
  if (!index) return tl::unexpected(index.error());
  const Unit* own = layout.has_header ? FindTimeUnit(names_[*index].text) : nullptr;
  if (given_unit != nullptr && own != nullptr && given_unit != own) {
    return WrongFlag(*index, "column " + NameOf(*index) + " is in " + std::string(own->name) + ", but --time_column " +
                                 options_.time_column + " says " + std::string(given_unit->name) +
                                 "; leave out the unit");
  }
  layout.is_time_unit_known = given_unit != nullptr || own != nullptr;
  layout.time = Column{*index, NameOf(*index),
                       given_unit != nullptr ? given_unit
                       : own != nullptr      ? own
                                             : UnitOfSuffix("s")};
  return {};
}

inline Result<void> ColumnChooser::ChooseTime(Layout& layout) {
  const bool is_rate_asked = options_.sample_rate_hz > 0;
  if (options_.time_column == "none") {
    if (has_rate_ || is_rate_asked || has_host_) return {};
    return WrongFlag(0, "with --time_column none there are no times; give --sample_rate_hz");
  }
  if (!options_.time_column.empty()) {
    if (is_rate_asked) {
      return WrongFlag(0, "--time_column and --sample_rate_hz both define the times; leave one of them out");
    }
    return ChooseNamedTime(layout);
  }
  const std::vector<std::size_t> times = Columns(Kind::kTime, Kind::kTime);
  if (!times.empty() && is_rate_asked) {
    return WrongFlag(times[0],
                     "column " + NameOf(times[0]) + " holds the times, so --sample_rate_hz " +
                         NumberText(options_.sample_rate_hz) +
                         " contradicts it; leave the flag out, or add --time_column none to ignore the column");
  }
  if (times.size() > 1) return Ambiguous(times[0], times[1], "time", "--time_column");
  if (times.size() == 1) layout.time = Column{times[0], NameOf(times[0]), FindUnit(names_[times[0]].text)};
  if (layout.time || is_rate_asked || has_rate_ || has_host_) return {};
  return line_.Fault(line_.text.data(), "none of the columns " + ColumnNames() +
                                            " is a time; call the column of times time_s, time_ms or time_us, or give "
                                            "--time_column or --sample_rate_hz");
}

/// The only column that is not the time and has no unit.
inline Result<std::size_t> ColumnChooser::OnlyColumnWithoutUnit(const Layout& layout) const {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < layout.width; ++i) {
    if (layout.time && i == layout.time->index) continue;
    if (layout.has_header && (FindUnit(names_[i].text) != nullptr || names_[i].text.empty())) continue;
    if (only) return Ambiguous(*only, i, "quantity", "--value_column");
    only = i;
  }
  if (only) return *only;
  return line_.Fault(line_.text.data(),
                     "none of the columns " + ColumnNames() + " can be the quantity; choose one with --value_column");
}

/// True if the user requests an angle, a rate or raw readings, the columns with units are lengths and accelerations,
/// and there is also a column whose name has no unit.
inline bool ColumnChooser::WantsColumnWithoutUnit(const std::vector<std::size_t>& columns, const Layout& layout) const {
  const Unit* asked = UnitOfSuffix(options_.unit);
  if (!layout.has_header || asked == nullptr || IsFallbackQuantity(*asked)) return false;
  bool has_column_without_unit = false;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const bool is_time = layout.time && layout.time->index == i;
    has_column_without_unit |= !is_time && !names_[i].text.empty() && FindUnit(names_[i].text) == nullptr;
  }
  return has_column_without_unit &&
         std::ranges::all_of(columns, [&](auto i) { return IsFallbackQuantity(*FindUnit(names_[i].text)); });
}

/// The column that the user chose; otherwise one whose name has the requested unit; otherwise one with any unit.
inline Result<std::size_t> ColumnChooser::FindValue(Layout& layout) const {
  if (!options_.value_column.empty()) return FindColumn("--value_column", options_.value_column, layout);
  std::vector<std::size_t> columns = Columns(Kind::kAngle, Kind::kRaw);
  if (columns.empty()) columns = Columns(Kind::kAcceleration, Kind::kLength);
  std::erase_if(columns, [&](std::size_t i) { return layout.time && layout.time->index == i; });
  if (!options_.unit.empty()) {
    std::vector<std::size_t> asked = columns;
    std::erase_if(asked, [&](std::size_t i) { return FindUnit(names_[i].text)->suffix != options_.unit; });
    if (!asked.empty()) columns = asked;
    if (columns.empty() || (asked.empty() && WantsColumnWithoutUnit(columns, layout)))
      return OnlyColumnWithoutUnit(layout);
  }
  std::vector<std::size_t> points = columns;
  std::erase_if(points, [&](std::size_t i) { return !FindVertical(i); });
  if (points.size() == 1) return points.front();
  if (columns.size() > 1) return Ambiguous(columns[0], columns[1], "quantity", "--value_column");
  if (columns.size() == 1) return columns[0];
  if (layout.width == 1) return 0;
  return line_.Fault(line_.text.data(),
                     "none of the columns " + ColumnNames() +
                         " is an angle, a rate or another quantity of a swing; end its name in its unit: " +
                         std::string(kSuffixes) + ", or give --value_column and --unit");
}

/// The column with the other coordinate of the same point: bob_y_px for bob_x_px.
inline std::optional<std::size_t> ColumnChooser::FindVertical(std::size_t horizontal) const {
  const std::string x = CanonicalName(names_[horizontal].text);
  const auto [stem, unit] = SplitName(x);
  if (unit == nullptr || unit->kind != Kind::kLength || (stem != "x_" && !stem.ends_with("_x_"))) return std::nullopt;
  std::string y = x;
  y[stem.size() - 2] = 'y';
  const auto found = std::ranges::find_if(names_, [&](const Name& name) { return CanonicalName(name.text) == y; });
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

/// Refuses a vertical coordinate. It is the same on both sides, so it oscillates twice as fast as the angle.
inline Result<void> ColumnChooser::CheckCoordinate(std::size_t index) const {
  if (index >= names_.size()) return {};
  const std::string name = CanonicalName(names_[index].text);
  const auto [stem, unit] = SplitName(name);
  if (unit == nullptr || unit->kind != Kind::kLength || (stem != "y_" && !stem.ends_with("_y_"))) return {};
  const bool asked = !options_.value_column.empty();
  const StatusCode code = asked ? StatusCode::kInvalidArgument : StatusCode::kDataLoss;
  return line_.Fault(PlaceOf(index),
                     "column " + NameOf(index) +
                         " is the height of the point, which is the same on both sides; choose the horizontal "
                         "coordinate with --value_column, or leave the flag out to use both",
                     code);
}

inline Result<void> ColumnChooser::SetValueUnit(Layout& layout, std::size_t index) {
  const Unit* own = layout.has_header ? FindUnit(names_[index].text) : nullptr;
  const Unit* second = layout.has_header ? SecondUnit(names_[index].text) : nullptr;
  const std::string column = "column " + NameOf(index);
  if (own != nullptr && second != nullptr && second != own) {
    return line_.Fault(PlaceOf(index), column + " names two units, " + std::string(second->name) + " and " +
                                           std::string(own->name) + "; keep the unit of its values");
  }
  const Unit* asked = options_.unit.empty() ? nullptr : UnitOfSuffix(options_.unit);
  if (!options_.unit.empty() && (asked == nullptr || asked->kind == Kind::kTime)) {
    return WrongFlag(index, "--unit is " + Quoted(options_.unit) +
                                "; it must be rad, deg, rad_s, deg_s, counts, volts, m_s2, px, m, cm or mm");
  }
  if (own != nullptr && asked != nullptr && own != asked) {
    return WrongFlag(index, column + " is in " + std::string(own->name) + ", so --unit " + options_.unit +
                                " contradicts it; leave the flag out, or choose another column with --value_column");
  }
  const Unit* unit = own != nullptr ? own : asked;
  if (unit == nullptr) {
    return line_.Fault(PlaceOf(index), column + " does not give its unit; end its name in " + std::string(kSuffixes) +
                                           ", or give --unit");
  }
  if (unit->kind == Kind::kTime) {
    return line_.Fault(
        PlaceOf(index),
        column + " is in " + std::string(unit->name) +
            ", which is not an angle; convert it to degrees or radians and end its name in _deg or _rad");
  }
  const std::string name = layout.has_header ? CanonicalName(names_[index].text) : "";
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  const bool is_gyro = has("gyro") || ("_" + name).find("_rate_") != std::string::npos;
  layout.value = Column{index, NameOf(index), unit, is_gyro, has("linear") || has("without_g") || has("without g")};
  return {};
}

inline Result<void> ColumnChooser::ChooseValue(Layout& layout) {
  const Result<std::size_t> index = FindValue(layout);
  if (!index) return tl::unexpected(index.error());
  if (layout.time && layout.time->index == *index) {
    return WrongFlag(*index, "column " + NameOf(*index) +
                                 " cannot be both the time and the quantity; choose another "
                                 "with --value_column");
  }
  const bool asked = !options_.value_column.empty();
  if (Check checked = CheckCoordinate(*index); !checked) return checked;
  if (Check set = SetValueUnit(layout, *index); !set) return set;
  const std::optional<std::size_t> vertical = asked || *index >= names_.size() ? std::nullopt : FindVertical(*index);
  if (vertical) layout.second = Column{*vertical, NameOf(*vertical), layout.value.unit};
  return {};
}

}  // namespace pendulum::csv
