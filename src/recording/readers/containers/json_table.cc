// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/json_table.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "pendulum/base/utf8.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/json_value.h"

namespace pendulum {
namespace {

/// `first_line`: the line of the file in which the text begins, from 0.
void SetFault(std::string_view text, std::size_t first_line, const JsonFault& fault, Workbook& workbook) {
  const std::string_view before = text.substr(0, fault.byte);
  const std::size_t line = first_line + 1 + static_cast<std::size_t>(std::ranges::count(before, '\n'));
  const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  workbook.place = std::to_string(line) + ":" + std::to_string(column);
  workbook.complaint = "this is not JSON (" + fault.reason + "); correct it here";
}

bool IsNumeric(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Finds the tables of a value and writes them.
class JsonTableFinder {
 public:
  JsonTableFinder(Workbook& workbook, std::size_t max_bytes) : workbook_(workbook), max_bytes_(max_bytes) {}

  /// Finds the tables in a value. `name` is its key.
  void Find(const JsonValue& value, const std::string& name) {
    if (const JsonArray* array = AsArray(value)) return FindInArray(*array, name);
    const JsonObject* const object = AsObject(value);
    if (object == nullptr) return;
    const std::size_t outer = comments_.size();
    if (!FindPandasSplit(*object, name) && !FindPhyphox(*object, name) && !FindColumns(*object, name) &&
        !FindPandasColumns(*object, name)) {
      AddComments(*object);
      for (const auto& [key, member] : object->members) {
        if (!IsMetadata(*key)) Find(member, name.empty() ? *key : name + "." + *key);
      }
    }
    comments_.resize(outer);
  }

 private:
  using Cells = std::vector<const JsonValue*>;

  struct Column {
    std::string name;
    Cells cells;
  };

  /// Keys whose value is metadata even if it is an array or an object.
  static bool IsMetadata(std::string_view key) {
    return key == "range" || key == "window_s" || key == "rig" || key == "calibration";
  }

  static bool IsColumn(std::string_view key, const JsonValue& value) {
    const JsonArray* const array = AsArray(value);
    return array != nullptr && !IsMetadata(key) && !array->items.empty() && std::ranges::all_of(array->items, IsScalar);
  }

  /// The members that are no tables as lines `# key: value`.
  void AddComments(const JsonObject& object) {
    constexpr std::size_t kLongest = 10'000;
    for (const auto& [key, value] : object.members) {
      constexpr std::array kNumbers = {"resolution",          "sample_rate_hz", "clock_scale",
                                       "clock_scale_std_dev", "lost_samples",   "oversample"};
      const bool is_text = AsString(value) != nullptr;
      const bool is_window = *key == "window_s";  // a length, or begin and end
      if (IsMetadata(*key) && !(is_window && IsScalar(value)) ? is_text : !IsScalar(value)) continue;
      if (is_text && std::ranges::find(kNumbers, *key) != kNumbers.end()) continue;  // resolution: "1920x1080"
      std::string text = is_text ? *AsString(value) : JsonLine(value);
      if ((*key == "range" || is_window) && AsArray(value) != nullptr) text = text.substr(1, text.size() - 2);
      if (text.size() < kLongest) comments_.push_back("# " + *key + ": " + text);
    }
  }

  // ---- Forms of tables ---------------------------------------------------------------------------------------------

  /// {"t": [...], "angle_deg": [...]}
  bool FindColumns(const JsonObject& object, const std::string& name) {
    std::vector<Column> columns;
    for (const auto& [key, value] : object.members) {
      if (!IsColumn(*key, value)) continue;
      Column& column = columns.emplace_back(Column{*key, {}});
      for (const JsonValue& item : AsArray(value)->items) column.cells.push_back(&item);
    }
    if (columns.empty()) return false;
    AddComments(object);
    Write(columns, name);
    return true;
  }

  /// {"buffer": {"acc_time": {"size": 0, "updateMode": "full", "buffer": [...]}, ...}}
  bool FindPhyphox(const JsonObject& object, const std::string& name) {
    const JsonValue* const buffers = FindMember(object, "buffer");
    const JsonObject* const all = buffers == nullptr ? nullptr : AsObject(*buffers);
    if (all == nullptr) return false;
    std::vector<Column> columns;
    for (const auto& [key, value] : all->members) {
      const JsonObject* const buffer = AsObject(value);
      const JsonValue* const content = buffer == nullptr ? nullptr : FindMember(*buffer, "buffer");
      if (content == nullptr || !IsColumn(*key, *content)) continue;
      Column& column = columns.emplace_back(Column{*key, {}});
      for (const JsonValue& item : AsArray(*content)->items) column.cells.push_back(&item);
    }
    if (columns.empty()) return false;
    Write(columns, name);
    return true;
  }

  /// {"columns": ["t", "angle_deg"], "index": [...], "data": [[0, 3], ...]}
  bool FindPandasSplit(const JsonObject& object, const std::string& name) {
    const JsonValue* const names = FindMember(object, "columns");
    const JsonValue* const data = FindMember(object, "data");
    if (names == nullptr || data == nullptr || AsArray(*names) == nullptr || AsArray(*data) == nullptr) return false;
    std::vector<Column> columns;
    for (const JsonValue& each : AsArray(*names)->items) {
      columns.push_back({AsString(each) != nullptr ? *AsString(each) : JsonLine(each), {}});
    }
    AddRows(*AsArray(*data), 0, columns);
    Write(columns, name);
    return true;
  }

  /// {"t": {"0": 0, "1": 1}, "angle_deg": {...}}, or {"0": {"t": 0, "angle_deg": 3}, ...}
  bool FindPandasColumns(const JsonObject& object, const std::string& name) {
    const auto is_series = [](const auto& member) {
      const JsonObject* const series = AsObject(member.second);
      return series != nullptr && !IsMetadata(*member.first) && !series->members.empty() &&
             std::ranges::all_of(series->members, [](const auto& each) { return IsScalar(each.second); });
    };
    const auto has_numeric_keys = [](const JsonObject& series) {
      return std::ranges::all_of(series.members, [](const auto& each) { return IsNumeric(*each.first); });
    };
    if (object.members.empty() || !std::ranges::all_of(object.members, is_series)) return false;
    if (has_numeric_keys(object)) {
      Cells rows;
      for (const auto& member : object.members) rows.push_back(&member.second);
      WriteRecords(rows, name);
      return true;
    }
    std::vector<Column> columns;
    for (const auto& [key, value] : object.members) {
      if (!has_numeric_keys(*AsObject(value))) return false;
      Column& column = columns.emplace_back(Column{*key, {}});
      for (const auto& each : AsObject(value)->members) column.cells.push_back(&each.second);
    }
    Write(columns, name);
    return true;
  }

  void FindInArray(const JsonArray& array, const std::string& name) {
    const auto is_all = [&](const auto& is_kind) { return std::ranges::all_of(array.items, is_kind); };
    if (array.items.empty()) return;
    if (is_all([](const JsonValue& item) { return AsObject(item) != nullptr; })) {
      Cells records;
      for (const JsonValue& item : array.items) records.push_back(&item);
      WriteRecords(records, name);
    } else if (is_all([](const JsonValue& item) { return AsArray(item) != nullptr; })) {
      if (AreColumns(array)) return WriteLists(array, name);
      WriteRows(array, name);
    } else if (is_all(IsScalar)) {
      std::vector<Column> columns(1);
      for (const JsonValue& item : array.items) columns[0].cells.push_back(&item);
      Write(columns, name);
    }
  }

  /// Whether a few long lists of numbers hold a column each: [[0, 0.01, ...], [3, 2.9, ...]].
  static bool AreColumns(const JsonArray& lists) {
    constexpr auto kMostColumns = static_cast<std::size_t>(kMinimumSamples) - 1;
    const std::size_t length = AsArray(lists.items.front())->items.size();
    const auto is_column = [&](const JsonValue& list) {
      const JsonArray& items = *AsArray(list);
      return items.items.size() == length && std::ranges::all_of(items.items, [](const JsonValue& item) {
               const std::string* const text = AsString(item);
               return IsScalar(item) && (text == nullptr || text->empty());  // NaN is an empty text.
             });
    };
    return lists.items.size() <= kMostColumns && length > kMostColumns && std::ranges::all_of(lists.items, is_column);
  }

  void WriteLists(const JsonArray& lists, const std::string& name) {
    std::vector<Column> columns(lists.items.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      for (const JsonValue& item : AsArray(lists.items[i])->items) columns[i].cells.push_back(&item);
    }
    Write(columns, name);
  }

  /// [[0, 3], [1, 4]], with or without names in the first row.
  void WriteRows(const JsonArray& rows, const std::string& name) {
    const JsonArray& first = *AsArray(rows.items.front());
    const auto is_name = [](const JsonValue& cell) { return AsString(cell) != nullptr; };
    const bool has_names = !first.items.empty() && std::ranges::all_of(first.items, is_name);
    std::vector<Column> columns;
    for (const JsonValue& cell : first.items) columns.push_back({has_names ? *AsString(cell) : "", {}});
    AddRows(rows, has_names ? 1 : 0, columns);
    Write(columns, name);
  }

  static void AddRows(const JsonArray& rows, std::size_t first, std::vector<Column>& columns) {
    for (std::size_t row = first; row < rows.items.size(); ++row) {
      const JsonArray* const cells = AsArray(rows.items[row]);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        columns[i].cells.push_back(cells != nullptr && i < cells->items.size() ? &cells->items[i] : nullptr);
      }
    }
  }

  /// [{"t": 0, "angle_deg": 3}, ...]; {"gyro": {"x": 1}} becomes a column gyro.x, {"gyro": [1]} a column gyro.0.
  void WriteRecords(const Cells& records, const std::string& name) {
    std::vector<Column> columns;
    std::map<std::string, std::size_t, std::less<>> index;
    for (std::size_t row = 0; row < records.size(); ++row) AddRecord(*records[row], "", row, columns, index);
    Write(columns, name);
  }

  static void AddRecord(const JsonValue& value, const std::string& key, std::size_t row, std::vector<Column>& columns,
                        std::map<std::string, std::size_t, std::less<>>& index) {
    constexpr std::size_t kMaxColumns = 1000;
    const auto sub_key = [&](const std::string& part) { return key.empty() ? part : key + "." + part; };
    if (const JsonObject* object = AsObject(value)) {
      for (const auto& [part, member] : object->members) AddRecord(member, sub_key(*part), row, columns, index);
    } else if (const JsonArray* array = AsArray(value)) {
      for (std::size_t i = 0; i < array->items.size(); ++i) {
        AddRecord(array->items[i], sub_key(std::to_string(i)), row, columns, index);
      }
    } else {
      const auto [found, is_new] = index.emplace(key, columns.size());
      if (is_new && columns.size() < kMaxColumns) columns.push_back({key, {}});
      if (found->second >= columns.size()) return;
      Cells& cells = columns[found->second].cells;
      if (cells.size() < row + 1) cells.resize(row + 1);
      cells[row] = &value;
    }
  }

  // ---- Writing -----------------------------------------------------------------------------------------------------

  struct CellWriter {
    CsvText& csv;
    std::size_t row, column;

    void operator()(std::nullptr_t) const {}
    void operator()(bool value) const { csv.AddText(row, column, value ? "TRUE" : "FALSE"); }
    void operator()(double value) const { csv.AddNumber(row, column, value); }
    void operator()(std::int64_t value) const { csv.AddText(row, column, std::to_string(value)); }
    void operator()(const std::unique_ptr<std::string>& text) const { csv.AddText(row, column, *text); }
    void operator()(const std::unique_ptr<JsonArray>&) const {}
    void operator()(const std::unique_ptr<JsonObject>&) const {}
  };

  void Write(const std::vector<Column>& columns, const std::string& name) {
    if (workbook_.is_too_large) return;
    CsvText csv(max_bytes_);
    std::size_t row = 0, rows = 0;
    for (const std::string& comment : comments_) csv.AddText(row++, 0, comment);
    const bool has_names = std::ranges::any_of(columns, [](const Column& column) { return !column.name.empty(); });
    for (std::size_t i = 0; has_names && i < columns.size(); ++i) csv.AddText(row, i, columns[i].name);
    row += has_names ? 1 : 0;
    for (const Column& column : columns) rows = std::max(rows, column.cells.size());
    for (std::size_t r = 0; r < rows && !csv.is_full(); ++r) {
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const Cells& cells = columns[i].cells;
        if (r < cells.size() && cells[r] != nullptr) std::visit(CellWriter{csv, row + r, i}, *cells[r]);
      }
    }
    Sheet sheet{name, ""};
    if (!FinishSheet(csv, max_bytes_, sheet, workbook_)) return;
    workbook_.sheets.push_back(std::move(sheet));
  }

  Workbook& workbook_;
  std::size_t max_bytes_;
  std::vector<std::string> comments_;  // Of the objects around the current value.
};

/// The lines of a text with one value each.
struct JsonLines {
  JsonArray values;
  std::string incomplete;  // A last line that is cut off.
};

JsonLines ParseLines(std::string_view text, JsonKeys& keys, Workbook& workbook) {
  JsonLines lines;
  for (std::size_t number = 0; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    JsonValue value;
    const JsonFault fault = ParseJson(line, keys, value);
    const bool is_last = text.find_first_not_of(" \t\r\n") == std::string_view::npos;
    if (fault.reason.empty()) {
      lines.values.items.push_back(std::move(value));
    } else if (is_last) {
      lines.incomplete = line;
    } else {
      SetFault(line, number, fault, workbook);
      return lines;
    }
  }
  return lines;
}

/// True if the first line is a complete value and others follow.
bool HasValueOnEachLine(std::string_view text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos || text.find_first_not_of(" \t\r\n", end) == std::string_view::npos) return false;
  JsonKeys keys;
  JsonValue first;
  return ParseJson(text.substr(0, end), keys, first).reason.empty();
}

}  // namespace

Workbook ReadJsonTables(std::string_view text, std::size_t max_bytes) {
  text = WithoutByteOrderMark(text);
  Workbook workbook;
  JsonKeys keys;
  JsonValue root;
  std::string incomplete;
  if (HasValueOnEachLine(text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size())))) {
    JsonLines lines = ParseLines(text, keys, workbook);
    root = std::make_unique<JsonArray>(std::move(lines.values));
    incomplete = std::move(lines.incomplete);
  } else if (const JsonFault fault = ParseJson(text, keys, root); !fault.reason.empty()) {
    SetFault(text, 0, fault, workbook);
  }
  if (!workbook.complaint.empty()) return workbook;
  JsonTableFinder(workbook, max_bytes).Find(root, "");
  if (workbook.is_too_large || !workbook.complaint.empty()) return workbook;
  if (workbook.sheets.empty()) {
    workbook.complaint =
        R"(this JSON has no arrays of numbers; a recording is {"t": [0, 0.01], "angle_deg": [10, 9.9]})";
  }
  if (workbook.sheets.size() == 1) workbook.sheets.front().text += incomplete;
  return workbook;
}

}  // namespace pendulum
