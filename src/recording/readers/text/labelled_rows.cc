// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/labelled_rows.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>
#include <vector>

#include "recording/readers/text/host_stamp.h"

namespace pendulum::csv {
namespace {

constexpr std::string_view kBlanks = " \t\r", kBetween = " \t\r,;|";

struct LabelledValue {
  std::string_view label, value, unit;
};

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

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
  if (label.empty() || !IsLetter(label.front()) || rest.empty() || (rest.front() != ':' && rest.front() != '='))
    return {};
  rest.remove_prefix(1);
  Skip(rest, kBlanks);
  text = rest;
  return label;
}

std::string_view TakeNumber(std::string_view& text) {
  const std::size_t sign = text.starts_with('+') ? 1 : 0;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data() + sign, text.data() + text.size(), number);
  if (error != std::errc() || !text.starts_with(std::string_view(text.data(), end))) return {};
  const std::string_view taken = text.substr(0, static_cast<std::size_t>(end - text.data()));
  text.remove_prefix(taken.size());
  return taken;
}

/// The values of a row; empty if a text has another form.
std::vector<LabelledValue> ValuesOf(std::string_view row) {
  std::vector<LabelledValue> values;
  for (Skip(row, kBetween); !row.empty(); Skip(row, kBetween)) {
    LabelledValue value;
    value.label = TakeLabel(row);
    value.value = TakeNumber(row);
    if (value.label.empty() || value.value.empty()) return {};
    Skip(row, kBlanks);
    std::string_view after = row;
    if (TakeLabel(after).empty()) value.unit = TakeUpTo(row, kBetween);
    values.push_back(value);
  }
  return values;
}

/// A line in two parts: the stamp of a serial monitor, if there is one, and the row.
struct StampedRow {
  std::string_view stamp, row;
};

StampedRow SplitStamp(std::string_view line) {
  const auto stamp = FindHostStamp(line);
  const std::string_view row = stamp ? stamp->rest : line;
  return {line.substr(0, line.size() - row.size()), row};
}

bool HaveSameLabels(const std::vector<LabelledValue>& values, const std::vector<LabelledValue>& others) {
  return std::ranges::equal(values, others, {}, &LabelledValue::label, &LabelledValue::label);
}

std::string NamesOf(const std::vector<LabelledValue>& values) {
  std::string names;
  for (const LabelledValue& value : values) {
    names.append(names.empty() ? "" : ",").append(value.label);
    if (!value.unit.empty()) names.append(" (").append(value.unit).append(")");
  }
  return names;
}

std::string RowOf(const std::vector<LabelledValue>& values) {
  std::string row;
  for (const LabelledValue& value : values) row.append(row.empty() ? "" : ",").append(value.value);
  return row;
}

/// Calls `take` with each line, without its end.
template <typename Take>
void ForEachLineOf(std::string_view text, const Take& take) {
  while (!text.empty()) {
    take(TakeUpTo(text, "\n"));
    if (!text.empty()) text.remove_prefix(1);
  }
}

}  // namespace

bool HasLabelledRows(std::string_view begin) {
  constexpr std::size_t kFewest = 5;
  std::vector<LabelledValue> first;
  std::size_t rows = 0, others = 0;
  ForEachLineOf(begin.substr(0, begin.rfind('\n') + 1), [&](std::string_view line) {
    const std::vector<LabelledValue> values = ValuesOf(SplitStamp(line).row);
    if (first.empty() && values.size() > 1) first = values;
    if (first.empty()) return;
    ++(HaveSameLabels(values, first) ? rows : others);
  });
  return rows >= kFewest && others < rows;
}

std::string TableOfLabelledRows(std::string_view text) {
  std::vector<LabelledValue> first;
  std::string table;
  ForEachLineOf(text, [&](std::string_view line) {
    const auto [stamp, row] = SplitStamp(line);
    const std::vector<LabelledValue> values = ValuesOf(row);
    if (first.empty() && values.size() > 1) {
      first = values;
      table.append(stamp).append(NamesOf(first)).append("\n");
    }
    const bool is_row = !first.empty() && HaveSameLabels(values, first);
    table.append(stamp).append(is_row ? RowOf(values) : row).append("\n");
  });
  return table;
}

}  // namespace pendulum::csv
