// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/runs.h"

/// A line of labels above the line of column names. In files of Tracker the labels are names of tracks; with several
/// tracks ("#multi:") each label is above the track's first column. In Capstone and SPARKvue, labels name runs.
namespace pendulum::csv {

/// Tracker's lengths are in metres unless the film was scaled otherwise. `r` is the length of
/// the vector (x, y). Angles and rates are in the unit chosen in Tracker, which it does not write.
inline std::string TrackerColumnMeaning(const std::string& name) {
  if (name == "x" || name == "y") return name + " (m)";
  if (name == "r") return "absolute r (m)";
  return PlainUnits(name);
}

inline bool HasNumber(std::string_view row, char separator) {
  Numbers numbers(separator != ',');
  for (FieldCutter fields(row, separator); !fields.done();) {
    double number = 0;
    if (numbers.Parse(Unquote(fields.Next()), number)) return true;
  }
  return false;
}

/// A label above times alone names no run: its columns become shared ones. Returns whether there was one.
inline bool ShareTimes(const std::vector<Name>& names, std::vector<TableColumn>& columns) {
  const auto has_reading = [&](std::string_view run) {
    return std::ranges::any_of(columns,
                               [&](const TableColumn& other) { return other.run == run && !IsTime(other.meaning); });
  };
  bool is_shared = false;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].run.empty() || has_reading(columns[i].run)) continue;
    columns[i].run.clear();
    columns[i].written = std::string(names[i].text);
    is_shared = true;
  }
  return is_shared;
}

/// The columns if the names have a line of labels above them, `first`; empty otherwise. `names` must contain only
/// names, one of them a time, and `third`, the line below, must contain numbers.
inline std::vector<TableColumn> LabelledColumns(std::string_view first, const std::vector<Name>& names,
                                                std::string_view third, char separator) {
  const auto is_name = [](const Name& name) { return name.text.empty() || IsName(name.text); };
  const auto is_time = [](const Name& name) { return IsTime(TrackerColumnMeaning(std::string(name.text))); };
  if (names.size() < 2 || !std::ranges::all_of(names, is_name) || std::ranges::none_of(names, is_time)) return {};
  if (!HasNumber(third, separator) || HasNumber(first, separator)) return {};
  std::vector<Name> labels = SplitHeader(first, separator == ' ' ? '\t' : separator);
  if (labels.size() > names.size()) labels.resize(names.size());
  const auto is_label = [](const Name& label) { return !label.text.empty(); };
  const bool has_one_label = std::ranges::count_if(labels, is_label) == 1;
  const bool is_tracker = std::ranges::none_of(names, [](const Name& name) { return IsTime(name.text); }) ||
                          std::ranges::any_of(names, [](const Name& name) { return name.text == "t"; });
  std::vector<TableColumn> columns;
  std::string run;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i < labels.size() && is_label(labels[i])) run = labels[i].text;
    const std::string name(names[i].text);
    const bool is_shared = has_one_label || run.empty() || name.empty();
    std::string written = is_shared ? "" : run;
    written += is_shared ? "" : ": ";
    written += name;
    columns.push_back(
        {written, is_tracker ? TrackerColumnMeaning(name) : PlainUnits(name), is_shared ? "" : run, names[i].at});
  }
  // An oscilloscope's `Label,pendulum` stands above its names and has nothing to do with them.
  if (ShareTimes(names, columns) && RunsOf(columns).size() < 2) return {};
  return columns;
}

}  // namespace pendulum::csv
