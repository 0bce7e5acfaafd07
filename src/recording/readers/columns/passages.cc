// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/passages.h"

#include <algorithm>
#include <optional>
#include <string>

#include "pendulum/base/format.h"

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

/// The only column beside those that number the rows, if it has numbers.
std::optional<std::size_t> OnlyColumn(const Choice& choice) {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < choice.layout.width; ++i) {
    if (choice.IsNumeric(i) && choice.IsRowNumber(i)) continue;
    if (only || !choice.IsNumeric(i)) return std::nullopt;
    only = i;
  }
  return only;
}

/// Whether the numbers increase with steps of similar size that are not equal, as a clock's would be.
bool ArePassages(const Eigen::VectorXd& times) {
  constexpr double kUnequal = 1e-3, kSimilar = 5;
  constexpr Index kMinPassages = 4;
  if (times.size() < kMinPassages || !times.allFinite()) return false;
  const Eigen::ArrayXd steps = times.tail(times.size() - 1) - times.head(times.size() - 1);
  const double shortest = steps.minCoeff(), longest = steps.maxCoeff();
  return shortest > 0 && longest < kSimilar * shortest && longest > (1 + kUnequal) * shortest;
}

/// The mean of full periods, each of two steps, in the unit of the column; in s if it has none and only ms are
/// plausible.
std::string PeriodText(const Choice& choice, std::size_t index) {
  constexpr double kLongest = 100;  // s
  const Eigen::VectorXd& times = choice.NumbersOf(index);
  const Index periods = (times.size() - 1) / 2;
  const double period = (times[2 * periods] - times[0]) / static_cast<double>(periods);
  const Unit* const unit = choice.Meaning(index).unit;
  if (unit != nullptr) return NumberText(unit->ToSi(period), 5) + " s";
  if (period > kLongest) return NumberText(period / 1000, 5) + " s (if the times are in ms)";
  return NumberText(period, 5) + " s (if the times are in s)";
}

}  // namespace

Result<void> RefusePassages(Choice& choice) {
  if (!MayHoldPassages(choice)) return {};
  if (Result<void> read = choice.NeedNumbers(); !read) return read;
  const auto index = OnlyColumn(choice);
  if (!index || !ArePassages(choice.NumbersOf(*index))) return {};
  return choice.table.line.Fault(
      choice.PlaceOf(*index),
      "column " + choice.NameOf(*index) + " holds times of passages, not readings: the mean of full periods is " +
          PeriodText(choice, *index) +
          "; friction needs readings of the whole swing, from a potentiometer, an encoder, a gyro or a video");
}

}  // namespace pendulum::csv
