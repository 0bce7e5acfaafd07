// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/clock_change.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr double kLeastChange = 0.004;  // relative: twice this in inertia

/// The sample after which the steps change most clearly; std::nullopt if they do not. Their logarithms are clamped to
/// the middle nine tenths, so that gaps do not matter.
std::optional<Index> FindStepChange(const Eigen::VectorXd& time) {
  constexpr Index kMinSteps = 20;
  constexpr double kDeviations = 10;
  const Index count = time.size() - 1;
  if (count < 2 * kMinSteps) return std::nullopt;
  const Eigen::VectorXd steps = time.tail(count) - time.head(count);
  std::vector<double> sorted(steps.begin(), steps.end());
  const auto quantile = [&](double share) {
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1));
    std::ranges::nth_element(sorted, at);
    return *at;
  };
  const double low = quantile(0.05), high = quantile(0.95);
  if (!(low > 0) || std::log(high / low) < kLeastChange) return std::nullopt;
  const Eigen::ArrayXd logs = steps.array().max(low).min(high).log();
  const Eigen::ArrayXd centred = logs - logs.mean();
  double sum = 0, clearest = 0;
  Index at = 0;
  for (Index i = 0; i + 1 < count; ++i) {
    sum += centred[i];
    const Index left = i + 1;
    const double between = sum * sum * static_cast<double>(count) / static_cast<double>(left * (count - left));
    if (between <= clearest) continue;
    clearest = between;
    at = left;
  }
  const double within = (centred.square().sum() - clearest) / static_cast<double>(count);
  if (at < kMinSteps || at > count - kMinSteps || clearest < kDeviations * kDeviations * within) return std::nullopt;
  return at;
}

/// The median of a logarithm, with its standard error; std::nullopt of nothing.
std::optional<Estimate> MedianOfLogs(std::vector<double> logs) {
  constexpr double kMedianError = 1.86;  // 1.2533 of a median, times 1.4826 of its deviations
  constexpr double kLeastError = 5e-4, kErrorOfFew = 6e-3;
  constexpr std::size_t kFew = 3;  // the scatter of so few may be small by chance
  const std::size_t count = logs.size();
  if (count == 0) return std::nullopt;
  const double typical = Median(logs);
  for (double& each : logs) each = std::abs(each - typical);
  const double error = kMedianError * Median(std::move(logs)) / std::sqrt(static_cast<double>(count));
  return Estimate{typical, std::max(error, count < kFew ? kErrorOfFew : kLeastError)};
}

/// Half periods on one side of the change: logarithms of their rows and of their seconds.
struct HalfPeriods {
  std::vector<double> rows, seconds;
};

struct BothSides {
  HalfPeriods before, after;
};

/// The time at a fractional row [s].
double TimeAtRow(const Eigen::VectorXd& time, double row) {
  const auto below = std::clamp<Index>(static_cast<Index>(std::floor(row)), 0, time.size() - 2);
  return time[below] + (row - static_cast<double>(below)) * (time[below + 1] - time[below]);
}

/// Turning points by row, so that no time affects them. is_pendulum: durations are those of small swings.
BothSides FindHalfPeriods(const Recording& recording, Index change, bool is_pendulum) {
  Recording by_row = recording;
  const double step = (recording.time[change] - recording.time[0]) / static_cast<double>(change);
  const auto last = static_cast<double>(recording.size() - 1);
  by_row.time = Eigen::VectorXd::LinSpaced(recording.size(), 0, step * last);
  if (HasTurningPointView(by_row)) by_row = TurningPointView(by_row);
  const TurningPointTable table = FindAllTurningPoints(by_row);
  BothSides sides;
  for (std::size_t i = 1; i < table.half_swings(); ++i) {  // point 0 may be the start or lie in a hold
    const TurningPoint &from = table.points[i], &to = table.points[i + 1];
    if (from.sample < change && to.sample > change) continue;
    const double stretch = is_pendulum ? 0.5 * (table.Stretch(i) + table.Stretch(i + 1)) : 1;
    const double rows = (to.time - from.time) / step;
    const double seconds = TimeAtRow(recording.time, to.time / step) - TimeAtRow(recording.time, from.time / step);
    if (!(rows > 0 && seconds > 0)) continue;
    HalfPeriods& side = to.sample <= change ? sides.before : sides.after;
    side.rows.push_back(std::log(rows / stretch));
    side.seconds.push_back(std::log(seconds / stretch));
  }
  return sides;
}

/// How a logarithm changes, with its standard error.
std::optional<Estimate> ChangeOf(const std::vector<double>& before, const std::vector<double>& after) {
  const std::optional<Estimate> a = MedianOfLogs(before), b = MedianOfLogs(after);
  if (!a || !b) return std::nullopt;
  return Estimate{b->value - a->value, std::hypot(a->std_error, b->std_error)};
}

/// Whether a half period takes as many rows on both sides, but not as many seconds.
bool IsClockOf(const BothSides& sides) {
  constexpr double kAgrees = 3, kDiffers = 6;  // standard errors
  constexpr double kNear = 0.2;
  const std::optional<Estimate> rows = ChangeOf(sides.before.rows, sides.after.rows);
  const std::optional<Estimate> seconds = ChangeOf(sides.before.seconds, sides.after.seconds);
  if (!rows || !seconds) return false;
  const double difference = std::abs(seconds->value);
  return difference > std::max(kLeastChange, kDiffers * seconds->std_error) &&
         std::abs(rows->value) < std::max(kAgrees * rows->std_error, kNear * difference);
}

/// A time with the digits that distinguish samples.
std::string TimeText(double time, double step) {
  const double digits = std::ceil(std::log10(std::max(std::abs(time) / step, 1.0))) + 2;
  return NumberText(time, std::clamp(static_cast<int>(digits), 4, 15));
}

}  // namespace

Result<void> CheckClock(const Recording& recording, bool is_spring) {
  const std::optional<Index> change = FindStepChange(recording.time);
  if (!change) return {};
  const BothSides sides = FindHalfPeriods(recording, *change, false);
  // The period of a torsion pendulum does not depend on the amplitude, and few recordings say which it is.
  if (!IsClockOf(sides) || (!is_spring && !IsClockOf(FindHalfPeriods(recording, *change, true)))) return {};
  const auto step_of = [](const HalfPeriods& side) { return std::exp(Median(side.seconds) - Median(side.rows)); };
  const double before = step_of(sides.before), after = step_of(sides.after);
  const std::string at = TimeText(recording.time[*change], std::min(before, after));
  const auto text = [](double step) { return NumberText(1e3 * step, 4) + " ms"; };
  return Error(StatusCode::kDataLoss,
               "the times change their rate at " + at + " s, from " + text(before) + " to " + text(after) +
                   " between rows, but a swing takes as many rows as before: the clock changed, not the sampling, and "
                   "the times of one part are wrong; fit the part whose times are right, with --to " +
                   at + " or --from " + at);
}

}  // namespace pendulum
