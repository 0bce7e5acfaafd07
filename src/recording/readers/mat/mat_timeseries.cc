// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_timeseries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <tl/expected.hpp>

#include "recording/readers/columns/runs.h"

namespace pendulum {
namespace {

using Kind = MatValue::Kind;

constexpr std::string_view kTimeseries = "timeseries", kTimeClass = "tsdata.timemetadata",
                           kDataClass = "tsdata.datametadata";

/// Why a timeseries cannot be read; follows "is" in a message.
using NotReadable = tl::unexpected<std::string>;
template <typename T>
using Readable = tl::expected<T, std::string>;

NotReadable Unknown() { return NotReadable("a timeseries that is damaged, or from an unknown version of MATLAB"); }

/// Values of the properties of a file's objects.
class Properties {
 public:
  explicit Properties(const MatSubsystem& subsystem)
      : subsystem_(subsystem), objects_(*subsystem.objects), defaults_(subsystem.cell(subsystem.cells - 1)) {}

  /// The object's own value of a property, otherwise the default of its class; std::nullopt if neither is stored.
  std::optional<MatValue> Of(std::size_t object, std::string_view name) const {
    if (const McosProperty* const own = objects_.Find(object, name); own != nullptr) return ValueOf(*own);
    const std::size_t class_id = objects_.ClassOf(object);
    if (defaults_.kind != Kind::kCells || class_id >= defaults_.parts.size()) return std::nullopt;
    const MatValue* const value = defaults_.parts[class_id].Field(name);
    return value == nullptr ? std::nullopt : std::optional(*value);
  }

  /// The single object of this class that a property refers to; std::nullopt if it is anything else.
  std::optional<std::size_t> ObjectIn(std::size_t object, std::string_view name, std::string_view class_name) const {
    const std::optional<MatValue> value = Of(object, name);
    const std::optional<MatObjects> found = value ? ObjectsOf(*value) : std::nullopt;
    if (!found || found->objects.size() != 1) return std::nullopt;
    const std::size_t class_id = objects_.ClassOf(found->objects.front());
    if (class_id == 0 || class_id != found->class_id || objects_.ClassName(class_id) != class_name) return std::nullopt;
    return found->objects.front();
  }

  const Mcos& objects() const { return objects_; }

 private:
  MatValue ValueOf(const McosProperty& property) const {
    MatValue value;
    switch (property.kind) {
      case McosProperty::Kind::kCell: return subsystem_.cell(property.value);
      case McosProperty::Kind::kEnumeration: value.text = objects_.Name(property.value); break;
      case McosProperty::Kind::kNumber:
        value.kind = Kind::kNumbers;
        value.sizes = {1, 1};
        value.numbers = {static_cast<double>(property.value)};
    }
    return value;
  }

  const MatSubsystem& subsystem_;
  const Mcos& objects_;
  MatValue defaults_;
};

// ---- The times ---------------------------------------------------------------------------------------------------

/// A unit of time in a timeseries. Numbers times factor / divisor are in the unit of a column named `meaning`.
struct TimeUnit {
  std::string_view name, meaning;
  double factor = 1, divisor = 1;
};

constexpr std::array kTimeUnits = {
    TimeUnit{"seconds", "time_s"},       TimeUnit{"milliseconds", "time_ms"},
    TimeUnit{"microseconds", "time_us"}, TimeUnit{"nanoseconds", "time_us", 1, 1e3},
    TimeUnit{"minutes", "time_s", 60},   TimeUnit{"hours", "time_s", 3600},
    TimeUnit{"days", "time_s", 86'400},  TimeUnit{"weeks", "time_s", 604'800},
};

/// The unit of a tsdata.timemetadata object. Seconds are the default of the class, and are assumed if the unit is
/// empty.
Readable<TimeUnit> TimeUnitOf(const Properties& properties, std::size_t info) {
  const std::optional<MatValue> units = properties.Of(info, "Units");
  if (!units) return kTimeUnits.front();
  if (units->IsEmpty()) return TimeUnit{"", "time_s"};
  if (units->kind != Kind::kText) return Unknown();
  const auto* const found = std::ranges::find(kTimeUnits, units->text, &TimeUnit::name);
  if (found != kTimeUnits.end()) return *found;
  return NotReadable("a timeseries whose unit of time (" + units->text.substr(0, 32) + ") is not known");
}

/// A property that is a single number; std::nullopt otherwise.
std::optional<double> NumberIn(const Properties& properties, std::size_t object, std::string_view name) {
  const std::optional<MatValue> value = properties.Of(object, name);
  if (!value || value->kind != Kind::kNumbers || value->numbers.size() != 1) return std::nullopt;
  return value->numbers.front();
}

/// Explicitly listed times; empty if there are none.
Readable<std::vector<double>> ListIn(const Properties& properties, std::size_t object) {
  const std::optional<MatValue> list = properties.Of(object, "Time_");
  if (!list || list->IsEmpty()) return std::vector<double>();
  if (list->kind != Kind::kNumbers || ObjectsOf(*list)) return Unknown();
  return list->numbers;
}

/// The times in row order, at most `max_times`: listed in the object itself or in its TimeInfo, or uniform.
Readable<std::vector<double>> TimesOf(const Properties& properties, std::size_t object, std::size_t info,
                                      std::size_t max_times) {
  const Readable<std::vector<double>> own = ListIn(properties, object), list = ListIn(properties, info);
  if (!own || !list || (!own->empty() && !list->empty() && *own != *list)) return Unknown();
  const std::optional<double> length = NumberIn(properties, info, "Length");
  if (std::vector<double> times = list->empty() ? *own : *list; !times.empty()) {
    if (length && *length != 0 && *length != static_cast<double>(times.size())) return Unknown();
    return times;
  }
  const std::optional<double> start = NumberIn(properties, info, "Start_");
  const std::optional<double> step = NumberIn(properties, info, "Increment_");
  const bool is_uniform = start && step && std::isfinite(*start) && std::isfinite(*step) && *step > 0;
  if (!is_uniform || !length || !(*length >= 1 && *length <= static_cast<double>(max_times))) return Unknown();
  std::vector<double> times(static_cast<std::size_t>(*length));
  if (static_cast<double>(times.size()) != *length) return Unknown();
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = *start + *step * static_cast<double>(i);
  return times;
}

// ---- The values --------------------------------------------------------------------------------------------------

/// The unit of a timeseries in the form of a header; empty if it has none.
std::string UnitIn(const Properties& properties, std::size_t object) {
  const auto info = properties.ObjectIn(object, "DataInfo", kDataClass);
  const std::optional<MatValue> units = info ? properties.Of(*info, "Units") : std::nullopt;
  if (!units || units->kind != Kind::kText || units->text == "inherit") return "";
  const std::string& text = units->text;
  if (text == "degree" || text == "degrees") return "deg";
  if (text == "radian" || text == "radians") return "rad";
  return text;
}

/// The last part of a name with indices: angle_deg for `run.angle_deg(2)`.
std::string LastPart(std::string name) {
  while (name.ends_with(')') || name.ends_with('}')) name.resize(std::min(name.find_last_of("({"), name.size() - 1));
  return name.substr(name.rfind('.') + 1);
}

/// How columns are laid out in the array. In an array of three or more dimensions, time is the last dimension. In a
/// matrix, time is the dimension as long as the list of times, or the first dimension if both match.
struct Spread {
  std::size_t columns = 1, step = 1, next = 1;  // step: from row to row, next: from column to column.
  bool is_time_first = true;
};

std::optional<Spread> SpreadOf(const std::vector<std::size_t>& sizes, std::size_t rows) {
  const std::size_t count = CountIn(sizes).value_or(0);
  if (count == 0 || rows == 0 || sizes.size() < 2) return std::nullopt;
  const std::size_t columns = count / rows;
  if (sizes.size() == 2 && sizes[0] == rows) return Spread{columns, 1, rows};
  if (sizes.back() != rows) return std::nullopt;
  return Spread{columns, columns, 1, false};
}

/// The place of a column in MATLAB's notation: Data, Data(:,2), or Data(2,1,:) if time is the last dimension.
std::string PlaceIn(const Spread& spread, const std::vector<std::size_t>& sizes, std::size_t column) {
  if (spread.columns == 1) return "Data";
  if (spread.is_time_first) return "Data(:," + std::to_string(column + 1) + ")";
  std::string places;
  for (const std::size_t size : std::span(sizes).first(sizes.size() - 1)) {
    places += std::to_string(column % size + 1) + ",";
    column /= size;
  }
  return "Data(" + places + ":)";
}

/// The columns of one object, starting with the time.
Readable<std::vector<MatColumn>> ColumnsOf(const Properties& properties, std::size_t object, const std::string& name,
                                           const std::string& meaning) {
  const std::optional<MatValue> storage = properties.Of(object, "Storage_");
  if (storage && !storage->IsEmpty()) return NotReadable("a timeseries whose numbers are in another file");
  const std::optional<MatValue> data = properties.Of(object, "Data_");
  if (data && data->IsEmpty()) return NotReadable("a timeseries without numbers");
  const auto info = properties.ObjectIn(object, "TimeInfo", kTimeClass);
  if (!data || data->kind != Kind::kNumbers || ObjectsOf(*data) || !info) return Unknown();
  const Readable<TimeUnit> unit = TimeUnitOf(properties, *info);
  if (!unit) return tl::unexpected(unit.error());
  Readable<std::vector<double>> times = TimesOf(properties, object, *info, data->numbers.size());
  if (!times) return tl::unexpected(times.error());
  const std::size_t rows = times->size();
  const std::optional<Spread> spread = SpreadOf(data->sizes, rows);
  if (!spread) return Unknown();
  if (spread->columns > kMaxMatColumns) return NotReadable("a timeseries of more than a hundred columns");
  for (double& time : *times) time = time * unit->factor / unit->divisor;
  std::vector<MatColumn> columns;
  columns.push_back({{name + ".Time", std::string(unit->meaning), name}, *std::move(times), !unit->name.empty()});
  for (std::size_t j = 0; j < spread->columns; ++j) {
    std::vector<double> values(rows);
    for (std::size_t i = 0; i < rows; ++i) values[i] = data->numbers[i * spread->step + j * spread->next];
    columns.push_back({{name + "." + PlaceIn(*spread, data->sizes, j), meaning, name}, std::move(values)});
  }
  return columns;
}

// ---- All of a file -----------------------------------------------------------------------------------------------

/// Adds the objects of class timeseries one by one.
class TimeseriesAdder {
 public:
  TimeseriesAdder(const MatSubsystem& subsystem, MatTable& table)
      : subsystem_(subsystem), table_(table), properties_(subsystem) {
    for (const MatColumn& column : table.columns) names_.insert({column.name.run, column.name.written});
  }

  /// Adds all of them. Returns true if there is at least one.
  bool AddAll() {
    constexpr std::size_t kMaxTimeseries = 1000;
    const Mcos& objects = properties_.objects();
    std::size_t object = 1;
    for (; object < objects.objects() && count_ < kMaxTimeseries; ++object) {
      if (objects.ClassName(objects.ClassOf(object)) == kTimeseries) Add(object);
    }
    if (object < objects.objects()) table_.skipped.push_back({"", "one of more than a thousand timeseries", true});
    return count_ > 0;
  }

 private:
  void Add(std::size_t object) {
    ++count_;
    const auto place = std::ranges::find_if(subsystem_.references, [&](const MatReference& reference) {
      return reference.object == object && reference.class_name == kTimeseries;
    });
    const bool is_placed = place != subsystem_.references.end();
    const std::optional<MatValue> given_name = properties_.Of(object, "Name");
    const std::string own = given_name && given_name->kind == Kind::kText ? given_name->text : "";
    const std::string name = Unique(is_placed ? place->place : own);
    const std::string unit = UnitIn(properties_, object);
    const std::string part = is_placed ? LastPart(place->place) : own;
    const std::string sense = csv::FindUnit(part) == nullptr && csv::FindUnit(own) != nullptr ? own : part;
    const std::string meaning = unit.empty() ? sense : csv::PlainUnits(part + " (" + unit + ")");
    auto columns = ColumnsOf(properties_, object, name, meaning);
    if (!columns) {
      table_.skipped.push_back({name, columns.error(), true});
      return;
    }
    std::ranges::move(*columns, std::back_inserter(table_.columns));
  }

  /// A name different from the names of all other timeseries and of runs and columns of other variables.
  std::string Unique(const std::string& name) {
    if (!name.empty() && names_.insert(name).second) return name;
    for (std::size_t number = count_;; ++number) {
      std::string other = "timeseries " + std::to_string(number);
      if (names_.insert(other).second) return other;
    }
  }

  const MatSubsystem& subsystem_;
  MatTable& table_;
  Properties properties_;
  std::set<std::string> names_;
  std::size_t count_ = 0;
};

}  // namespace

void AddTimeseries(const MatSubsystem& subsystem, MatTable& table) {
  const bool is_readable = subsystem.objects && subsystem.cells > 0 && subsystem.cell;
  const bool has_some = is_readable && TimeseriesAdder(subsystem, table).AddAll();
  for (const auto& [place, class_name, object] : subsystem.references) {
    const bool is_timeseries = class_name == kTimeseries;
    const bool is_known =
        is_readable && subsystem.objects->ClassName(subsystem.objects->ClassOf(object)) == kTimeseries;
    // A timeseries has been added above. Other objects may contain one, so they are reported only if there is none.
    if (is_timeseries ? is_known : has_some) continue;
    table.skipped.push_back({place, is_timeseries ? Unknown().value() : "an object of class " + class_name, true});
  }
}

}  // namespace pendulum
