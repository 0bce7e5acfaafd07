// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/labelled_rows.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/utf8.h"
#include "recording/readers/columns/csv.h"
#include "recording/readers/text/host_stamp.h"

namespace pendulum::csv {
namespace {

constexpr std::string_view kBlanks = " \t\r", kBetween = " \t\r,;|";

struct LabelledValue {
  std::string_view label, value, unit;
};

using LabelledRow = std::vector<LabelledValue>;

/// A letter of any alphabet: bytes from 0x80 on are those of other characters in UTF-8.
bool BeginsLabel(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

void Skip(std::string_view& text, std::string_view characters) {
  text.remove_prefix(std::min(text.find_first_not_of(characters), text.size()));
}

/// Removes and returns the beginning of a text, up to one of these characters.
std::string_view TakeUpTo(std::string_view& text, std::string_view characters) {
  const std::string_view taken = text.substr(0, text.find_first_of(characters));
  text.remove_prefix(taken.size());
  return taken;
}

/// Removes "label:" or "label =" from the beginning of a text. Returns the label; empty if there is none.
std::string_view TakeLabel(std::string_view& text) {
  std::string_view rest = text;
  const std::string_view label = TakeUpTo(rest, " \t\r,;|:=");
  Skip(rest, kBlanks);
  if (label.empty() || !BeginsLabel(label.front())) return {};
  if (rest.empty() || (rest.front() != ':' && rest.front() != '=')) return {};
  rest.remove_prefix(1);
  Skip(rest, kBlanks);
  text = rest;
  return label;
}

/// Removes and returns a number; empty if there is none, or if more of it follows, as in 12:30:00 and 0x1f.
std::string_view TakeNumber(std::string_view& text) {
  const std::string_view taken = text.substr(0, text.find_first_not_of("+-.0123456789eE"));
  double number = 0;
  const std::string_view rest = text.substr(taken.size());
  const bool has_more = !rest.empty() && (rest.front() == ':' || rest.front() == 'x' || rest.front() == 'X');
  if (has_more || !ParseNumber(taken, number)) return {};
  text = rest;
  return taken;
}

/// The values of a row; empty if a text has another form.
LabelledRow RowOf(std::string_view text) {
  constexpr std::size_t kMost = 64;
  LabelledRow row;
  for (Skip(text, kBetween); !text.empty(); Skip(text, kBetween)) {
    LabelledValue value;
    value.label = TakeLabel(text);
    value.value = TakeNumber(text);
    if (value.label.empty() || value.value.empty() || row.size() == kMost) return {};
    Skip(text, kBlanks);
    std::string_view after = text;
    if (TakeLabel(after).empty()) value.unit = TakeUpTo(text, kBetween);
    row.push_back(value);
  }
  return row;
}

/// A line in two parts: the stamp of a serial monitor, if there is one, and the rest.
struct StampedLine {
  std::string_view stamp, rest;
};

StampedLine SplitStamp(std::string_view line) {
  const auto stamp = FindHostStamp(line);
  const std::string_view rest = stamp ? stamp->rest : line;
  return {line.substr(0, line.size() - rest.size()), rest};
}

/// The header of the table: the labels, with units in brackets. Rows with the same header belong together.
std::string HeaderOf(const LabelledRow& row) {
  std::string header;
  for (const LabelledValue& value : row) {
    header.append(header.empty() ? "" : ",").append(value.label);
    if (!value.unit.empty()) header.append(" (").append(value.unit).append(")");
  }
  return header;
}

std::string ValuesOf(const LabelledRow& row) {
  std::string values;
  for (const LabelledValue& value : row) values.append(values.empty() ? "" : ",").append(value.value);
  return values;
}

/// Calls `take` with each line, without its end.
template <typename Take>
void ForEachLineOf(std::string_view text, const Take& take) {
  text = WithoutByteOrderMark(text);
  while (!text.empty()) {
    take(TakeUpTo(text, "\n"));
    if (!text.empty()) text.remove_prefix(1);
  }
}

/// A row with the header of most lines at the beginning of a text; empty if they are not rows of this kind, at least
/// five.
LabelledRow FindTypicalRow(std::string_view text) {
  constexpr std::size_t kFewest = 5, kExamined = 4096;  // rows, bytes
  std::string_view begin = text.substr(0, kExamined);
  if (text.size() >= kExamined) begin = begin.substr(0, begin.rfind('\n') + 1);
  std::map<std::string, std::pair<std::size_t, LabelledRow>> kinds;  // number and last one, by header
  std::size_t lines = 0;
  ForEachLineOf(begin, [&](std::string_view line) {
    LabelledRow row = RowOf(SplitStamp(line).rest);
    lines += line.find_first_not_of(kBlanks) != std::string_view::npos ? 1 : 0;
    if (row.empty()) return;
    auto& [count, last] = kinds[HeaderOf(row)];
    ++count;
    last = std::move(row);
  });
  for (const auto& [header, kind] : kinds) {
    // Lines with one label each may be two halves of a row.
    const bool is_usual = kind.second.size() == 1 ? 10 * kind.first > 9 * lines : 2 * kind.first > lines;
    if (kind.first >= kFewest && is_usual) return kind.second;
  }
  return {};
}

}  // namespace

bool HasLabelledRows(std::string_view begin) { return !FindTypicalRow(begin).empty(); }

Result<std::string> TableOfLabelledRows(std::string_view text, const std::string& name) {
  const LabelledRow typical = FindTypicalRow(text);
  const std::string header = HeaderOf(typical);
  std::string table;
  std::optional<Status> error;
  std::size_t number = 0;
  bool has_header = false;
  ForEachLineOf(text, [&](std::string_view line) {
    ++number;
    const auto [stamp, rest] = SplitStamp(line);
    const LabelledRow row = RowOf(rest);
    const bool is_row = !row.empty() && HeaderOf(row) == header;
    if (is_row && !std::exchange(has_header, true)) table.append(stamp).append(header).append("\n");
    const bool has_labels = std::ranges::equal(row, typical, {}, &LabelledValue::label, &LabelledValue::label);
    if (!is_row && !row.empty() && has_labels && !error) {
      error = Fault(name + ":" + std::to_string(number),
                    "the units of " + Quoted(rest) + " are not those of the other rows; give all rows one unit")
                  .value();
    }
    table.append(stamp).append(is_row ? ValuesOf(row) : rest).append("\n");
  });
  if (error) return tl::unexpected(*error);
  return table;
}

}  // namespace pendulum::csv
