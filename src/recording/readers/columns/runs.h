// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/table.h"

/// Several runs side by side. Logger Pro and Graphical Analysis name their columns "Run 1: Time (s)", "Latest: Angle
/// (rad)" or "Data Set 1:Time(s)", Capstone "Time (s) Run #1".
namespace pendulum::csv {

/// Converts a name to our form of header. The programs above write `V` for volts and superscript digits.
inline std::string PlainUnits(std::string_view name) {
  std::string plain(name);
  for (const auto& [theirs, ours] : {std::pair{"\u00B2", "2"}, {"(V)", "(volts)"}}) {
    for (std::size_t at = 0; (at = plain.find(theirs, at)) != std::string::npos;) {
      plain.replace(at, std::string_view(theirs).size(), ours);
    }
  }
  return plain;
}

/// A name split into the run, if it contains one, and the remaining name.
struct RunName {
  std::string_view run, rest;
};

inline RunName SplitRun(std::string_view name) {
  constexpr std::string_view kRun = " Run ";
  constexpr std::string_view kNumber = "#0123456789";
  const std::size_t colon = name.find(':');
  if (colon != std::string_view::npos) return {Trim(name.substr(0, colon)), Trim(name.substr(colon + 1))};
  const std::size_t at = name.rfind(kRun);
  if (at == std::string_view::npos) return {{}, name};
  const std::string_view number = name.substr(at + kRun.size());
  if (number.empty() || number.find_first_not_of(kNumber) != std::string_view::npos) return {{}, name};
  std::string_view rest = Trim(name.substr(0, at));
  if (rest.ends_with(',')) rest.remove_suffix(1);
  return {Trim(name.substr(at)), Trim(rest)};
}

/// Separates runs and columns if the name of a time contains a run. Returns whether it does.
inline bool SplitRuns(std::vector<TableColumn>& columns) {
  const auto is_time_of_run = [](const TableColumn& column) {
    const auto [run, rest] = SplitRun(column.written);
    return !run.empty() && IsTime(rest);
  };
  if (std::ranges::none_of(columns, is_time_of_run)) return false;
  for (TableColumn& column : columns) {
    const auto [run, rest] = SplitRun(column.written);
    column.run = run;
    column.meaning = PlainUnits(rest);
  }
  return true;
}

}  // namespace pendulum::csv
