// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/passages.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum::csv {
namespace {

using Eigen::Index;

/// Whether the names, if there are any, speak of times and numbers of rows alone.
bool MayHoldPassages(const Choice& choice) {
  const bool is_told = !choice.options.value_column.empty() || choice.options.sample_rate_hz > 0;
  return !is_told && !choice.table.has_rate && !choice.table.has_host &&
         std::ranges::all_of(choice.meanings,
                             [](const NameMeaning& meaning) { return !meaning.kind || *meaning.kind == Kind::kTime; });
}

/// Whether numbers may be the times for which a gate was blocked: short beside the time between passages, and longer
/// and longer as the swing decays.
bool AreBlockTimes(const Eigen::VectorXd& numbers, const Eigen::VectorXd& passages) {
  constexpr double kShort = 0.2, kMostLonger = 0.8;
  const Index count = numbers.size() - 1;
  if (count < 1 || !(numbers.minCoeff() > 0)) return false;
  const auto longer = (numbers.tail(count).array() >= numbers.head(count).array()).count();
  return numbers.maxCoeff() * static_cast<double>(count) < kShort * (passages[count] - passages[0]) &&
         static_cast<double>(longer) >= kMostLonger * static_cast<double>(count);
}

/// The only column beside those that number the rows and those of block times after it, if it has numbers.
std::optional<std::size_t> OnlyColumn(const Choice& choice) {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < choice.layout.width; ++i) {
    const bool is_empty = choice.NumbersOf(i).array().isNaN().all() && i + 1 == choice.layout.width;
    if (is_empty || (choice.IsNumeric(i) && choice.IsRowNumber(i))) continue;
    if (!choice.IsNumeric(i)) return std::nullopt;
    if (only && AreBlockTimes(choice.NumbersOf(i), choice.NumbersOf(*only))) continue;
    if (only) return std::nullopt;
    only = i;
  }
  return only;
}

/// Whether the numbers increase with steps of similar size that are not equal, as a clock's would be.
bool ArePassages(const Eigen::VectorXd& times) {
  constexpr double kUnequal = 1e-5, kSimilar = 5;
  constexpr Index kMinPassages = 4;
  if (times.size() < kMinPassages || !times.allFinite()) return false;
  const Eigen::ArrayXd steps = times.tail(times.size() - 1) - times.head(times.size() - 1);
  const double shortest = steps.minCoeff(), longest = steps.maxCoeff();
  return shortest > 0 && longest < kSimilar * shortest && longest > (1 + kUnequal) * shortest;
}

/// The mean of full periods, each of two steps, in the unit of the column; without a unit, in the first of s, ms and us
/// with a plausible period. Steps that do not alternate may be whole periods, each of one step.
std::string PeriodText(const Choice& choice, std::size_t index) {
  constexpr double kLongest = 100;     // s
  constexpr double kAlternates = 0.5;  // of the mean change from step to step: the rest is noise
  constexpr double kVisible = 2e-3;    // of a step: smaller changes may be rounding
  const Eigen::VectorXd& times = choice.NumbersOf(index);
  const Index periods = (times.size() - 1) / 2;
  double period = (times[2 * periods] - times[0]) / static_cast<double>(periods);
  const Unit* unit = choice.Meaning(index).unit;
  std::string assumed;
  for (const std::string_view name : {"s", "ms", "us"}) {
    if (choice.Meaning(index).unit != nullptr) break;
    unit = UnitOfSuffix(name);
    assumed = " (if the times are in " + std::string(name) + ")";
    if (unit->ToSi(period) <= kLongest) break;
  }
  period = unit->ToSi(period);
  const Eigen::ArrayXd steps = times.tail(times.size() - 1) - times.head(times.size() - 1);
  const Eigen::ArrayXd changes = steps.tail(steps.size() - 1) - steps.head(steps.size() - 1);
  double alternating = 0;
  for (Index i = 0; i < changes.size(); ++i) alternating += i % 2 == 0 ? changes[i] : -changes[i];
  const bool alternates =
      std::abs(alternating) > kAlternates * changes.abs().sum() && changes.abs().mean() > kVisible * steps.mean();
  const std::string half = ", or " + NumberText(period / 2, 5) + " s if all passages are in one direction";
  return NumberText(period, 5) + " s" + assumed + (alternates ? "" : half);
}

}  // namespace

Result<void> RefusePassages(Choice& choice) {
  if (!MayHoldPassages(choice)) return {};
  RETURN_IF_ERROR(choice.NeedNumbers());
  const auto index = OnlyColumn(choice);
  if (!index || !ArePassages(choice.NumbersOf(*index))) return {};
  return choice.table.line.Fault(
      choice.PlaceOf(*index),
      "column " + choice.NameOf(*index) + " holds times of passages, not readings: the mean of full periods is " +
          PeriodText(choice, *index) +
          "; friction needs readings of the whole swing, from a potentiometer, an encoder, a gyro or a video");
}

}  // namespace pendulum::csv
