// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/time_choice.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/try.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/columns/unit_guess.h"

namespace pendulum::csv {
namespace {

using Eigen::Index;

void UseTime(Choice& choice, std::size_t index, const Unit& unit) {
  choice.time = index;
  choice.layout.time = Column{index, choice.NameOf(index), &unit};
}

/// Says that a column is taken as the time, and why: " was taken as the time, not t2".
void AssumeTime(Choice& choice, std::size_t index, const std::string& why) {
  const std::string column = "column " + choice.NameOf(index);
  choice.Assume({.code = "time_column_assumed",
                 .finding = column + why,
                 .advice = "--time_column chooses another",
                 .flags = {"time_column"},
                 .assumed = column + " is the time (--time_column)"});
}

/// The columns without a meaning whose numbers increase. A single one is assumed to be the time.
Columns TimesByNumbers(Choice& choice) {
  Columns times;
  for (std::size_t i = 0; i < choice.layout.width; ++i) {
    const bool is_hidden = i < choice.names.size() && choice.names[i].is_hidden;
    const bool is_free = i != choice.value && !is_hidden && choice.MayBeTime(i);
    if (is_free && choice.IsNumeric(i) && choice.IsIncreasing(i) && !choice.IsRowNumber(i)) times.push_back(i);
  }
  if (times.size() == 1) {
    AssumeTime(choice, times[0], " increases and was assumed to be the time");
  }
  return times;
}

Eigen::VectorXd SwingBeside(const Choice& choice) {
  return choice.value ? choice.SwingOf(*choice.value) : Eigen::VectorXd();
}

/// Whether the columns beside the times have together the size of gravity, as those of an accelerometer. It shows no
/// swing that takes minutes.
bool HasGravityBeside(const Choice& choice, std::size_t time) {
  constexpr std::size_t kAxes = 3;
  std::vector<Eigen::VectorXd> axes;
  for (std::size_t i = 0; i < choice.layout.width; ++i) {
    const NameMeaning& meaning = choice.Meaning(i);
    const bool may_be_axis =
        meaning.kind.value_or(Kind::kAcceleration) == Kind::kAcceleration && meaning.unit == nullptr;
    if (i != time && choice.IsNumeric(i) && may_be_axis) axes.push_back(choice.NumbersOf(i));
  }
  return axes.size() > 1 && axes.size() <= kAxes && !UnitOfMovingGravity(axes).empty();
}

/// Asks what a column counts whose numbers increase by 1.
void AskWhatIsCounted(Choice& choice, std::size_t index) {
  const std::string counts = "column " + choice.NameOf(index) + " increases by 1 in each row, so it counts ";
  const std::string unit = "--time_column " + ShellWord(choice.FlagValueOf(index) + ":s");
  const std::string rate = "--sample_rate_hz (in Hz) and --time_column none";
  if (MaySecondsCount(SwingBeside(choice))) {
    choice.Ask(counts + "seconds, rows or milliseconds: give the unit with " + unit +
                   " and --gravity linear, or with :ms, or the rate of the rows with " + rate,
               {unit, "--gravity linear"});
    return;
  }
  choice.Ask(counts + "rows, seconds or milliseconds: give the rate of the rows with " + rate + ", or the unit with " +
                 unit + " or :ms",
             {}, "sample_rate_hz");
}

/// Whether the unit of times must be asked for: the name has an unknown one, or the column may count rows.
bool AskForTimeUnit(Choice& choice, std::size_t index) {
  const std::string column = "column " + choice.NameOf(index);
  const std::string flag = "--time_column " + choice.FlagValueOf(index);
  if (const std::string& unknown = choice.Meaning(index).unknown_unit; !unknown.empty()) {
    choice.Ask(column + " is in " + Quoted(unknown) + ", which is not a unit known here: convert the column, or give " +
                   "its unit with " + flag + ":s, :ms or :us",
               {}, "time_column");
    return true;
  }
  if (!choice.IsRowNumber(index)) return false;
  AskWhatIsCounted(choice, index);
  return true;
}

/// Finds the unit of times whose name does not give it.
Result<void> SetTimeUnit(Choice& choice, std::size_t index) {
  RETURN_IF_ERROR(choice.NeedNumbers());
  if (!choice.IsClock(index) && AskForTimeUnit(choice, index)) return {};
  if (choice.IsClock(index)) {
    choice.layout.is_clock = choice.layout.is_from_first = true;
    UseTime(choice, index, *UnitOfSuffix("s"));
    choice.Assume({.code = "times_of_day",
                   .finding = "column " + choice.NameOf(index) + " holds times of day",
                   .explanation = "times count from the first row",
                   .assumed = "column " + choice.NameOf(index) + " holds times of day (--time_column)"});
    return {};
  }
  TimeGuess guess = GuessTimeUnit(choice.NumbersOf(index), SwingBeside(choice));
  if (guess.unit.empty() && HasGravityBeside(choice, index)) guess = {"ms", " (an accelerometer shows a fast swing)"};
  if (guess.unit.empty()) {
    const std::string flag = "--time_column " + ShellWord(choice.FlagValueOf(index) + ":s");
    choice.Ask("column " + choice.NameOf(index) + " does not give its unit, and " + guess.reason + ": give it with " +
                   flag + " and --gravity linear, or with :ms",
               {"--time_column " + choice.FlagValueOf(index) + ":s", "--gravity linear"});
    return {};
  }
  choice.layout.is_from_first = guess.has_calendar_origin;
  UseTime(choice, index, *UnitOfSuffix(guess.unit));
  const std::string column = choice.FlagValueOf(index);
  const bool is_s = guess.unit == "s";
  const std::string others = ShellWord(column + (is_s ? ":ms" : ":s")) + (is_s ? " or :us" : "");
  choice.Assume({.code = "time_unit_assumed",
                 .finding = "column " + choice.NameOf(index) + " does not give its unit and was assumed to be in " +
                            std::string(guess.unit) + guess.reason,
                 .explanation = guess.has_calendar_origin ? "times count from the first row" : "",
                 .advice = "--time_column " + others + " says otherwise",
                 .flags = {"time_column"},
                 .assumed = "times in " + std::string(guess.unit) + " (--time_column " + others + ")"});
  return {};
}

Result<void> SetTime(Choice& choice, std::size_t index, const Unit* unit) {
  if (unit == nullptr) return SetTimeUnit(choice, index);
  UseTime(choice, index, *unit);
  return {};
}

}  // namespace

Result<void> FindNamedTime(Choice& choice) {
  if (choice.options.time_column.empty() || choice.options.time_column == "none") return {};
  if (choice.options.sample_rate_hz > 0) {
    return choice.WrongFlag(0, "--time_column and --sample_rate_hz both define the times; leave one of them out");
  }
  std::string_view name = choice.options.time_column;
  const std::size_t colon = name.rfind(':');
  const Unit* unit = nullptr;
  if (colon != std::string_view::npos && std::ranges::find(choice.names, name, &Name::written) == choice.names.end()) {
    unit = UnitOfSuffix(name.substr(colon + 1));
    if (unit != nullptr && unit->kind != Kind::kTime) unit = nullptr;
    if (unit != nullptr) name = name.substr(0, colon);
  }
  ASSIGN_OR_RETURN(const std::size_t index, choice.FindColumn("--time_column", name));
  const Unit* own = index < choice.names.size() ? FindTimeUnit(choice.names[index].text) : nullptr;
  if (unit != nullptr && own != nullptr && unit != own) {
    const std::string used(unit->name), named(own->name);
    choice.Assume({.code = "unit_overridden",
                   .finding = "column " + choice.NameOf(index) + " names " + named + ", but --time_column says " +
                              used + ", which was used",
                   .flags = {"time_column"},
                   .assumed = "times in " + used + ", as --time_column says, not in " + named});
  }
  choice.time = index;
  if (unit == nullptr) unit = own;
  if (unit != nullptr) UseTime(choice, index, *unit);
  return {};
}

Result<void> ChooseTime(Choice& choice) {
  const bool has_asked_rate = choice.options.sample_rate_hz > 0;
  if (choice.options.time_column == "none") {
    if (choice.table.has_rate || has_asked_rate || choice.table.has_host) return {};
    return choice.WrongFlag(0, "with --time_column none there are no times; give --sample_rate_hz");
  }
  if (choice.time) return choice.layout.time ? Result<void>() : SetTimeUnit(choice, *choice.time);
  Columns times = choice.TimesByName();
  if (!times.empty() && has_asked_rate) {
    return choice.WrongFlag(times[0],
                            "column " + choice.NameOf(times[0]) + " holds the times, so --sample_rate_hz " +
                                NumberText(choice.options.sample_rate_hz) +
                                " contradicts it; leave the flag out, or add --time_column none to ignore the column");
  }
  const bool has_other = choice.table.has_rate || choice.table.has_host;
  if (!has_asked_rate && times.empty() && choice.table.has_rate && choice.table.is_rate_weak) {
    RETURN_IF_ERROR(choice.NeedNumbers());
    times = TimesByNumbers(choice);
  }
  if (has_asked_rate || (times.empty() && has_other)) return {};
  if (times.size() > 1 && AreSeparated(times) && choice.value) times = {TimeBefore(times, *choice.value)};
  if (times.size() == 1 && choice.Meaning(times[0]).unit != nullptr && !choice.names[times[0]].is_hidden) {
    return SetTime(choice, times[0], choice.Meaning(times[0]).unit);
  }
  RETURN_IF_ERROR(choice.NeedNumbers());
  std::erase_if(times,
                [&](std::size_t i) { return !choice.IsNumeric(i) || (times.size() > 1 && !choice.IsIncreasing(i)); });
  if (times.empty()) times = TimesByNumbers(choice);
  if (times.empty()) {
    std::string none = choice.names.empty() ? "no column increases as a time does"
                                            : "none of the columns " + choice.ColumnNames() + " is a time";
    for (std::size_t i = 0; i < choice.layout.width; ++i) {
      const bool counts = choice.layout.width > 1 && choice.IsNumeric(i) && choice.IsRowNumber(i);
      if (counts) none = "column " + choice.NameOf(i) + " counts the rows, and none is a time";
    }
    choice.Ask(none + ": give the rate of the rows in Hz with --sample_rate_hz, or the column with --time_column", {},
               "sample_rate_hz");
    return {};
  }
  const auto has_unit = [&](std::size_t i) { return choice.Meaning(i).unit != nullptr; };
  const auto known = std::ranges::find_if(times, has_unit);
  const std::size_t chosen = known != times.end() ? *known : times.front();
  if (times.size() > 1) {
    AssumeTime(choice, chosen, " was taken as the time, not " + choice.NameOf(times[chosen == times.front() ? 1 : 0]));
  }
  return SetTime(choice, chosen, choice.Meaning(chosen).unit);
}

}  // namespace pendulum::csv
