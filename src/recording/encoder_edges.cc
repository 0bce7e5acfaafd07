// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/encoder_edges.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace pendulum {
namespace {

using Eigen::Index;

/// The step from the previous row, in whole multiples of 1 / `parts` count; 0 for the first row.
double StepTo(const Recording& recording, Index i, double parts = 1) {
  return i == 0 ? 0 : std::round(parts * (recording.value[i] - recording.value[i - 1]) / recording.resolution);
}

bool HasUnevenStamps(const Recording& recording) {
  constexpr double kUneven = 1.5;
  const Index last = recording.size() - 1;
  Eigen::VectorXd intervals = recording.time.tail(last) - recording.time.head(last);
  std::sort(intervals.begin(), intervals.end());
  return intervals[last * 9 / 10] > kUneven * intervals[last / 10];
}

/// The first row of each run of rows in one direction, followed by the number of rows.
std::vector<Index> RunsOf(const Recording& recording) {
  std::vector<Index> begins = {0};
  double direction = 0;
  for (Index i = 1; i < recording.size(); ++i) {
    const double step = StepTo(recording, i);
    if (step * direction < 0) begins.push_back(i);
    if (step != 0) direction = step;
  }
  begins.push_back(recording.size());
  return begins;
}

/// Marks slips: one or two rows in the opposite direction within a long motion. They occur when a counter misses edges
/// while its logger is busy, and they are not edges at their stamps.
std::vector<bool> MarkSlips(const Recording& recording) {
  constexpr Index kShort = 2, kLong = 8;
  const std::vector<Index> begins = RunsOf(recording);
  const auto size = [&](std::size_t k) { return begins[k + 1] - begins[k]; };
  std::vector<bool> slips(static_cast<std::size_t>(recording.size()), false);
  for (std::size_t k = 1; k + 2 < begins.size(); ++k) {
    if (size(k) > kShort || size(k - 1) < kLong || size(k + 1) < kLong) continue;
    std::fill(slips.begin() + begins[k], slips.begin() + begins[k + 1], true);
  }
  return slips;
}

/// Whether the next row is one count back, so that the turning point lies within the count of row i.
bool ReversesAfter(const Recording& recording, Index i) {
  if (i == 0 || i + 1 == recording.size()) return false;
  const double next = StepTo(recording, i + 1);
  return std::abs(next) == 1 && next * StepTo(recording, i) < 0;
}

/// Whether the recording begins with a hold: the wait after the first row is much longer than at the next turning
/// points.
bool StartsWithHold(const Recording& recording) {
  constexpr double kLonger = 3;
  constexpr int kTurns = 3;
  double longest = 0;
  int turns = 0;
  for (Index i = 1; i + 1 < recording.size() && turns < kTurns; ++i) {
    longest = std::max(longest, recording.time[i + 1] - recording.time[i]);
    turns += ReversesAfter(recording, i) ? 1 : 0;
  }
  return recording.time[1] - recording.time[0] > kLonger * longest;
}

Warning ConversionWarning(Index silences, std::ptrdiff_t slips) {
  std::string explanation =
      "each row is treated as the edge of its count, crossed at its time stamp; between rows at the " +
      std::to_string(silences) + " turning points and rests the angle is only known to be within its count";
  if (slips > 0) {
    explanation += "; " + std::to_string(slips) + (slips == 1 ? " row" : " rows") +
                   " in the wrong direction left out, because the counter missed edges";
  }
  return {.code = "event_driven",
          .finding = "the recording has rows only where the count changes",
          .explanation = explanation,
          .advice = "use --noise gaussian to treat the rows as samples",
          .flags = {"noise"}};
}

}  // namespace

bool IsEventDriven(const Recording& recording) {
  constexpr double kMinSteps = 20;
  constexpr double kWhole = 0.1;  // of a count
  constexpr double kMaxStep = 3;  // counts, if rows were missed
  constexpr double kNearlyAll = 0.99, kSingle = 0.85, kRepeated = 0.05;
  const auto steps = static_cast<double>(recording.size() - 1);
  if (recording.quantity != Quantity::kAngle || !(recording.resolution > 0) || steps < kMinSteps) return false;
  double few = 0, single = 0, none = 0;
  for (Index i = 1; i < recording.size(); ++i) {
    const double step = std::abs(recording.value[i] - recording.value[i - 1]) / recording.resolution;
    const double whole = std::round(step);
    if (std::abs(step - whole) > kWhole || whole > kMaxStep) continue;
    ++few;
    single += whole == 1 ? 1 : 0;
    none += whole == 0 ? 1 : 0;
  }
  return few >= kNearlyAll * steps && single >= kSingle * steps && none <= kRepeated * steps &&
         HasUnevenStamps(recording);
}

Recording ConvertToEdges(Recording recording) {
  const double half = 0.5 * recording.resolution;
  const std::vector<bool> slips = MarkSlips(recording);
  const auto slipped = [&](Index i) { return slips[static_cast<std::size_t>(i)]; };
  std::vector<double> time, value;
  Index silences = 0;
  for (Index i = StartsWithHold(recording) ? 1 : 0; i < recording.size(); ++i) {
    if (slipped(i)) continue;
    const double step = StepTo(recording, i);
    time.push_back(recording.time[i]);
    value.push_back(recording.value[i] - (step > 0 ? half : step < 0 ? -half : 0.0));
    silences += step == 0 ? 1 : 0;
    if (!ReversesAfter(recording, i) || slipped(i + 1)) continue;
    const double middle = 0.5 * (recording.time[i] + recording.time[i + 1]);
    if (!(recording.time[i] < middle && middle < recording.time[i + 1])) continue;
    time.push_back(middle);
    value.push_back(recording.value[i]);
    ++silences;
  }
  recording.edge = recording.value[0] + half;
  recording.time = Eigen::Map<const Eigen::VectorXd>(time.data(), static_cast<Index>(time.size()));
  recording.value = Eigen::Map<const Eigen::VectorXd>(value.data(), static_cast<Index>(value.size()));
  std::erase_if(recording.warnings, [](const Warning& warning) { return warning.code == "event_driven"; });
  recording.warnings.push_back(ConversionWarning(silences, std::ranges::count(slips, true)));
  return recording;
}

Eigen::VectorXd EdgeDirections(const Recording& recording) {
  constexpr double kHalves = 2;
  const Index last = recording.size() - 1;
  Eigen::VectorXd directions(recording.size());
  for (Index i = 0; i <= last; ++i) {
    const double levels = (recording.value[i] - *recording.edge) / recording.resolution;
    const bool is_silence = std::abs(levels - std::round(levels)) > 0.25;
    const double from = StepTo(recording, i, kHalves);
    const double to = i == last ? 0 : StepTo(recording, i + 1, kHalves);
    const double step = std::abs(to) == kHalves || from == 0 ? to : from;
    directions[i] = is_silence || step == 0 ? 0 : std::copysign(1.0, step);
  }
  return directions;
}

}  // namespace pendulum
