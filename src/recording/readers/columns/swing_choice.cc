// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/swing_choice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "recording/readers/columns/point_choice.h"
#include "recording/readers/columns/unit_guess.h"
#include "recording/swing_signature.h"

namespace pendulum::csv {
namespace {

using Eigen::Index;

std::string Percent(double share) { return NumberText(100 * share, 3) + " %"; }

Eigen::MatrixXd CovarianceOf(const Choice& choice, const Columns& columns, double period) {
  std::vector<Eigen::VectorXd> swings;
  for (const std::size_t i : columns) swings.push_back(choice.SwingOf(i));
  return SwingCovariance(swings, period);
}

/// Where words of a name are separated by an underscore, the same name with a blank.
std::string WithBlanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// Whether columns are the axes of one sensor: their units are equal, and their names differ only in the letter x, y or
/// z, alone or at the end of a word. "gyro1" and "gyro2" are two sensors, perhaps on one axis.
bool AreAxes(const Choice& choice, const Columns& columns) {
  const NameMeaning& first = choice.Meaning(columns.front());
  const std::string name = WithBlanks(first.stem);
  std::set<char> letters;
  std::size_t at = 0;  // Of the letter.
  for (const std::size_t i : columns) {
    if (i == columns.front()) continue;
    const std::string other = WithBlanks(choice.Meaning(i).stem);
    if (choice.Meaning(i).unit != first.unit || other.size() != name.size() || other == name) return false;
    if (letters.empty()) at = static_cast<std::size_t>(std::ranges::mismatch(name, other).in1 - name.begin());
    if (!other.starts_with(name.substr(0, at)) || !other.ends_with(name.substr(at + 1))) return false;
    letters.insert({name[at], other[at]});
  }
  const bool is_end_of_word = at + 1 >= name.size() || name[at + 1] < 'a' || name[at + 1] > 'z';
  const auto is_axis = [](char letter) { return letter >= 'x' && letter <= 'z'; };
  return is_end_of_word && letters.size() == columns.size() && std::ranges::all_of(letters, is_axis);
}

/// The positions of the candidates that do not show the same numbers as an earlier one, perhaps in another unit.
std::vector<Index> FindDistinct(const Eigen::MatrixXd& covariance) {
  constexpr double kSame = 0.01;
  std::vector<Index> rows;
  for (Index row = 0; row < covariance.rows(); ++row) {
    const bool is_copy = std::ranges::any_of(rows, [&](Index other) {
      const double own = covariance(row, row), before = covariance(other, other);
      return before > 0 && std::abs(own / before - 1) < kSame &&
             covariance(row, other) > (1 - kSame / 10) * std::sqrt(own * before);
    });
    if (!is_copy) rows.push_back(row);
  }
  return rows;
}

/// Whether columns are two or three axes of a gyro.
bool IsRotation(const Choice& choice, const Columns& columns) {
  return columns.size() > 1 && KindOf(choice, columns.front()) == Kind::kRate && AreAxes(choice, columns);
}

/// Combines the axes of a gyro to the rotation about one fixed axis if several show it. Returns false if the axes turn
/// about no fixed axis.
bool CombineAxes(Choice& choice, const Columns& axes, const Eigen::MatrixXd& covariance) {
  constexpr double kFixed = 0.95;  // Share of the variance about one axis.
  // Squared component along one of the gyro's axes. From here on the others may show no more than the sensor's
  // cross-axis sensitivity, and the axis alone is at most 1.5 % too small.
  constexpr double kAlong = 0.97;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Index last = covariance.rows() - 1;
  if (solver.eigenvalues()[last] < kFixed * solver.eigenvalues().sum()) return false;
  Eigen::VectorXd direction = solver.eigenvectors().col(last);
  Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  if (direction[largest] < 0) direction = -direction;
  choice.value = axes[largest];
  if (!WantsCombination(choice) && direction[largest] * direction[largest] > kAlong) return true;
  choice.layout.direction.resize(direction.size());
  choice.layout.direction[0] = direction[largest];
  std::string parts = NumberText(direction[largest], 3) + " " + choice.NameOf(*choice.value);
  for (Index i = 0, next = 1; i < direction.size(); ++i) {
    if (i == largest) continue;
    choice.axes.push_back(axes[i]);
    choice.layout.direction[next++] = direction[i];
    parts += (direction[i] < 0 ? " - " : " + ") + NumberText(std::abs(direction[i]), 3) + " " + choice.NameOf(axes[i]);
  }
  choice.Assume(
      {.code = "axes_combined",
       .finding = "the axes share the swing, so the rate about the fixed axis of the rotation was computed: " + parts,
       .advice = "--value_column " + ShellWord(choice.FlagValueOf(*choice.value)) + " uses this axis alone",
       .flags = {"value_column"},
       .assumed = "rate about the axis " + parts + " (--value_column)"});
  return true;
}

/// Asks for a column if the candidates belong to runs beside each other, each with its own time.
bool AskForRun(Choice& choice, const Columns& candidates) {
  const Columns times = choice.TimesByName();
  if (times.size() < 2 || !AreSeparated(times)) return false;
  std::set<std::size_t> runs;
  for (const std::size_t i : candidates) runs.insert(TimeBefore(times, i));
  if (runs.size() < 2) return false;
  choice.AskForColumn("the file holds " + std::to_string(runs.size()) +
                          " runs beside each other: " + ListWithAnd(choice.NamesOf(candidates)),
                      candidates.front());
  return true;
}

/// The candidates with numbers. Columns that `must_swing` do not increase as times do; otherwise only the first such
/// column is taken for the time.
Columns WithNumbers(const Choice& choice, const Columns& candidates, bool must_swing) {
  const auto may_be_time = [&](std::size_t i) { return choice.MayBeTime(i) && choice.IsIncreasing(i); };
  Columns numeric;
  std::ranges::copy_if(candidates, std::back_inserter(numeric),
                       [&](std::size_t i) { return choice.IsNumeric(i) && !choice.IsClock(i); });
  if (must_swing) {
    std::erase_if(numeric, may_be_time);
  } else if (!choice.time && choice.TimesByName().empty() && numeric.size() > 1 && may_be_time(numeric.front())) {
    numeric.erase(numeric.begin());
  }
  return numeric;
}

/// The longest period of the columns that swing noticeably, in rows; 0 if none swings. A component along the rod
/// oscillates twice as fast as the angle.
double RowsPerPeriod(const Choice& choice, const Columns& columns) {
  constexpr double kNoticeable = 0.2;  // Of the largest amplitude.
  std::vector<SwingSignature> signatures;
  double largest = 0, period = 0;
  for (const std::size_t i : columns) {
    const auto signature = FindSwingSignature(choice.SwingOf(i));
    if (!signature) continue;
    signatures.push_back(*signature);
    largest = std::max(largest, signature->amplitude);
  }
  for (const SwingSignature& signature : signatures) {
    if (signature.amplitude >= kNoticeable * largest) period = std::max(period, signature.rows_per_period);
  }
  return period;
}

/// Whether several columns swing, perhaps in different units, so that their sizes cannot be compared.
bool HaveSeveralSwings(const Choice& choice, const Columns& columns) {
  const auto swings = [&](std::size_t i) { return FindSwingSignature(choice.SwingOf(i)).has_value(); };
  return std::ranges::count_if(columns, swings) > 1;
}

/// Whether a flag or the file states the unit of the values.
bool HasStatedUnit(const Choice& choice) { return !choice.options.unit.empty() || !choice.table.value_unit.empty(); }

/// Whether columns whose names say nothing may be lengths: neither a flag nor the file says that they are not.
bool MayBeLengths(const Choice& choice) {
  const std::string& asked = choice.options.unit;
  const Unit* unit = asked.empty() ? UnitOfSuffix(choice.table.value_unit) : UnitOfText(asked);
  return unit == nullptr ? choice.table.raw_input.empty() : unit->kind == Kind::kLength;
}

/// The unit of acceleration in which two or three columns contain gravity; empty: none.
std::string_view GravityUnitOf(const Choice& choice, const Columns& columns) {
  constexpr std::size_t kAxes = 3;
  if (columns.size() < 2 || columns.size() > kAxes) return "";
  std::vector<Eigen::VectorXd> axes;
  for (const std::size_t i : columns) axes.push_back(choice.NumbersOf(i));
  return UnitOfMovingGravity(axes);
}

constexpr double kNoticeableShare = 0.2;

/// Of the axes of an accelerometer, the one across the rod, where gravity changes its sign: the one with the largest
/// share, if it is noticeable, among those that do not hold gravity at rest. Along the rod the swing has half its
/// period.
Index AxisAcross(const Choice& choice, const Columns& columns, const Eigen::VectorXd& shares) {
  constexpr double kHolds = 0.5;  // of gravity
  Eigen::VectorXd medians(shares.size());
  for (Index i = 0; i < medians.size(); ++i) {
    medians[i] = std::abs(MedianOf(choice.NumbersOf(columns[static_cast<std::size_t>(i)])));
  }
  const Eigen::Array<bool, Eigen::Dynamic, 1> is_across =
      medians.array() < kHolds * medians.norm() && shares.array() > kNoticeableShare;
  Index best = 0;
  if (is_across.any()) {
    is_across.select(shares.array(), 0).maxCoeff(&best);
  } else {
    shares.maxCoeff(&best);
  }
  return best;
}

/// The flag that names both coordinates.
std::string FlagOf(const Choice& choice, const Point& point) {
  return "--value_column " + choice.FlagValueOf(point.horizontal) + "," + choice.FlagValueOf(point.vertical);
}

/// Asks which of several columns that swing, and whose names say nothing, is the quantity; `best` carries the most.
void AskWhichSwing(Choice& choice, const Columns& columns, std::size_t best, const std::optional<Point>& point) {
  const std::string sentence =
      "several columns swing, and their names do not say which is an angle: " + ListWithAnd(choice.NamesOf(columns));
  const std::string gravity(HasStatedUnit(choice) ? "" : GravityUnitOf(choice, columns));
  if (gravity.empty()) return choice.AskForColumn(sentence, columns.front());
  const std::string column = "--value_column " + choice.FlagValueOf(best);
  choice.Ask(sentence + "; together they have the size of gravity in " + std::string(UnitOfSuffix(gravity)->Written()) +
                 ", so they may be accelerations: give " + column + " --unit " + gravity +
                 (point ? ", or " + FlagOf(choice, *point) + " for the coordinates of a point" : "") +
                 ", or choose another quantity with --value_column",
             {column, "--unit " + gravity});
}

/// Asks whether two columns a_x and a_y are accelerations or the coordinates of a point.
void AskWhetherPoint(Choice& choice, const Point& point) {
  const std::string horizontal = choice.FlagValueOf(point.horizontal);
  choice.Ask("columns " + ListWithAnd(choice.NamesOf({point.horizontal, point.vertical})) +
                 " lie on a circle, as the coordinates of a point do and accelerations do not: choose the point with " +
                 FlagOf(choice, point) + ", or give the unit of the accelerations with --value_column " + horizontal +
                 " --unit (g, m_s2, mg)",
             {FlagOf(choice, point)});
}

/// Takes two columns whose names say nothing for the coordinates of a point if that is clear; asks otherwise.
std::optional<std::size_t> ChoosePoint(Choice& choice, const Point& point) {
  const std::string both = "columns " + ListWithAnd(choice.NamesOf({point.horizontal, point.vertical}));
  const std::string one = "--value_column " + ShellWord(choice.FlagValueOf(point.horizontal));
  if (!point.is_clear) {
    choice.Ask(both + " may be the coordinates of a point: choose both with " + FlagOf(choice, point) +
                   ", or one quantity with " + one,
               {FlagOf(choice, point)});
    return std::nullopt;
  }
  choice.vertical = point.vertical;
  choice.Assume({.code = "value_column_assumed",
                 .finding = both + " lie on a circle and were used as the coordinates of a point",
                 .advice = one + " uses one alone",
                 .flags = {"value_column"},
                 .assumed = both + " as a point (" + one + ")"});
  return point.horizontal;
}

/// Chooses by the share of each column in the variance of the swing.
std::optional<std::size_t> ChooseByShare(Choice& choice, const Columns& candidates, double period) {
  constexpr double kMost = 0.8;
  const Eigen::MatrixXd all = CovarianceOf(choice, candidates, period);
  std::vector<Index> rows = FindDistinct(all);
  // Two axes that are both askew by 45 degrees show the same without being copies.
  if (IsRotation(choice, candidates)) {
    rows.resize(candidates.size());
    std::iota(rows.begin(), rows.end(), 0);
  }
  Columns columns;
  for (const Index row : rows) columns.push_back(candidates[static_cast<std::size_t>(row)]);
  if (columns.size() == 1) {
    Columns copies = candidates;
    std::erase(copies, columns.front());
    const std::string name = choice.NameOf(columns.front());
    choice.Assume(
        {.code = "value_column_assumed",
         .finding = "column " + name + " was used",
         .explanation = ListWithAnd(choice.NamesOf(copies)) + (copies.size() == 1 ? " shows" : " show") + " the same",
         .advice = "--value_column chooses another",
         .flags = {"value_column"},
         .assumed = "value column " + name + " (--value_column)"});
    return columns.front();
  }
  const Eigen::MatrixXd covariance = all(rows, rows);
  const Eigen::VectorXd shares = covariance.diagonal() / covariance.trace();
  const bool is_unknown = !choice.Meaning(columns.front()).kind;
  Index best = 0;
  shares.maxCoeff(&best);
  const bool is_gravity = !GravityUnitOf(choice, columns).empty();
  const bool is_acceleration = KindOf(choice, columns.front()) == Kind::kAcceleration;
  if (is_gravity && (is_acceleration || is_unknown)) best = AxisAcross(choice, columns, shares);
  const double share = shares[best];
  std::vector<std::string> others;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto row = static_cast<Index>(i);
    if (row != best) others.push_back(choice.NameOf(columns[i]) + " " + Percent(shares[row]));
  }
  const bool is_short =
      std::ranges::all_of(columns, [&](std::size_t i) { return IsShortAcceleration(choice.Meaning(i)); });
  const bool may_be_point = (is_unknown || is_short) && MayBeLengths(choice);
  const auto point = may_be_point ? FindPointOnArc(choice, columns, period) : std::nullopt;
  if (point && is_short && !is_gravity && point->is_exact && !point->is_about_origin) {
    AskWhetherPoint(choice, *point);
    return std::nullopt;
  }
  const bool is_no_acceleration = point && (point->is_exact || point->is_about_origin);
  if (point && is_unknown && (is_no_acceleration || !is_gravity)) return ChoosePoint(choice, *point);
  const bool may_be_any = is_unknown && !is_acceleration;
  if (may_be_any && (HaveSeveralSwings(choice, columns) || (is_gravity && !HasStatedUnit(choice)))) {
    AskWhichSwing(choice, columns, columns[best], point);
    return std::nullopt;
  }
  const bool is_rotation = IsRotation(choice, columns) && CombineAxes(choice, columns, covariance);
  if (is_rotation && !choice.axes.empty()) return choice.value;
  // One axis of an accelerometer is enough, because its direction is a parameter of the fit.
  const double least = !is_acceleration ? kMost : is_gravity ? kNoticeableShare : kMost / 2;
  if (is_rotation || share >= least) {
    const std::string name = choice.NameOf(columns[best]);
    choice.Assume({.code = "value_column_assumed",
                   .finding = "column " + name + " carries " + Percent(share) + " of the swing and was used, not " +
                              ListWithAnd(others),
                   .advice = std::string("--value_column chooses another") +
                             (is_rotation ? ", or 'combined' for a sensor that is mounted askew" : ""),
                   .flags = {"value_column"},
                   .assumed = "value column " + name + " (--value_column)"});
    return columns[best];
  }
  // Whether one axis is enough follows from the unit, which will be asked for.
  if (IsAxisOfThree(choice, columns[best]) && !HasStatedUnit(choice)) return columns[best];
  others.insert(others.begin(), choice.NameOf(columns[best]) + " " + Percent(share));
  choice.AskForColumn("no single column carries the swing: " + ListWithAnd(others), columns[best]);
  return std::nullopt;
}

}  // namespace

std::optional<Kind> KindOf(const Choice& choice, std::size_t index) {
  const NameMeaning& meaning = choice.Meaning(index);
  const Unit* const asked = choice.options.unit.empty() ? nullptr : UnitOfText(choice.options.unit);
  return meaning.unit == nullptr && asked != nullptr ? asked->kind : meaning.kind;
}

bool IsAxisOfThree(const Choice& choice, std::size_t index) {
  const auto axes = FindAxes(choice.meanings);
  return axes && std::ranges::find(*axes, index) != axes->end();
}

bool WantsCombination(const Choice& choice) {
  return choice.options.value_column == kCombined &&
         std::ranges::find(choice.names, kCombined, &Name::written) == choice.names.end();
}

Result<std::optional<std::size_t>> ChooseBySwing(Choice& choice, const Columns& candidates, bool must_swing) {
  constexpr std::size_t kMostCompared = 64;
  RETURN_IF_ERROR(choice.NeedNumbers());
  if (choice.NumbersOf(0).size() == 0) return candidates.front();  // The number of rows will be the error.
  if (AskForRun(choice, candidates)) return std::nullopt;
  const Columns numeric = WithNumbers(choice, candidates, must_swing);
  const double period = RowsPerPeriod(choice, numeric);
  if (period == 0 && must_swing) return std::nullopt;
  if (numeric.size() == 1) return numeric.front();
  if (numeric.empty()) {  // Without numbers, the rows of a column with a unit say what is wrong.
    const bool is_clear = !must_swing && candidates.size() == 1 && choice.Meaning(candidates.front()).unit != nullptr;
    return is_clear ? std::optional(candidates.front()) : std::nullopt;
  }
  if (numeric.size() > kMostCompared) {
    choice.AskForColumn(
        std::to_string(numeric.size()) + " columns could all be the quantity: " + ListWithAnd(choice.NamesOf(numeric)),
        numeric.front());
    return std::nullopt;
  }
  if (period > 0) return ChooseByShare(choice, numeric, period);
  choice.AskForColumn("columns " + ListWithAnd(choice.NamesOf(numeric)) + " could " +
                          (numeric.size() == 2 ? "both" : "all") +
                          " be the quantity, and none of them shows a swing by itself",
                      numeric.front());
  return std::nullopt;
}

}  // namespace pendulum::csv
