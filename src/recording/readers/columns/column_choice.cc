// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/column_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include <Eigen/Eigenvalues>

#include "recording/readers/columns/name_list.h"
#include "recording/readers/columns/unit_guess.h"
#include "recording/swing_signature.h"

namespace pendulum::csv {
namespace {

using Eigen::Index;

/// Splits a header at blanks, except those before or inside brackets.
std::vector<Name> SplitAtBlanks(std::string_view header) {
  std::vector<Name> names;
  header = Trim(header);
  int depth = 0;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= header.size(); ++i) {
    const bool is_end = i == header.size();
    if (!is_end && header[i] == '"') is_quoted = !is_quoted;
    if (!is_end && (header[i] == '(' || header[i] == '[')) ++depth;
    if (!is_end && (header[i] == ')' || header[i] == ']')) --depth;
    if (!is_end && (!IsBlank(header[i]) || depth > 0 || is_quoted)) continue;
    const std::size_t next = std::min(header.find_first_not_of(" \t", i), header.size());
    if (next < header.size() && (header[next] == '(' || header[next] == '[')) continue;
    names.push_back({Unquote(header.substr(begin, i - begin)), header.data() + begin});
    begin = next;
    i = next;
  }
  return names;
}

std::string Percent(double share) { return NumberText(100 * share, 3) + " %"; }

/// The value of --value_column for the axes of a gyro together.
constexpr std::string_view kCombined = "combined";

/// Chooses the columns of one table.
class ColumnChooser {
 public:
  ColumnChooser(const TableView& table, const ReadOptions& options, Layout& layout, std::vector<Warning>& warnings)
      : table_(table), names_(table.names), options_(options), layout_(layout), warnings_(warnings) {}

  Result<void> Choose();

 private:
  using Columns = std::vector<std::size_t>;

  // Names and messages.
  std::string NameOf(std::size_t index) const;
  std::vector<std::string> NamesOf(const Columns& columns) const;
  std::string FlagValueOf(std::size_t index) const;
  const char* PlaceOf(std::size_t index) const;
  std::string ColumnNames() const;
  NameMeaning Meaning(std::size_t index) const;
  tl::unexpected<Status> WrongFlag(std::size_t index, const std::string& sentence) const;
  Result<std::size_t> FindColumn(const std::string& flag, std::string_view name) const;
  void Assume(const std::string& code, const std::string& sentence) {
    warnings_.push_back({code, std::string(table_.line.file) + ": " + sentence});
  }
  void Ask(const std::string& sentence, const std::vector<std::string>& flags);
  Result<void> Answer(std::size_t place) const;

  // Numbers.
  Result<void> NeedNumbers();
  const Eigen::VectorXd& NumbersOf(std::size_t index) const { return numbers_->columns[index]; }
  bool IsNumeric(std::size_t index) const;
  Eigen::VectorXd SwingOf(std::size_t index) const;

  // The time.
  Result<void> FindNamedTime();
  Columns TimesByName() const;
  Columns TimesByNumbers();
  bool IsIncreasing(std::size_t index) const;
  bool IsRowNumber(std::size_t index) const;
  bool AreSeparated(const Columns& times) const;
  std::size_t TimeBefore(const Columns& times, std::size_t value) const;
  Result<void> ChooseTime();
  Result<void> SetTime(std::size_t index, const Unit* unit);
  Result<void> SetTimeUnit(std::size_t index);
  void UseTime(std::size_t index, const Unit& unit);

  // The quantity.
  bool IsCandidate(std::size_t index) const;
  std::vector<Columns> CandidateClasses(bool has_unit_flag) const;
  Result<std::optional<std::size_t>> ChooseByName();
  bool AskForRun(const Columns& candidates);
  Columns WithNumbers(const Columns& candidates, bool must_swing) const;
  double RowsPerPeriod(const Columns& columns) const;
  Eigen::MatrixXd CovarianceOf(const Columns& columns, double period) const;
  Result<std::optional<std::size_t>> ChooseBySwing(const Columns& candidates, bool must_swing);
  std::optional<std::size_t> ChooseByShare(const Columns& candidates, double period);
  void WarnOfOthers(std::size_t chosen, std::span<const Columns> classes);
  Columns WithoutCopies(const Columns& candidates, const Eigen::MatrixXd& covariance) const;
  bool CombineAxes(const Columns& axes, const Eigen::MatrixXd& covariance);
  std::optional<std::size_t> FindVertical(std::size_t horizontal) const;
  std::optional<std::size_t> FindPoint(const Columns& candidates) const;
  Result<void> CheckCoordinate(std::size_t index) const;
  Result<void> ChooseValue();
  Result<void> CheckUnitFlag(std::size_t index) const;
  Result<void> SetValue();
  Result<const Unit*> ValueUnit(std::size_t index);
  Column ColumnOf(std::size_t index, const Unit& unit) const;

  const TableView& table_;
  const std::vector<Name>& names_;
  const ReadOptions& options_;
  Layout& layout_;
  std::vector<Warning>& warnings_;
  std::optional<TableNumbers> numbers_;
  std::optional<std::size_t> time_;   // The column of times, if the user named it or it has been chosen.
  std::optional<std::size_t> value_;  // The column of the quantity.
  Columns axes_;                      // The other axes of a rotation.
  bool wants_combination_ = false;    // By the user: the axes of a gyro together.
  std::vector<std::string> questions_, flags_;
};

// ---- Names and messages -------------------------------------------------------------------------------------------

std::string ColumnChooser::NameOf(std::size_t index) const {
  return index < names_.size() ? Quoted(names_[index].written) : std::to_string(index + 1);
}

std::vector<std::string> ColumnChooser::NamesOf(const Columns& columns) const {
  std::vector<std::string> names;
  for (const std::size_t i : columns) names.push_back(NameOf(i));
  return names;
}

/// The column as a flag names it: its name, or its number if it has none of its own.
std::string ColumnChooser::FlagValueOf(std::size_t index) const {
  const bool is_unique = index < names_.size() && !names_[index].written.empty() &&
                         std::ranges::count(names_, names_[index].written, &Name::written) == 1;
  return is_unique ? std::string(names_[index].written) : std::to_string(index + 1);
}

const char* ColumnChooser::PlaceOf(std::size_t index) const {
  return index < names_.size() ? names_[index].at : table_.line.text.data();
}

std::string ColumnChooser::ColumnNames() const {
  constexpr std::size_t kShown = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(names_.size(), kShown); ++i) list += (i == 0 ? "" : ", ") + NameOf(i);
  return list + (names_.size() > kShown ? ", ..." : "");
}

NameMeaning ColumnChooser::Meaning(std::size_t index) const {
  return index < names_.size() ? MeaningOf(names_[index].text) : NameMeaning{};
}

tl::unexpected<Status> ColumnChooser::WrongFlag(std::size_t index, const std::string& sentence) const {
  return table_.line.Fault(PlaceOf(index), sentence, StatusCode::kInvalidArgument);
}

/// Finds a column by its name or its number.
Result<std::size_t> ColumnChooser::FindColumn(const std::string& flag, std::string_view name) const {
  const auto found = std::ranges::find(names_, name, &Name::written);
  if (found != names_.end()) return found - names_.begin();
  double number = 0;
  if (!ParseNumber(name, number) || number < 1 || number > static_cast<double>(layout_.width) ||
      number != static_cast<double>(static_cast<std::size_t>(number))) {
    const std::string count = std::to_string(layout_.width) + (layout_.width == 1 ? " column" : " columns");
    return WrongFlag(0, flag + " is " + Quoted(name) + ", which is none of the " + count +
                            (names_.empty() ? "; give its number, the first is 1"
                                            : " " + ColumnNames() + "; give a name, or a number from 1 on"));
  }
  return static_cast<std::size_t>(number) - 1;
}

/// Notes what the user must tell, and an example of the flags that tell it.
void ColumnChooser::Ask(const std::string& sentence, const std::vector<std::string>& flags) {
  questions_.push_back(sentence);
  flags_.insert(flags_.end(), flags.begin(), flags.end());
}

/// The error that lists all questions, if there are any.
Result<void> ColumnChooser::Answer(std::size_t place) const {
  if (questions_.empty()) return {};
  std::string sentence;
  for (const std::string& question : questions_) sentence += (sentence.empty() ? "" : "; ") + question;
  return WithTry(table_.line.Fault(PlaceOf(place), sentence), flags_);
}

// ---- Numbers ------------------------------------------------------------------------------------------------------

Result<void> ColumnChooser::NeedNumbers() {
  if (numbers_) return {};
  Result<TableNumbers> numbers = table_.numbers();
  if (!numbers) return tl::unexpected(std::move(numbers).error());
  numbers_ = *std::move(numbers);
  return {};
}

/// Whether most cells of a column are numbers.
bool ColumnChooser::IsNumeric(std::size_t index) const {
  const Eigen::VectorXd& numbers = NumbersOf(index);
  const Index count = numbers.array().isFinite().count();
  return count >= 2 && 20 * count > numbers.size();
}

// ---- The time -----------------------------------------------------------------------------------------------------

/// NAME or NUMBER, optionally with :s, :ms or :us.
Result<void> ColumnChooser::FindNamedTime() {
  if (options_.time_column.empty() || options_.time_column == "none") return {};
  if (options_.sample_rate_hz > 0) {
    return WrongFlag(0, "--time_column and --sample_rate_hz both define the times; leave one of them out");
  }
  std::string_view name = options_.time_column;
  const std::size_t colon = name.rfind(':');
  const Unit* unit = nullptr;
  if (colon != std::string_view::npos && std::ranges::find(names_, name, &Name::written) == names_.end()) {
    unit = UnitOfSuffix(name.substr(colon + 1));
    if (unit != nullptr && unit->kind != Kind::kTime) unit = nullptr;
    if (unit != nullptr) name = name.substr(0, colon);
  }
  const Result<std::size_t> index = FindColumn("--time_column", name);
  if (!index) return tl::unexpected(index.error());
  const Unit* own = *index < names_.size() ? FindTimeUnit(names_[*index].text) : nullptr;
  if (unit != nullptr && own != nullptr && unit != own) {
    return WrongFlag(*index, "column " + NameOf(*index) + " is in " + std::string(own->name) + ", but --time_column " +
                                 options_.time_column + " says " + std::string(unit->name) + "; leave out the unit");
  }
  time_ = *index;
  if (unit == nullptr) unit = own;
  if (unit != nullptr) UseTime(*index, *unit);
  return {};
}

void ColumnChooser::UseTime(std::size_t index, const Unit& unit) {
  time_ = index;
  layout_.time = Column{index, NameOf(index), &unit};
}

/// The columns whose names say that they are times.
ColumnChooser::Columns ColumnChooser::TimesByName() const {
  Columns times;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!names_[i].is_hidden && Meaning(i).kind == Kind::kTime) times.push_back(i);
  }
  return times;
}

/// Whether the numbers of a column never decrease, as times do.
bool ColumnChooser::IsIncreasing(std::size_t index) const {
  double last = -std::numeric_limits<double>::infinity(), first = last;
  for (const double number : NumbersOf(index)) {
    if (!std::isfinite(number)) continue;
    if (number < last) return false;
    if (!std::isfinite(first)) first = number;
    last = number;
  }
  return last > first;
}

/// Whether a column counts the rows: whole numbers that increase by 1.
bool ColumnChooser::IsRowNumber(std::size_t index) const {
  const Eigen::VectorXd& numbers = NumbersOf(index);
  for (Index i = 1; i < numbers.size(); ++i) {
    if (std::isfinite(numbers[i]) && std::isfinite(numbers[i - 1]) && numbers[i] - numbers[i - 1] != 1) return false;
  }
  return numbers.size() > 1 && numbers[0] == std::floor(numbers[0]);
}

/// Whether quantities lie between columns of times, so that each time belongs to a run beside the others.
bool ColumnChooser::AreSeparated(const Columns& times) const {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1] + 1) return true;
  }
  return false;
}

/// The last of the times before this column, otherwise the first.
std::size_t ColumnChooser::TimeBefore(const Columns& times, std::size_t value) const {
  const auto after = std::ranges::upper_bound(times, value);
  return after == times.begin() ? times.front() : *std::prev(after);
}

/// The only column without a meaning whose numbers increase, if there is one.
ColumnChooser::Columns ColumnChooser::TimesByNumbers() {
  Columns times;
  for (std::size_t i = 0; i < layout_.width; ++i) {
    const bool is_free = i != value_ && !(i < names_.size() && (names_[i].is_hidden || Meaning(i).kind));
    if (is_free && IsNumeric(i) && IsIncreasing(i) && !IsRowNumber(i)) times.push_back(i);
  }
  if (times.size() == 1) {
    Assume("time_column_assumed",
           "column " + NameOf(times[0]) + " increases and was assumed to be the time; --time_column chooses another");
  }
  return times;
}

Result<void> ColumnChooser::ChooseTime() {
  const bool has_asked_rate = options_.sample_rate_hz > 0;
  if (options_.time_column == "none") {
    if (table_.has_rate || has_asked_rate || table_.has_host) return {};
    return WrongFlag(0, "with --time_column none there are no times; give --sample_rate_hz");
  }
  if (time_) return layout_.time ? Result<void>() : SetTimeUnit(*time_);
  Columns times = TimesByName();
  if (!times.empty() && has_asked_rate) {
    return WrongFlag(times[0],
                     "column " + NameOf(times[0]) + " holds the times, so --sample_rate_hz " +
                         NumberText(options_.sample_rate_hz) +
                         " contradicts it; leave the flag out, or add --time_column none to ignore the column");
  }
  if (has_asked_rate || (times.empty() && (table_.has_rate || table_.has_host))) return {};
  if (times.size() > 1 && AreSeparated(times) && value_) times = {TimeBefore(times, *value_)};
  if (times.size() == 1 && Meaning(times[0]).unit != nullptr && !names_[times[0]].is_hidden) {
    return SetTime(times[0], Meaning(times[0]).unit);
  }
  if (Result<void> read = NeedNumbers(); !read) return read;
  std::erase_if(times, [&](std::size_t i) { return !IsNumeric(i) || (times.size() > 1 && !IsIncreasing(i)); });
  if (times.empty()) times = TimesByNumbers();
  if (times.empty()) {
    const std::string none =
        names_.empty() ? "no column increases as a time does" : "none of the columns " + ColumnNames() + " is a time";
    Ask(none + ": give the rate of the rows with --sample_rate_hz, or the column with --time_column",
        {"--sample_rate_hz 100"});
    return {};
  }
  const auto has_unit = [&](std::size_t i) { return Meaning(i).unit != nullptr; };
  const auto known = std::ranges::find_if(times, has_unit);
  const std::size_t chosen = known != times.end() ? *known : times.front();
  if (times.size() > 1) {
    Assume("time_column_assumed", "column " + NameOf(chosen) + " was taken as the time, not " +
                                      NameOf(times[chosen == times.front() ? 1 : 0]) +
                                      "; --time_column chooses another");
  }
  return SetTime(chosen, Meaning(chosen).unit);
}

Result<void> ColumnChooser::SetTime(std::size_t index, const Unit* unit) {
  if (unit == nullptr) return SetTimeUnit(index);
  UseTime(index, *unit);
  return {};
}

/// Finds the unit of times whose name does not give it.
Result<void> ColumnChooser::SetTimeUnit(std::size_t index) {
  if (Result<void> read = NeedNumbers(); !read) return read;
  if (numbers_->is_clock[index]) {
    layout_.is_clock = layout_.is_from_first = true;
    UseTime(index, *UnitOfSuffix("s"));
    Assume("times_of_day", "column " + NameOf(index) + " holds times of day; times count from the first row");
    return {};
  }
  const TimeGuess guess = GuessTimeUnit(NumbersOf(index), value_ ? SwingOf(*value_) : Eigen::VectorXd());
  layout_.is_from_first = guess.is_since_1970;
  UseTime(index, *UnitOfSuffix(guess.unit));
  const std::string column = FlagValueOf(index);
  const std::string others = guess.unit == "s" ? column + ":ms or :us" : column + ":s";
  Assume("time_unit_assumed", "column " + NameOf(index) + " does not give its unit and was assumed to be in " +
                                  std::string(guess.unit) + guess.reason +
                                  (guess.is_since_1970 ? "; times count from the first row" : "") + "; --time_column " +
                                  others + " says otherwise");
  return {};
}

// ---- The quantity -------------------------------------------------------------------------------------------------

bool ColumnChooser::IsCandidate(std::size_t index) const {
  if (index == time_) return false;
  if (names_.empty()) return true;
  if (names_[index].is_hidden) return false;
  const NameMeaning meaning = Meaning(index);
  return !meaning.is_secondary && !meaning.has_other_unit && meaning.kind != Kind::kTime;
}

/// The columns that may be the quantity, those that are preferred first. With --unit, only those in this unit or
/// without a unit.
std::vector<ColumnChooser::Columns> ColumnChooser::CandidateClasses(bool has_unit_flag) const {
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
  for (std::size_t i = 0; i < layout_.width; ++i) {
    if (!IsCandidate(i)) continue;
    const NameMeaning meaning = Meaning(i);
    const bool has_unit = meaning.unit != nullptr;
    const bool is_asked = has_unit && has_unit_flag && meaning.unit == UnitOfText(options_.unit);
    const bool is_calibrated = has_unit && !has_unit_flag && meaning.unit->name == table_.raw_input;
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

/// A column in SI units, as far as its unit is known.
Eigen::VectorXd ColumnChooser::SwingOf(std::size_t index) const {
  const Unit* unit = Meaning(index).unit;
  if (unit == nullptr) return NumbersOf(index);
  return NumbersOf(index).unaryExpr([unit](double number) { return unit->ToSi(number); });
}

Eigen::MatrixXd ColumnChooser::CovarianceOf(const Columns& columns, double period) const {
  std::vector<Eigen::VectorXd> swings;
  for (const std::size_t i : columns) swings.push_back(SwingOf(i));
  return SwingCovariance(swings, period);
}

/// The candidates without those that show the same numbers as an earlier one, perhaps in another unit.
ColumnChooser::Columns ColumnChooser::WithoutCopies(const Columns& candidates,
                                                    const Eigen::MatrixXd& covariance) const {
  constexpr double kSame = 0.01;
  Columns kept;
  std::vector<Index> rows;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto row = static_cast<Index>(i);
    const bool is_copy = std::ranges::any_of(rows, [&](Index other) {
      const double own = covariance(row, row), before = covariance(other, other);
      return before > 0 && std::abs(own / before - 1) < kSame &&
             covariance(row, other) > (1 - kSame / 10) * std::sqrt(own * before);
    });
    if (is_copy) continue;
    kept.push_back(candidates[i]);
    rows.push_back(row);
  }
  return kept;
}

/// Combines the axes of a gyro to the rotation about one fixed axis if several show it. Returns false if the axes turn
/// about no fixed axis.
bool ColumnChooser::CombineAxes(const Columns& axes, const Eigen::MatrixXd& covariance) {
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
  value_ = axes[largest];
  if (!wants_combination_ && direction[largest] * direction[largest] > kAlong) return true;
  layout_.direction.resize(direction.size());
  layout_.direction[0] = direction[largest];
  std::string parts = NumberText(direction[largest], 3) + " " + NameOf(*value_);
  for (Index i = 0, next = 1; i < direction.size(); ++i) {
    if (i == largest) continue;
    axes_.push_back(axes[i]);
    layout_.direction[next++] = direction[i];
    parts += (direction[i] < 0 ? " - " : " + ") + NumberText(std::abs(direction[i]), 3) + " " + NameOf(axes[i]);
  }
  Assume("axes_combined", "the axes share the swing, so the rate about the fixed axis of the rotation was computed: " +
                              parts + "; --value_column " + Quoted(FlagValueOf(*value_)) + " uses this axis alone");
  return true;
}

/// Asks for a column if the candidates belong to runs beside each other, each with its own time.
bool ColumnChooser::AskForRun(const Columns& candidates) {
  const Columns times = TimesByName();
  if (times.size() < 2 || !AreSeparated(times)) return false;
  std::set<std::size_t> runs;
  for (const std::size_t i : candidates) runs.insert(TimeBefore(times, i));
  if (runs.size() < 2) return false;
  Ask("the file holds " + std::to_string(runs.size()) + " runs beside each other: " + ListOf(NamesOf(candidates)) +
          "; choose one with --value_column",
      {"--value_column " + FlagValueOf(candidates.front())});
  return true;
}

/// The candidates with numbers. Columns that `must_swing` do not increase as times do; otherwise only the first such
/// column is taken for the time.
ColumnChooser::Columns ColumnChooser::WithNumbers(const Columns& candidates, bool must_swing) const {
  const auto may_be_time = [&](std::size_t i) { return !Meaning(i).kind && IsIncreasing(i); };
  Columns numeric;
  std::ranges::copy_if(candidates, std::back_inserter(numeric),
                       [&](std::size_t i) { return IsNumeric(i) && !numbers_->is_clock[i]; });
  if (must_swing) {
    std::erase_if(numeric, may_be_time);
  } else if (!time_ && TimesByName().empty() && numeric.size() > 1 && may_be_time(numeric.front())) {
    numeric.erase(numeric.begin());
  }
  return numeric;
}

/// The longest period of the columns that swing noticeably, in rows; 0 if none swings. A component along the rod
/// oscillates twice as fast as the angle.
double ColumnChooser::RowsPerPeriod(const Columns& columns) const {
  constexpr double kNoticeable = 0.2;  // Of the largest amplitude.
  std::vector<SwingSignature> signatures;
  double largest = 0, period = 0;
  for (const std::size_t i : columns) {
    const auto signature = FindSwingSignature(SwingOf(i));
    if (!signature) continue;
    signatures.push_back(*signature);
    largest = std::max(largest, signature->amplitude);
  }
  for (const SwingSignature& signature : signatures) {
    if (signature.amplitude >= kNoticeable * largest) period = std::max(period, signature.rows_per_period);
  }
  return period;
}

/// Of several candidates, chooses the one that carries the swing; std::nullopt if none does, or if the user was asked.
/// Unless one `must_swing`, takes a single column of numbers, and asks which one of several it is.
Result<std::optional<std::size_t>> ColumnChooser::ChooseBySwing(const Columns& candidates, bool must_swing) {
  if (Result<void> read = NeedNumbers(); !read) return tl::unexpected(std::move(read).error());
  if (NumbersOf(0).size() == 0) return candidates.front();  // The number of rows will be the error.
  if (AskForRun(candidates)) return std::nullopt;
  const Columns numeric = WithNumbers(candidates, must_swing);
  const double period = RowsPerPeriod(numeric);
  if (period == 0 && must_swing) return std::nullopt;
  if (numeric.size() == 1) return numeric.front();
  if (numeric.empty()) {  // Without numbers, the rows of a column with a unit say what is wrong.
    const bool is_clear = !must_swing && candidates.size() == 1 && Meaning(candidates.front()).unit != nullptr;
    return is_clear ? std::optional(candidates.front()) : std::nullopt;
  }
  if (period > 0) return ChooseByShare(numeric, period);
  Ask("columns " + ListOf(NamesOf(numeric)) + " could " + (numeric.size() == 2 ? "both" : "all") +
          " be the quantity, and none of them shows a swing by itself; choose one with --value_column",
      {"--value_column " + FlagValueOf(numeric.front())});
  return std::nullopt;
}

/// Chooses by the share of each column in the variance of the swing.
std::optional<std::size_t> ColumnChooser::ChooseByShare(const Columns& candidates, double period) {
  constexpr double kMost = 0.8;
  const Columns columns = WithoutCopies(candidates, CovarianceOf(candidates, period));
  if (columns.size() == 1) {
    Columns copies = candidates;
    std::erase(copies, columns.front());
    Assume("value_column_assumed", "column " + NameOf(columns.front()) + " was used; " + ListOf(NamesOf(copies)) +
                                       (copies.size() == 1 ? " shows" : " show") +
                                       " the same; --value_column chooses another");
    return columns.front();
  }
  const Eigen::MatrixXd covariance = CovarianceOf(columns, period);
  const Eigen::VectorXd shares = covariance.diagonal() / covariance.trace();
  Index best = 0;
  const double share = shares.maxCoeff(&best);
  std::vector<std::string> others;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto row = static_cast<Index>(i);
    if (row != best) others.push_back(NameOf(columns[i]) + " " + Percent(shares[row]));
  }
  const std::optional<Kind> kind = Meaning(columns.front()).kind;
  const bool is_rotation = kind == Kind::kRate && columns.size() <= 3 && CombineAxes(columns, covariance);
  if (is_rotation && !axes_.empty()) return *value_;
  // One axis of an accelerometer is enough, because its direction is a parameter of the fit.
  if (is_rotation || share >= (kind == Kind::kAcceleration ? kMost / 2 : kMost)) {
    Assume("value_column_assumed", "column " + NameOf(columns[best]) + " carries " + Percent(share) +
                                       " of the swing and was used, not " + ListOf(others) +
                                       "; --value_column chooses another" +
                                       (is_rotation ? ", or 'combined' for a sensor that is mounted askew" : ""));
    return columns[best];
  }
  others.insert(others.begin(), NameOf(columns[best]) + " " + Percent(share));
  Ask("no single column carries the swing: " + ListOf(others) + "; choose one with --value_column",
      {"--value_column " + FlagValueOf(columns[best])});
  return std::nullopt;
}

/// The column with the other coordinate of the same point: bob_y_px for bob_x_px.
std::optional<std::size_t> ColumnChooser::FindVertical(std::size_t horizontal) const {
  const NameMeaning x = Meaning(horizontal);
  if (x.kind != Kind::kLength || x.unit == nullptr || !x.Has("x")) return std::nullopt;
  std::string wanted = " " + x.stem + " ";
  for (char& c : wanted) {
    if (c == '_') c = ' ';
  }
  wanted.replace(wanted.rfind(" x ") + 1, 1, "y");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const NameMeaning y = Meaning(i);
    std::string stem = " " + y.stem + " ";
    std::ranges::replace(stem, '_', ' ');
    if (!names_[i].is_hidden && y.kind == Kind::kLength && y.unit == x.unit && stem == wanted) return i;
  }
  return std::nullopt;
}

/// The horizontal coordinate if the candidates contain one point.
std::optional<std::size_t> ColumnChooser::FindPoint(const Columns& candidates) const {
  Columns points;
  std::ranges::copy_if(candidates, std::back_inserter(points),
                       [&](std::size_t i) { return FindVertical(i).has_value(); });
  return points.size() == 1 ? std::optional(points.front()) : std::nullopt;
}

/// Refuses a vertical coordinate. It is the same on both sides, so it oscillates twice as fast as the angle.
Result<void> ColumnChooser::CheckCoordinate(std::size_t index) const {
  const NameMeaning meaning = Meaning(index);
  if (meaning.kind != Kind::kLength || meaning.unit == nullptr || !meaning.Has("y")) return {};
  const bool asked = !options_.value_column.empty();
  const StatusCode code = asked ? StatusCode::kInvalidArgument : StatusCode::kDataLoss;
  return table_.line.Fault(PlaceOf(index),
                           "column " + NameOf(index) +
                               " is the height of the point, which is the same on both sides; choose the horizontal "
                               "coordinate with --value_column, or leave the flag out to use both",
                           code);
}

/// Names the columns of numbers that were not chosen although they may be a quantity.
void ColumnChooser::WarnOfOthers(std::size_t chosen, std::span<const Columns> classes) {
  std::vector<std::string> names;
  for (const Columns& columns : classes) {
    for (const std::size_t i : columns) {
      if (IsNumeric(i) && Meaning(i).kind) names.push_back(NameOf(i));
    }
  }
  if (names.empty()) return;
  Assume("value_column_assumed",
         "column " + NameOf(chosen) + " was used, not " + ListOf(names) + "; --value_column chooses another");
}

/// The column of the quantity; std::nullopt if the user must be asked.
Result<std::optional<std::size_t>> ColumnChooser::ChooseByName() {
  wants_combination_ =
      options_.value_column == kCombined && std::ranges::find(names_, kCombined, &Name::written) == names_.end();
  if (!options_.value_column.empty() && !wants_combination_) {
    const Result<std::size_t> index = FindColumn("--value_column", options_.value_column);
    if (!index) return tl::unexpected(index.error());
    return *index;
  }
  std::vector<Columns> classes = CandidateClasses(!options_.unit.empty());
  if (classes.empty()) classes = CandidateClasses(false);  // The flag contradicts the only candidates.
  const bool is_only = classes.size() == 1 && classes.front().size() == 1;
  if (is_only && !(names_.empty() && layout_.width > 1)) return classes.front().front();
  // Columns that swing come first; if none does, the first numbers that may be a quantity.
  for (const bool must_swing : {true, false}) {
    for (std::size_t i = 0; i < classes.size() && questions_.empty(); ++i) {
      if (const auto point = FindPoint(classes[i])) return *point;
      auto chosen = ChooseBySwing(classes[i], must_swing);
      if (chosen && !*chosen) continue;
      if (chosen && classes[i].size() == 1) WarnOfOthers(**chosen, std::span(classes).subspan(i + 1));
      return chosen;
    }
  }
  return std::nullopt;
}

Result<void> ColumnChooser::ChooseValue() {
  auto chosen = ChooseByName();
  if (!chosen) return tl::unexpected(std::move(chosen).error());
  value_ = *chosen;
  if (!value_) {
    if (questions_.empty()) {
      Ask("none of the columns " + ColumnNames() + " is an angle, a rate or another quantity of a swing: choose one " +
              "with --value_column, and give its unit with --unit",
          {"--value_column " + FlagValueOf(layout_.width - 1), "--unit deg"});
    }
    return {};
  }
  if (value_ == time_) {
    return WrongFlag(*value_, "column " + NameOf(*value_) +
                                  " cannot be both the time and the quantity; choose another with --value_column");
  }
  return CheckCoordinate(*value_);
}

/// Checks --unit against the unit in the name of the column.
Result<void> ColumnChooser::CheckUnitFlag(std::size_t index) const {
  const NameMeaning meaning = Meaning(index);
  const std::string column = "column " + NameOf(index);
  if (meaning.unit != nullptr && meaning.second != nullptr && meaning.second != meaning.unit) {
    return table_.line.Fault(PlaceOf(index), column + " names two units, " + std::string(meaning.second->name) +
                                                 " and " + std::string(meaning.unit->name) +
                                                 "; keep the unit of its values");
  }
  const Unit* asked = options_.unit.empty() ? nullptr : UnitOfText(options_.unit);
  if (!options_.unit.empty() && (asked == nullptr || asked->kind == Kind::kTime)) {
    return WrongFlag(index, "--unit is " + Quoted(options_.unit) + "; it must be " + std::string(kValueUnits));
  }
  const bool is_quantity = meaning.unit != nullptr && meaning.unit->kind != Kind::kTime;
  if (is_quantity && asked != nullptr && meaning.unit != asked) {
    return WrongFlag(index, column + " is in " + std::string(meaning.unit->name) + ", so --unit " + options_.unit +
                                " contradicts it; leave the flag out, or choose another column with --value_column");
  }
  if (meaning.unit != nullptr && meaning.unit->kind == Kind::kTime && asked == nullptr) {
    return table_.line.Fault(PlaceOf(index),
                             column + " is in " + std::string(meaning.unit->name) +
                                 ", which is not a quantity of a swing; choose another with --value_column, or give "
                                 "its unit with --unit");
  }
  return {};
}

/// The unit of the quantity: from its name, the user, the file, or its numbers; nullptr if the user must be asked.
Result<const Unit*> ColumnChooser::ValueUnit(std::size_t index) {
  const NameMeaning meaning = Meaning(index);
  if (!options_.unit.empty()) return UnitOfText(options_.unit);
  if (meaning.unit != nullptr) return meaning.unit;
  if (!table_.value_unit.empty()) return UnitOfSuffix(table_.value_unit);
  if (!table_.raw_input.empty() && meaning.kind.value_or(Kind::kRaw) == Kind::kRaw) {
    return UnitOfText(table_.raw_input);
  }
  if (Result<void> read = NeedNumbers(); !read) return tl::unexpected(std::move(read).error());
  const double step = layout_.time ? MedianStep(NumbersOf(layout_.time->index)) : 0;
  const double seconds = layout_.time ? layout_.time->unit->ToSi(step) : 0;
  const UnitGuess guess = GuessValueUnit(meaning.kind, NumbersOf(index), seconds);
  const std::string column = "column " + NameOf(index) + " does not give its unit";
  if (guess.unit.empty()) {
    Ask(column + guess.reason + ": give it with --unit (" + std::string(kValueUnits) + ")",
        {"--unit " + guess.example});
    return nullptr;
  }
  Assume("value_unit_assumed", column + " and was assumed to be in " + std::string(UnitOfSuffix(guess.unit)->name) +
                                   guess.reason + "; --unit says otherwise");
  return UnitOfSuffix(guess.unit);
}

Column ColumnChooser::ColumnOf(std::size_t index, const Unit& unit) const {
  const NameMeaning meaning = Meaning(index);
  const bool is_gyro = meaning.stem.find("gyro") != std::string::npos || meaning.Has("rate");
  const bool is_without_gravity = meaning.stem.find("linear") != std::string::npos ||
                                  meaning.stem.find("without g") != std::string::npos ||
                                  meaning.stem.find("without_g") != std::string::npos;
  return {index, NameOf(index), &unit, is_gyro, is_without_gravity};
}

Result<void> ColumnChooser::SetValue() {
  if (!value_) return {};
  if (Result<void> checked = CheckUnitFlag(*value_); !checked) return checked;
  const Result<const Unit*> unit = ValueUnit(*value_);
  if (!unit) return tl::unexpected(unit.error());
  if (*unit == nullptr) return {};
  layout_.value = ColumnOf(*value_, **unit);
  for (const std::size_t axis : axes_) layout_.axes.push_back(ColumnOf(axis, **unit));
  const std::optional<std::size_t> vertical = options_.value_column.empty() ? FindVertical(*value_) : std::nullopt;
  if (vertical) layout_.second = Column{*vertical, NameOf(*vertical), layout_.value.unit};
  return {};
}

Result<void> ColumnChooser::Choose() {
  if (Result<void> found = FindNamedTime(); !found) return found;
  if (Result<void> chosen = ChooseValue(); !chosen) return chosen;
  if (Result<void> chosen = ChooseTime(); !chosen) return chosen;
  if (value_ && value_ == time_) {
    return WrongFlag(*value_, "column " + NameOf(*value_) +
                                  " cannot be both the time and the quantity; choose another with --value_column");
  }
  if (Result<void> set = SetValue(); !set) return set;
  return Answer(value_.value_or(0));
}

}  // namespace

bool IsName(std::string_view text) {
  text = Unquote(text);
  return text.find_first_not_of("0123456789+-.,;eE:> \t") != std::string_view::npos ||
         (!text.empty() && text.find_first_not_of("eE") == std::string_view::npos);
}

std::vector<Name> SplitHeader(std::string_view header, char separator) {
  if (separator == ' ') return SplitAtBlanks(header);
  std::vector<Name> names;
  for (FieldCutter fields(header, separator); !fields.done();) {
    const std::string_view field = fields.Next();
    names.push_back({Unquote(field), Trim(field).data()});
  }
  return names;
}

std::size_t CountFields(std::string_view row, char separator) {
  std::size_t count = 0;
  for (FieldCutter fields(row, separator); !fields.done(); ++count) fields.Next();
  return count;
}

std::optional<char> SeparatorOfNumbers(std::string_view row) {
  for (const char separator : {'\t', ';', ',', ' '}) {
    if (separator != ' ' && row.find(separator) == std::string_view::npos) continue;
    Numbers numbers(separator != ',');
    bool all_numbers = true;
    for (FieldCutter fields(row, separator); !fields.done() && all_numbers;) {
      const std::string_view field = Unquote(fields.Next());
      double number = 0;
      all_numbers = numbers.Parse(field, number) || (field.empty() && fields.done());
    }
    if (all_numbers) return separator;
  }
  return std::nullopt;
}

Result<void> ChooseColumns(const TableView& table, const ReadOptions& options, Layout& layout,
                           std::vector<Warning>& warnings) {
  return ColumnChooser(table, options, layout, warnings).Choose();
}

}  // namespace pendulum::csv
