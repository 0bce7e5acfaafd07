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

/// Before and after sample `at`, the mean sampling interval [s].
struct StepChange {
  Index at = 0;
  double before = 0, after = 0;

  double log_ratio() const { return std::log(after / before); }
};

/// The mean of steps [begin, end) without those of gaps.
double MeanStep(const Eigen::VectorXd& steps, Index begin, Index end) {
  constexpr double kGap = 2;
  const double usual = Median(std::vector<double>(steps.begin() + begin, steps.begin() + end));
  double sum = 0, count = 0;
  for (Index i = begin; i < end; ++i) {
    if (steps[i] > kGap * usual || kGap * steps[i] < usual) continue;
    sum += steps[i];
    ++count;
  }
  return sum / count;
}

/// Where the steps change most clearly; std::nullopt if they do not. Their logarithms are clamped to the middle nine
/// tenths, so that gaps do not matter.
std::optional<StepChange> FindStepChange(const Eigen::VectorXd& time) {
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
  const StepChange change{at, MeanStep(steps, 0, at), MeanStep(steps, at, count)};
  if (std::abs(change.log_ratio()) < kLeastChange) return std::nullopt;
  return change;
}

/// Logarithm of the median half period of small swings [rows], with its standard error; std::nullopt if there is none.
std::optional<Estimate> LogHalfPeriod(std::vector<double> rows) {
  constexpr double kMedianError = 1.86;  // 1.2533 of a median, times 1.4826 of its deviations
  constexpr double kLeastError = 5e-4, kErrorOfFew = 6e-3;
  constexpr std::size_t kFew = 3;  // the scatter of so few half swings may be small by chance
  const std::size_t count = rows.size();
  if (count == 0) return std::nullopt;
  const double typical = Median(rows);
  for (double& each : rows) each = std::abs(each - typical);
  const double error = kMedianError * Median(std::move(rows)) / typical / std::sqrt(static_cast<double>(count));
  return Estimate{std::log(typical), std::max(error, count < kFew ? kErrorOfFew : kLeastError)};
}

/// How the half period in rows changes: the difference of its logarithms, with its standard error.
std::optional<Estimate> ChangeOfRows(const Recording& recording, const StepChange& change) {
  Recording by_row = recording;
  by_row.time =
      Eigen::VectorXd::LinSpaced(recording.size(), 0, change.before * static_cast<double>(recording.size() - 1));
  if (HasTurningPointView(by_row)) by_row = TurningPointView(by_row);
  const TurningPointTable table = FindAllTurningPoints(by_row);
  std::vector<double> before, after;
  for (std::size_t i = 1; i < table.half_swings(); ++i) {  // point 0 may be the start or lie in a hold
    const TurningPoint &from = table.points[i], &to = table.points[i + 1];
    const double duration = (to.time - from.time) / (0.5 * (table.Stretch(i) + table.Stretch(i + 1)));
    if (to.sample <= change.at) before.push_back(duration);
    if (from.sample >= change.at) after.push_back(duration);
  }
  const std::optional<Estimate> a = LogHalfPeriod(std::move(before)), b = LogHalfPeriod(std::move(after));
  if (!a || !b) return std::nullopt;
  return Estimate{b->value - a->value, std::hypot(a->std_error, b->std_error)};
}

}  // namespace

Result<void> CheckClock(const Recording& recording) {
  constexpr double kAgrees = 3, kDiffers = 6;  // standard errors
  const std::optional<StepChange> change = FindStepChange(recording.time);
  if (!change) return {};
  const std::optional<Estimate> rows = ChangeOfRows(recording, *change);
  if (!rows) return {};
  const double if_sampling = rows->value + change->log_ratio();
  const bool clock_changed =
      std::abs(rows->value) < kAgrees * rows->std_error && std::abs(if_sampling) > kDiffers * rows->std_error;
  if (!clock_changed) return {};
  const std::string to = NumberText(recording.time[change->at], 6);
  const auto text = [](double step) { return NumberText(1e3 * step, 4) + " ms"; };
  return Error(StatusCode::kDataLoss,
               "the times change their rate at " + to + " s, from " + text(change->before) + " to " +
                   text(change->after) +
                   " between rows, but a swing takes as many rows as before: the clock changed, not the sampling, and "
                   "the times of one part are wrong; fit the part whose times are right, with --to " +
                   to + " or --from " + to);
}

}  // namespace pendulum
