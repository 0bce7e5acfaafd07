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

constexpr double kEndShare = 0.05;

/// The sample after which the steps of so many `rows` change most clearly; std::nullopt if they do not. Their
/// logarithms are clamped to those between the quantiles `share` and 1 - share, so that as many gaps do not matter.
std::optional<Index> FindStepChange(const Eigen::VectorXd& time, Index rows, double share) {
  constexpr Index kMinRows = 20;
  constexpr double kDeviations = 10;
  const Index min_steps = std::max<Index>(kMinRows / rows, 2);
  const Index count = (time.size() - 1) / rows;
  if (count < 2 * min_steps) return std::nullopt;
  const Eigen::VectorXd ends = time(Eigen::seqN(0, count + 1, rows));
  const Eigen::VectorXd steps = ends.tail(count) - ends.head(count);
  std::vector<double> sorted(steps.begin(), steps.end());
  std::ranges::sort(sorted);
  const auto left_out = static_cast<std::size_t>(share * static_cast<double>(count - 1));
  const double low = sorted[left_out], high = sorted[sorted.size() - 1 - left_out];
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
  if (at < min_steps || at > count - min_steps || clearest < kDeviations * kDeviations * within) return std::nullopt;
  return at * rows;
}

/// The change of steps from row to row, of longer ones, in which the rounding of times counts for less, or of few steps
/// near an end.
std::optional<Index> FindStepChange(const Eigen::VectorXd& time) {
  constexpr Index kRows = 8;
  constexpr double kFew = 0.01;
  std::optional<Index> change = FindStepChange(time, 1, kEndShare);
  if (!change) change = FindStepChange(time, kRows, kEndShare);
  if (!change) change = FindStepChange(time, 1, kFew);
  return change ? change : FindStepChange(time, kRows, kFew);
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

enum class ChangeOfStep { kClock, kSampling, kUnknown };

/// Whether `moved` differs clearly from zero and `kept` does not.
bool IsOnly(const Estimate& moved, const Estimate& kept) {
  constexpr double kAgrees = 3, kDiffers = 6;  // standard errors
  constexpr double kNear = 0.2;
  const double difference = std::abs(moved.value);
  return difference > std::max(kLeastChange, kDiffers * moved.std_error) &&
         std::abs(kept.value) < std::max(kAgrees * kept.std_error, kNear * difference);
}

/// The clock if a half period takes as many rows on both sides, but not as many seconds; the sampling if it is the
/// other way round.
ChangeOfStep ChangeIn(const BothSides& sides) {
  const std::optional<Estimate> rows = ChangeOf(sides.before.rows, sides.after.rows);
  const std::optional<Estimate> seconds = ChangeOf(sides.before.seconds, sides.after.seconds);
  if (!rows || !seconds) return ChangeOfStep::kUnknown;
  return IsOnly(*seconds, *rows)   ? ChangeOfStep::kClock
         : IsOnly(*rows, *seconds) ? ChangeOfStep::kSampling
                                   : ChangeOfStep::kUnknown;
}

/// The change that a recording shows after sample `change`.
StepChange StepChangeAt(const Eigen::VectorXd& time, Index change) {
  const Index last = time.size() - 1;
  const auto mean_step = [&](Index from, Index to) {  // of the steps between the quantiles, so that gaps do not matter
    const Eigen::VectorXd steps = time.segment(from + 1, to - from) - time.segment(from, to - from);
    std::vector<double> sorted(steps.begin(), steps.end());
    std::ranges::sort(sorted);
    const auto left_out = static_cast<std::size_t>(kEndShare * static_cast<double>(sorted.size()));
    return steps.array().max(sorted[left_out]).min(sorted[sorted.size() - 1 - left_out]).mean();
  };
  const auto share = static_cast<double>(std::min(change, last - change)) / static_cast<double>(last);
  return {time[change], mean_step(0, change), mean_step(change, last), share < kEndShare};
}

/// The time of a change [s], with the digits that distinguish samples.
std::string TimeTextOf(const StepChange& change) {
  const double samples = std::abs(change.time) / std::min(change.before, change.after);
  return NumberText(change.time,
                    std::clamp(static_cast<int>(std::ceil(std::log10(std::max(samples, 1.0)))) + 2, 4, 15));
}

std::string TextOf(const StepChange& change) {
  const auto text = [](double step) { return NumberText(1e3 * step, 4) + " ms"; };
  return "the times change their rate at " + TimeTextOf(change) + " s, from " + text(change.before) + " to " +
         text(change.after) + " between rows";
}

}  // namespace

Warning StepChange::ToWarning() const {
  return {.code = "clock_unproven",
          .finding = TextOf(*this) + ", and the swings do not show whether the clock changed or the sampling",
          .advice = "if it was the clock, the times of one part are wrong: fit the other part with --to " +
                    TimeTextOf(*this) + " or --from " + TimeTextOf(*this),
          .flags = {"to", "from"}};
}

Result<std::optional<StepChange>> CheckClock(const Recording& recording, bool is_spring) {
  const std::optional<Index> row = FindStepChange(recording.time);
  if (!row) return std::nullopt;
  const ChangeOfStep cause = ChangeIn(FindHalfPeriods(recording, *row, false));
  // The period of a torsion pendulum does not depend on the amplitude, and few recordings say which it is.
  const ChangeOfStep other = is_spring ? cause : ChangeIn(FindHalfPeriods(recording, *row, true));
  if (cause == ChangeOfStep::kSampling || other == ChangeOfStep::kSampling) return std::nullopt;
  const StepChange change = StepChangeAt(recording.time, *row);
  if (cause == ChangeOfStep::kUnknown || other == ChangeOfStep::kUnknown) return change;
  const std::string at = TimeTextOf(change);
  return Error(StatusCode::kDataLoss,
               TextOf(change) +
                   ", but a swing takes as many rows as before: the clock changed, not the sampling, and "
                   "the times of one part are wrong; fit the part whose times are right, with --to " +
                   at + " or --from " + at);
}

}  // namespace pendulum
