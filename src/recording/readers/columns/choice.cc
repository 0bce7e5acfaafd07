// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"
#include "pendulum/recording/recording.h"

namespace pendulum::csv {

using Eigen::Index;

namespace {

/// Beside a rate, alpha is the angular acceleration.
void MarkDerivatives(std::vector<NameMeaning>& meanings) {
  const auto is_rate = [](const NameMeaning& meaning) { return meaning.kind == Kind::kRate; };
  if (std::ranges::none_of(meanings, is_rate)) return;
  for (NameMeaning& meaning : meanings) meaning.is_secondary |= meaning.unit == nullptr && meaning.Has("alpha");
}

/// Beside x and y, z is the third axis of the same sensor.
void MarkThirdAxis(std::vector<NameMeaning>& meanings) {
  const auto axes = FindAxes(meanings);
  if (axes && !meanings[axes->at(2)].kind) meanings[axes->at(2)].kind = meanings[axes->at(0)].kind;
}

}  // namespace

std::vector<NameMeaning> MeaningsOf(const std::vector<Name>& names, std::size_t width) {
  std::vector<NameMeaning> meanings;
  meanings.reserve(std::max(names.size(), width));
  for (const Name& name : names) meanings.push_back(MeaningOf(name.text));
  meanings.resize(std::max(names.size(), width));
  MarkDerivatives(meanings);
  MarkThirdAxis(meanings);
  return meanings;
}

std::optional<std::array<std::size_t, 3>> FindAxes(const std::vector<NameMeaning>& meanings) {
  std::array<std::size_t, 3> axes{};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const auto found = std::ranges::find_if(meanings, [&](const NameMeaning& meaning) {
      return meaning.stem == std::string_view("xyz").substr(k, 1) && meaning.unit == nullptr;
    });
    if (found == meanings.end()) return std::nullopt;
    axes.at(k) = static_cast<std::size_t>(found - meanings.begin());
  }
  return axes;
}

bool IsShortAcceleration(const NameMeaning& meaning) {
  std::string letters = meaning.stem;
  std::erase_if(letters, [](char c) { return c < 'a' || c > 'z'; });
  return meaning.unit == nullptr && meaning.kind == Kind::kAcceleration && letters.size() == 2 && letters[0] == 'a';
}

std::string Choice::NameOf(std::size_t index) const {
  return index < names.size() ? Quoted(names[index].written) : std::to_string(index + 1);
}

std::vector<std::string> Choice::NamesOf(const Columns& columns) const {
  std::vector<std::string> list;
  for (const std::size_t i : columns) list.push_back(NameOf(i));
  return list;
}

std::string Choice::FlagValueOf(std::size_t index) const {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; };
  constexpr std::size_t kLongest = 80;  // bytes; a longer name would hide the command that it stands in
  const bool is_unique = index < names.size() && !names[index].written.empty() &&
                         names[index].written.size() <= kLongest &&
                         std::ranges::none_of(names[index].written, is_control) && IsUtf8(names[index].written) &&
                         std::ranges::count(names, names[index].written, &Name::written) == 1;
  return is_unique ? std::string(names[index].written) : std::to_string(index + 1);
}

std::string Choice::ColumnNames() const {
  constexpr std::size_t kShown = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) list += (i == 0 ? "" : ", ") + NameOf(i);
  return list + (names.size() > kShown ? ", ..." : "");
}

Result<std::size_t> Choice::FindColumn(const std::string& flag, std::string_view name) const {
  const auto found = std::ranges::find(names, name, &Name::written);
  if (found != names.end()) return found - names.begin();
  if (const auto index = ColumnOfNumber(name, layout.width)) return *index;
  const std::string count = std::to_string(layout.width) + (layout.width == 1 ? " column" : " columns");
  return WrongFlag(0, flag + " is " + Quoted(name) + ", which is none of the " + count +
                          (names.empty() ? "; give its number, the first is 1"
                                         : " " + ColumnNames() + "; give a name, or a number from 1 on"));
}

Columns Choice::TimesByName() const {
  Columns times;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].is_hidden && Meaning(i).kind == Kind::kTime) times.push_back(i);
  }
  return times;
}

const char* Choice::PlaceOf(std::size_t index) const {
  return index < names.size() ? names[index].at : table.line.text.data();
}

tl::unexpected<Status> Choice::WrongFlag(std::size_t index, const std::string& sentence) const {
  return table.line.Fault(PlaceOf(index), sentence, StatusCode::kInvalidArgument);
}

void Choice::Assume(Warning assumption) {
  assumption.about.file = table.line.file;
  warnings.push_back(std::move(assumption));
}

void Choice::Ask(const std::string& sentence, const std::vector<std::string>& flags, std::string_view option) {
  ReadQuestion question{sentence, {}, flags, {}};
  if (!option.empty()) question.options.emplace_back(option);
  for (const std::string& flag : flags) question.options.push_back(flag.substr(2, flag.find(' ') - 2));
  questions.push_back(std::move(question));
}

void Choice::AskForColumn(const std::string& sentence, std::size_t best) {
  Ask(sentence + "; choose one with --value_column", {"--value_column " + FlagValueOf(best)});
  example = best;
}

Result<void> Choice::Answer(std::size_t place) const {
  if (questions.empty()) return {};
  std::string sentence;
  std::vector<std::string> try_flags;
  for (const ReadQuestion& question : questions) {
    sentence += (sentence.empty() ? "" : "; ") + question.sentence;
    try_flags.insert(try_flags.end(), question.try_flags.begin(), question.try_flags.end());
  }
  return WithTry(table.line.Fault(PlaceOf(place), sentence), try_flags);
}

Result<void> Choice::NeedNumbers() {
  if (numbers) return {};
  ASSIGN_OR_RETURN(TableNumbers read, table.numbers());
  numbers = std::move(read);
  return {};
}

Eigen::VectorXd Choice::SwingOf(std::size_t index) const {
  const Unit* unit = Meaning(index).unit;
  if (unit == nullptr) return NumbersOf(index);
  return NumbersOf(index).unaryExpr([unit](double number) { return unit->ToSi(number); });
}

bool Choice::IsNumeric(std::size_t index) const {
  const Eigen::VectorXd& cells = NumbersOf(index);
  const Index count = cells.array().isFinite().count();
  return count >= 2 && 20 * count > cells.size();
}

bool Choice::MayBeTime(std::size_t index) const {
  const NameMeaning& meaning = Meaning(index);
  return !meaning.kind || (meaning.kind == Kind::kLength && meaning.unit == nullptr);
}

bool Choice::IsIncreasing(std::size_t index) const {
  constexpr Index kRowsPerStepBack = 100;  // A step back in more rows is an error of the clock.
  double last = -std::numeric_limits<double>::infinity(), first = last;
  Index back = 0;
  for (const double number : NumbersOf(index)) {
    if (!std::isfinite(number)) continue;
    back += number < last ? 1 : 0;
    if (!std::isfinite(first)) first = number;
    last = number;
  }
  return last > first && kRowsPerStepBack * back <= NumbersOf(index).size();
}

bool Choice::IsRowNumber(std::size_t index) const {
  const Eigen::VectorXd& counts = NumbersOf(index);
  for (Index i = 1; i < counts.size(); ++i) {
    if (std::isfinite(counts[i]) && std::isfinite(counts[i - 1]) && counts[i] - counts[i - 1] != 1) return false;
  }
  return counts.size() >= kMinimumSamples && counts[0] == std::floor(counts[0]);
}

bool AreSeparated(const Columns& times) {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1] + 1) return true;
  }
  return false;
}

std::size_t TimeBefore(const Columns& times, std::size_t value) {
  const auto after = std::ranges::upper_bound(times, value);
  return after == times.begin() ? times.front() : *std::prev(after);
}

}  // namespace pendulum::csv
