// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/table.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "recording/readers/columns/several_quantities.h"

namespace pendulum::csv {
namespace {

/// The length of a vector has no sign, so it oscillates twice as fast as the angle.
bool IsLengthOfVector(const TableColumn& column) {
  const NameMeaning meaning = MeaningOf(column.meaning);
  if (!meaning.Has("absolute")) return false;
  return meaning.kind == Kind::kRate || meaning.kind == Kind::kAcceleration || meaning.kind == Kind::kLength;
}

/// The run whose columns are read; std::nullopt if ChooseColumns must report the error.
Result<std::optional<std::string>> ChooseRun(const Line& line, const std::vector<TableColumn>& columns,
                                             const ReadOptions& options) {
  for (const std::string& flag : {options.value_column, TimeFlagOf(columns, options.time_column).column}) {
    const std::size_t chosen = flag.empty() ? columns.size() : IndexOf(columns, flag);
    if (chosen < columns.size() && !columns[chosen].run.empty()) return columns[chosen].run;
  }
  if (!options.value_column.empty()) return std::nullopt;
  const std::vector<std::size_t> candidates = CandidatesOf(columns, options.unit);
  std::set<std::string_view> runs;
  for (const std::size_t i : candidates) runs.insert(columns[i].run);
  if (runs.size() == 1) return columns[candidates.front()].run;
  if (candidates.empty()) return std::nullopt;
  std::vector<std::string> names;
  names.reserve(candidates.size());
  const bool is_one_each = runs.size() == candidates.size();
  for (const std::size_t i : candidates) {
    if (is_one_each || columns[i].run == columns[candidates.front()].run) names.push_back(Quoted(columns[i].written));
  }
  const std::string sentence = is_one_each ? "columns " + SeveralQuantities(names)
                                           : "columns of " + std::to_string(runs.size()) +
                                                 " runs could be the quantity; choose one with --value_column, of the "
                                                 "first run " +
                                                 ListWithAnd(names);
  return WithTry(line.Fault(columns[candidates[1]].at, sentence),
                 {"--value_column " + columns[candidates.front()].written});
}

}  // namespace

std::size_t IndexOf(const std::vector<TableColumn>& columns, const std::string& name) {
  const auto found = std::ranges::find(columns, name, &TableColumn::written);
  if (found != columns.end()) return found - columns.begin();
  return ColumnOfNumber(name, columns.size()).value_or(columns.size());
}

TimeFlag TimeFlagOf(const std::vector<TableColumn>& columns, const std::string& time_column) {
  const std::size_t colon = time_column.rfind(':');
  if (colon == std::string::npos || IndexOf(columns, time_column) < columns.size()) return {time_column};
  const Unit* unit = UnitOfSuffix(time_column.substr(colon + 1));
  if (unit == nullptr || unit->kind != Kind::kTime) return {time_column};
  return {time_column.substr(0, colon), unit};
}

std::vector<std::size_t> CandidatesOf(const std::vector<TableColumn>& columns, const std::string& unit) {
  std::vector<std::size_t> candidates, others, asked, without_unit;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const NameMeaning meaning = MeaningOf(columns[i].meaning);
    if (!meaning.kind || meaning.kind == Kind::kTime || meaning.is_secondary || IsLengthOfVector(columns[i])) continue;
    const bool is_other = meaning.kind == Kind::kAcceleration || meaning.kind == Kind::kLength;
    (meaning.unit == nullptr ? without_unit : is_other ? others : candidates).push_back(i);
    if (meaning.unit != nullptr && meaning.unit == UnitOfText(unit)) asked.push_back(i);
  }
  for (const auto* list : {&asked, &candidates, &others}) {
    if (!list->empty()) return *list;
  }
  return without_unit;
}

std::set<std::string_view> RunsOf(const std::vector<TableColumn>& columns) {
  std::set<std::string_view> runs;
  for (const TableColumn& column : columns) runs.insert(column.run);
  runs.erase("");
  return runs;
}

Result<std::vector<Name>> NamesOf(const Line& line, const std::vector<TableColumn>& columns,
                                  const ReadOptions& options) {
  const std::size_t chosen = options.value_column.empty() ? columns.size() : IndexOf(columns, options.value_column);
  if (chosen < columns.size() && IsLengthOfVector(columns[chosen])) {
    return line.Fault(columns[chosen].at,
                      "column " + Quoted(columns[chosen].written) +
                          " is the length of a vector, which does not contain the sign of the swing; choose one of the "
                          "vector's components with --value_column",
                      StatusCode::kInvalidArgument);
  }
  std::optional<std::string> run;
  if (RunsOf(columns).size() > 1) {
    ASSIGN_OR_RETURN(auto one, ChooseRun(line, columns, options));
    run = std::move(one);
  }
  const std::string flag = TimeFlagOf(columns, options.time_column).column;
  const std::size_t time = flag.empty() ? columns.size() : IndexOf(columns, flag);
  std::vector<Name> names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const TableColumn& column = columns[i];
    const bool is_other_run = run && !column.run.empty() && column.run != *run && i != time;
    const bool has_no_meaning = column.meaning.empty() && !column.written.empty();
    const bool is_hidden = is_other_run || has_no_meaning || IsLengthOfVector(column);
    const std::string_view meaning = is_hidden ? std::string_view() : std::string_view(column.meaning);
    names.push_back({meaning, column.at, column.written, is_hidden});
  }
  return names;
}

}  // namespace pendulum::csv
