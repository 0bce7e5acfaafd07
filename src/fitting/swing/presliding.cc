// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/presliding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

/// Half swings of a free swing: their durations, divided by that of a small swing under gravity alone.
std::vector<double> RelativeDurations(const TurningPointTable& table, const std::vector<double>& amplitude,
                                      Gravity gravity) {
  const double natural_frequency = kPi / table.half_period;
  std::vector<double> durations;
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    const double reading = 0.5 * (amplitude[i] + amplitude[i + 1]);
    const double angle = AngleAmplitude(table.quantity, reading, natural_frequency, gravity);
    durations.push_back((table.points[i + 1].time - table.points[i].time) / gravity.PeriodRatio(angle));
  }
  return durations;
}

/// The median of `count` values from `first` on; fewer at the end.
double MedianFrom(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = begin + static_cast<std::ptrdiff_t>(std::min(count, values.size() - first));
  return Median(std::vector<double>(begin, end));
}

/// The standard deviation of (duration x amplitude) of a half swing: an error of the readings moves a turning
/// point by an amount in proportion to 1/amplitude. Neighbouring durations share a turning point, so that their
/// difference has three times the variance of a duration.
double ScatterOf(const std::vector<double>& durations, const std::vector<double>& amplitude) {
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < durations.size(); ++i) {  // the first may begin at the start of the recording
    sizes.push_back(std::abs(durations[i + 1] - durations[i]) * amplitude[i + 1]);
  }
  constexpr double kSigmaPerMedian = 1.4826;  // of a normal distribution
  return kSigmaPerMedian * Median(std::move(sizes)) / std::sqrt(3.0);
}

/// The duration of the large half swings, the first `count`: the lower of their two middle durations, because noise
/// during the hold adds turning points there. The very first may begin at the start of the recording.
double DurationOfLarge(const std::vector<double>& durations, std::size_t count) {
  std::vector<double> large(durations.begin() + 1, durations.begin() + 1 + static_cast<std::ptrdiff_t>(count));
  const auto middle = large.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::ranges::nth_element(large, middle);
  return *middle;
}

/// The number of turning points whose amplitude is clearly above the noise.
std::size_t CountClear(const TurningPointTable& table, const std::vector<double>& amplitude) {
  constexpr double kClear = 8;
  const double least = kClear * std::max(table.noise, table.resolution);
  const auto small = std::ranges::find_if(amplitude, [&](double value) { return value < least; });
  return static_cast<std::size_t>(small - amplitude.begin());
}

}  // namespace

std::optional<Presliding> FindPresliding(const Recording& used, Gravity gravity) {
  constexpr double kClearlyFaster = 0.05, kFaster = 0.03;
  constexpr double kSignificance = 4;  // as if the errors of the last durations were independent: they cancel in part
  constexpr std::size_t kMinLarge = 4, kMinSmall = 4, kSmoothed = 3;  // half swings
  if (!used.is_calibrated() || (used.quantity != Quantity::kAngle && used.quantity != Quantity::kRate)) {
    return std::nullopt;
  }
  const Result<TurningPointTable> table = FindTurningPoints(used);
  if (!table) return std::nullopt;
  const std::vector<double> amplitude = table->Amplitudes();
  std::vector<double> durations = RelativeDurations(*table, amplitude, gravity);
  const std::size_t clear = CountClear(*table, amplitude);
  if (clear < kMinLarge + kMinSmall + 1) return std::nullopt;
  durations.resize(clear - 1);
  const double large = DurationOfLarge(durations, kMinLarge);
  const double last = MedianFrom(durations, durations.size() - kMinSmall, kMinSmall);
  const double error = ScatterOf(durations, amplitude) / (amplitude[clear - 1] * std::sqrt(kMinSmall));
  if (large - last < std::max(kClearlyFaster * large, kSignificance * error)) return std::nullopt;
  for (std::size_t i = kMinLarge; i < durations.size(); ++i) {
    if (MedianFrom(durations, i, kSmoothed) > (1 - kFaster) * large) continue;
    return Presliding{table->points[i].time, amplitude[i], 1 - last / large};
  }
  return std::nullopt;
}

Warning WarningOf(const Presliding& presliding, const std::string& unit, bool is_left_out) {
  const std::string from = NumberText(presliding.from, 4);
  return {.code = "presliding",
          .finding = "from " + from + " s on, below about " + NumberText(presliding.amplitude, 2) + " " + unit +
                     ", the swings are up to " + NumberText(100 * presliding.faster, 2) +
                     " % faster than the larger ones: before a bearing slides, its friction acts like a spring "
                     "(presliding), as in the law dahl (--model dahl)",
          .explanation = is_left_out ? "they were left out" : "",
          .advice = is_left_out ? "choose another end with --to" : "leave them out with --to " + from,
          .flags = {"model", "to"}};
}

}  // namespace pendulum
