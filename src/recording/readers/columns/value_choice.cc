// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/value_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "recording/readers/columns/point_choice.h"
#include "recording/readers/columns/swing_choice.h"
#include "recording/readers/columns/unit_guess.h"

namespace pendulum::csv {
namespace {

bool IsCandidate(const Choice& choice, std::size_t index) {
  if (index == choice.time) return false;
  if (choice.names.empty()) return true;
  if (choice.names[index].is_hidden) return false;
  const NameMeaning& meaning = choice.Meaning(index);
  return !meaning.is_secondary && !meaning.has_other_unit && meaning.kind != Kind::kTime;
}

/// The columns that may be the quantity, those that are preferred first. With --unit, only those in this unit or
/// without a unit.
std::vector<Columns> CandidateClasses(const Choice& choice, bool has_unit_flag) {
  struct Class {
    std::optional<Kind> kind;
    bool has_unit;
  };
  constexpr std::array kOrder = {
      Class{Kind::kAngle, true},        Class{Kind::kRate, true},   Class{Kind::kRaw, true},
      Class{Kind::kAngle, false},       Class{Kind::kRate, false},  Class{Kind::kRaw, false},
      Class{Kind::kAcceleration, true}, Class{Kind::kLength, true}, Class{Kind::kAcceleration, false},
      Class{Kind::kLength, false},      Class{std::nullopt, false},
  };
  std::vector<Columns> classes(kOrder.size() + 1);  // The first one: those that the user's unit or calibration selects.
  for (std::size_t i = 0; i < choice.layout.width; ++i) {
    if (!IsCandidate(choice, i)) continue;
    const NameMeaning& meaning = choice.Meaning(i);
    const bool has_unit = meaning.unit != nullptr;
    const bool is_asked = has_unit && has_unit_flag && meaning.unit == UnitOfText(choice.options.unit);
    const bool is_calibrated = has_unit && !has_unit_flag && meaning.unit->name == choice.table.raw_input;
    if (is_asked || is_calibrated) {
      classes.front().push_back(i);
      continue;
    }
    if (has_unit_flag && has_unit) continue;
    const auto* const found = std::ranges::find_if(
        kOrder, [&](const Class& each) { return each.kind == meaning.kind && each.has_unit == has_unit; });
    if (found != kOrder.end()) classes[found - kOrder.begin() + 1].push_back(i);
  }
  std::erase_if(classes, [](const Columns& columns) { return columns.empty(); });
  return classes;
}

/// Names the columns of numbers that were not chosen although they may be a quantity.
void WarnOfOthers(Choice& choice, std::size_t chosen, std::span<const Columns> classes) {
  std::vector<std::string> names;
  for (const Columns& columns : classes) {
    for (const std::size_t i : columns) {
      if (choice.IsNumeric(i) && choice.Meaning(i).kind) names.push_back(choice.NameOf(i));
    }
  }
  if (names.empty()) return;
  choice.Assume({.code = "value_column_assumed",
                 .finding = "column " + choice.NameOf(chosen) + " was used, not " + ListWithAnd(names),
                 .advice = "--value_column chooses another",
                 .flags = {"value_column"},
                 .assumed = "value column " + choice.NameOf(chosen) + " (--value_column)"});
}

/// The error for --value_column combined without axes that turn about one fixed axis.
tl::unexpected<Status> NoRotation(const Choice& choice, std::size_t index) {
  return choice.WrongFlag(index,
                          "--value_column combined needs two or three gyro axes in one unit that turn about one fixed "
                          "axis; name one column");
}

void KeepRates(const Choice& choice, std::vector<Columns>& classes) {
  for (Columns& columns : classes) {
    std::erase_if(columns, [&](std::size_t i) { return KindOf(choice, i) != Kind::kRate; });
  }
  std::erase_if(classes, [](const Columns& columns) { return columns.empty(); });
}

/// The column of the quantity; std::nullopt if the user must be asked.
Result<std::optional<std::size_t>> ChooseByName(Choice& choice) {
  if (!choice.options.value_column.empty() && !WantsCombination(choice)) {
    if (const auto point = FindNamedPoint(choice)) {
      choice.vertical = point->vertical;
      return point->horizontal;
    }
    ASSIGN_OR_RETURN(const std::size_t index, choice.FindColumn("--value_column", choice.options.value_column));
    return index;
  }
  std::vector<Columns> classes = CandidateClasses(choice, !choice.options.unit.empty());
  if (classes.empty()) classes = CandidateClasses(choice, false);  // The flag contradicts the only candidates.
  if (WantsCombination(choice)) {
    KeepRates(choice, classes);
    if (classes.empty()) return NoRotation(choice, 0);
  }
  const bool is_only = classes.size() == 1 && classes.front().size() == 1;
  if (is_only && !(choice.names.empty() && choice.layout.width > 1)) return classes.front().front();
  // Columns that swing come first; if none does, the first numbers that may be a quantity.
  for (const bool must_swing : {true, false}) {
    for (std::size_t i = 0; i < classes.size() && choice.questions.empty(); ++i) {
      if (const auto point = FindPoint(choice, classes[i])) return *point;
      auto chosen = ChooseBySwing(choice, classes[i], must_swing);
      if (chosen && !*chosen) continue;
      if (chosen && classes[i].size() == 1) WarnOfOthers(choice, **chosen, std::span(classes).subspan(i + 1));
      return chosen;
    }
  }
  return std::nullopt;
}

/// Checks --unit against the unit in the name of the column.
Result<void> CheckUnitFlag(Choice& choice, std::size_t index) {
  const NameMeaning& meaning = choice.Meaning(index);
  const std::string column = "column " + choice.NameOf(index);
  if (meaning.unit != nullptr && meaning.second != nullptr && meaning.second != meaning.unit) {
    return choice.table.line.Fault(choice.PlaceOf(index),
                                   column + " names two units, " + std::string(meaning.second->Written()) + " and " +
                                       std::string(meaning.unit->Written()) + "; keep the unit of its values");
  }
  const Unit* asked = choice.options.unit.empty() ? nullptr : UnitOfText(choice.options.unit);
  if (!choice.options.unit.empty() && (asked == nullptr || asked->kind == Kind::kTime)) {
    return choice.WrongFlag(index,
                            "--unit is " + Quoted(choice.options.unit) + "; it must be " + std::string(kValueUnits));
  }
  const bool is_quantity = meaning.unit != nullptr && meaning.unit->kind != Kind::kTime;
  if (is_quantity && asked != nullptr && meaning.unit->kind != asked->kind) {
    return choice.WrongFlag(
        index, column + " is in " + std::string(meaning.unit->Written()) + ", so --unit " + choice.options.unit +
                   " contradicts it; leave the flag out, or choose another column with --value_column");
  }
  if (is_quantity && asked != nullptr && meaning.unit != asked) {
    const std::string used(asked->Written()), named(meaning.unit->Written());
    choice.Assume({.code = "unit_overridden",
                   .finding = column + " names " + named + ", but --unit says " + used + ", which was used",
                   .flags = {"unit"},
                   .assumed = "readings in " + used + ", as --unit says, not in " + named});
  }
  if (meaning.unit != nullptr && meaning.unit->kind == Kind::kTime && asked == nullptr) {
    return choice.table.line.Fault(
        choice.PlaceOf(index), column + " is in " + std::string(meaning.unit->Written()) +
                                   ", which is not a quantity of a swing; choose another with --value_column, or give "
                                   "its unit with --unit");
  }
  return {};
}

/// Whether the numbers may be an encoder's counts, which the name does not say.
bool IsEncoderOfWholeNumbers(const Choice& choice, std::size_t index) {
  const NameMeaning& meaning = choice.Meaning(index);
  if (!meaning.Has("encoder") && !meaning.Has("enc")) return false;
  const Eigen::VectorXd& numbers = choice.NumbersOf(index);
  // NaN, where a cell has no number, is not larger.
  return AreWhole(numbers) &&
         std::ranges::none_of(numbers, [](double value) { return std::abs(value) >= kMostDegrees; });
}

/// The numbers of an acceleration without a unit and of the other axes of its sensor; alone if there may be several
/// sensors.
std::vector<Eigen::VectorXd> AccelerationsBeside(const Choice& choice, std::size_t index) {
  constexpr std::size_t kAxes = 3;
  std::vector<Eigen::VectorXd> axes;
  for (std::size_t i = 0; i < choice.meanings.size(); ++i) {
    const bool is_axis = choice.Meaning(i).kind == Kind::kAcceleration && choice.Meaning(i).unit == nullptr;
    if (is_axis && IsCandidate(choice, i) && choice.IsNumeric(i)) axes.push_back(choice.NumbersOf(i));
  }
  return axes.size() > kAxes || axes.empty() ? std::vector{choice.NumbersOf(index)} : axes;
}

/// Whether `az` stands without `ax` and `ay`, so that it may be the azimuth.
bool IsLoneAz(const Choice& choice, std::size_t index) {
  return IsShortAcceleration(choice.Meaning(index)) && choice.Meaning(index).stem.ends_with('z') &&
         std::ranges::count_if(choice.meanings, IsShortAcceleration) == 1 &&
         UnitOfGravity({choice.NumbersOf(index)}).empty();
}

/// The unit of the quantity: from its name, the user, the file, or its numbers; nullptr if the user must be asked.
Result<const Unit*> ValueUnit(Choice& choice, std::size_t index) {
  const NameMeaning& meaning = choice.Meaning(index);
  if (!choice.options.unit.empty()) return UnitOfText(choice.options.unit);
  if (meaning.unit != nullptr) return meaning.unit;
  if (choice.vertical) {
    choice.Assume({.code = "value_unit_assumed",
                   .finding = "columns " + ListWithAnd(choice.NamesOf({index, *choice.vertical})) +
                              " do not give their unit and were assumed to be in px, which changes no angle",
                   .advice = "--unit says otherwise",
                   .flags = {"unit"}});
    return UnitOfSuffix("px");
  }
  if (!choice.table.value_unit.empty()) return UnitOfSuffix(choice.table.value_unit);
  if (!choice.table.raw_input.empty() && meaning.kind.value_or(Kind::kRaw) == Kind::kRaw) {
    return UnitOfText(choice.table.raw_input);
  }
  RETURN_IF_ERROR(choice.NeedNumbers());
  const double step = choice.layout.time ? MedianStep(choice.NumbersOf(choice.layout.time->index)) : 0;
  const double seconds = choice.layout.time ? choice.layout.time->unit->ToSi(step) : 0;
  const UnitGuess guess =
      GuessValueUnit(meaning.kind, choice.NumbersOf(index), seconds, AccelerationsBeside(choice, index));
  const std::string column = "column " + choice.NameOf(index) + " does not give its unit";
  if (!meaning.unknown_unit.empty()) {
    choice.Ask("column " + choice.NameOf(index) + " is in " + Quoted(meaning.unknown_unit) +
                   ", which is not a unit known here: convert the column, or give its unit with --unit (" +
                   std::string(kValueUnits) + ")",
               {}, "unit");
    return nullptr;
  }
  if (IsAxisOfThree(choice, index)) {
    const auto [x, y, z] = *FindAxes(choice.meanings);
    const std::string_view gravity = UnitOfGravity({choice.NumbersOf(x), choice.NumbersOf(y), choice.NumbersOf(z)});
    choice.Ask(column +
                   ", and x, y and z may be rates, accelerations or coordinates: give it with --unit (rad_s, "
                   "deg_s, m_s2, g, mg, m, px, ...)",
               {"--unit " + std::string(gravity.empty() ? "rad_s" : gravity)});
    return nullptr;
  }
  if (meaning.kind == Kind::kLength && meaning.Has("y") && meaning.stem.find_first_not_of(" y") == std::string::npos) {
    choice.Ask(column + ", and it may be a coordinate or an angle: give it with --unit (deg, rad, px, m, ...)",
               {"--unit " + std::string(HalfRange(choice.NumbersOf(index)) > 60 ? "px" : "deg")});
    return nullptr;
  }
  if (IsLoneAz(choice, index)) {
    const bool is_angle = HalfRange(choice.NumbersOf(index)) > kStandardGravity;
    choice.Ask(column + ", and it may be an acceleration or an azimuth: give it with --unit (m_s2, g, deg, rad, ...)",
               is_angle ? std::vector<std::string>{"--unit deg"} : std::vector<std::string>(), is_angle ? "" : "unit");
    return nullptr;
  }
  if (IsEncoderOfWholeNumbers(choice, index)) {
    choice.Ask(column + ", and the whole numbers of an encoder may be counts or degrees: give it with --unit",
               {"--unit counts"});
    return nullptr;
  }
  if (guess.unit.empty()) {
    std::vector<std::string> flags;
    if (!guess.example.empty()) flags.push_back("--unit " + guess.example);
    choice.Ask(column + guess.reason + ": give it with --unit (" + std::string(kValueUnits) + ")", flags,
               flags.empty() ? "unit" : "");
    return nullptr;
  }
  const std::string unit(UnitOfSuffix(guess.unit)->Written());
  choice.Assume({.code = "value_unit_assumed",
                 .finding = column + " and was assumed to be in " + unit + guess.reason,
                 .advice = "--unit says otherwise",
                 .flags = {"unit"},
                 .assumed = "readings in " + unit + " (--unit)"});
  choice.layout.is_unit_assumed = true;
  return UnitOfSuffix(guess.unit);
}

Column ColumnOf(const Choice& choice, std::size_t index, const Unit& unit) {
  const NameMeaning& meaning = choice.Meaning(index);
  const bool is_gyro = meaning.stem.find("gyro") != std::string::npos || meaning.Has("rate");
  const bool is_without_gravity = meaning.stem.find("linear") != std::string::npos ||
                                  meaning.stem.find("without g") != std::string::npos ||
                                  meaning.stem.find("without_g") != std::string::npos;
  return {index, choice.NameOf(index), &unit, is_gyro, is_without_gravity};
}

}  // namespace

Result<void> ChooseValue(Choice& choice) {
  ASSIGN_OR_RETURN(auto chosen, ChooseByName(choice));
  choice.value = chosen;
  if (!choice.value) {
    if (choice.questions.empty()) {
      const std::size_t last = choice.layout.width - 1;
      choice.AskForColumn("none of the columns " + choice.ColumnNames() +
                              " is an angle, a rate or another quantity of a swing by its name",
                          last);
    }
    return {};
  }
  if (WantsCombination(choice) && choice.axes.empty()) return NoRotation(choice, *choice.value);
  if (choice.value == choice.time) {
    return choice.WrongFlag(*choice.value,
                            "column " + choice.NameOf(*choice.value) +
                                " cannot be both the time and the quantity; choose another with --value_column");
  }
  return CheckCoordinates(choice);
}

Result<void> SetValue(Choice& choice) {
  if (!choice.value) {
    // The column that the user chooses may need a unit too. All questions are asked at once.
    const auto unit = choice.example ? ValueUnit(choice, *choice.example) : Result<const Unit*>(nullptr);
    return unit ? Result<void>() : tl::unexpected(unit.error());
  }
  RETURN_IF_ERROR(CheckUnitFlag(choice, *choice.value));
  ASSIGN_OR_RETURN(const Unit* unit, ValueUnit(choice, *choice.value));
  if (unit == nullptr) return {};
  choice.layout.value = ColumnOf(choice, *choice.value, *unit);
  for (const std::size_t axis : choice.axes) choice.layout.axes.push_back(ColumnOf(choice, axis, *unit));
  std::optional<std::size_t> vertical = choice.vertical;
  if (choice.options.value_column.empty() && !vertical) vertical = FindVertical(choice, *choice.value);
  if (vertical) choice.layout.second = Column{*vertical, choice.NameOf(*vertical), choice.layout.value.unit};
  return {};
}

}  // namespace pendulum::csv
