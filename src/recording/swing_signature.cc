// SPDX-License-Identifier: Apache-2.0
#include "recording/swing_signature.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pendulum/base/median.h"

namespace pendulum {
namespace {

using Eigen::Index;

struct Range {
  double low, high;
};

/// The values without the extreme thousandths, which may be spikes.
Range RobustRange(std::vector<double> values) {
  const auto rank = static_cast<std::ptrdiff_t>(values.size() / 1000);
  const auto low = values.begin() + rank;
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  const auto high = values.end() - 1 - rank;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

/// A rising crossing of the middle. `low` and `high` are the extremes up to the next one.
struct Crossing {
  double row;
  double low, high;
};

/// The finite ones of a series of values, and their rows.
struct FiniteValues {
  std::vector<double> values, rows;
};

FiniteValues FindFinite(const Eigen::VectorXd& values) {
  FiniteValues found;
  found.values.reserve(values.size());
  found.rows.reserve(values.size());
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    found.values.push_back(values[i]);
    found.rows.push_back(static_cast<double>(i));
  }
  return found;
}

/// The rising crossings after the values were below the middle by more than the hysteresis, and the extremes between.
std::vector<Crossing> FindCrossings(const FiniteValues& finite, double middle, double hysteresis) {
  const std::vector<double>&values = finite.values, &rows = finite.rows;
  std::vector<Crossing> crossings;
  bool was_low = false;
  double at = 0;  // Row of the last rising step through the middle.
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double before = values[i - 1] - middle, now = values[i] - middle;
    if (now < -hysteresis) was_low = true;
    if (before < 0 && now >= 0) at = rows[i - 1] + (rows[i] - rows[i - 1]) * before / (before - now);
    if (was_low && now > hysteresis) {
      crossings.push_back({at, now, now});
      was_low = false;
    }
    if (crossings.empty()) continue;
    crossings.back().low = std::min(crossings.back().low, now);
    crossings.back().high = std::max(crossings.back().high, now);
  }
  return crossings;
}

/// The value in the middle of a swing, above the middle that was assumed: e of successive extremes gives (e1 + 2 e2 +
/// e3) / 4, which a decay hardly changes.
double ZeroOf(const std::vector<Crossing>& crossings) {
  std::vector<double> zeros;
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    zeros.push_back((crossings[i - 1].high + 2 * crossings[i - 1].low + crossings[i].high) / 4);
  }
  return zeros.empty() ? 0 : Median(std::move(zeros));
}

/// Averages over `width` rows; NaN counts as the reading before it.
Eigen::VectorXd Smooth(const Eigen::VectorXd& values, Index width) {
  Eigen::VectorXd sum(values.size() + 1);
  sum[0] = 0;
  double last = 0;
  for (const double value : values) {
    if (std::isfinite(value)) {
      last = value;
      break;
    }
  }
  const double first = last;  // Subtracted, so that a large constant costs no digits.
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) last = values[i];
    sum[i + 1] = sum[i] + last - first;
  }
  const Index count = std::max<Index>(values.size() - width + 1, 0);
  return (sum.segment(width, count) - sum.head(count)) / static_cast<double>(width);
}

}  // namespace

std::optional<SwingSignature> FindSwingSignature(const Eigen::VectorXd& values) {
  constexpr double kHysteresis = 0.25;  // Of the largest amplitude.
  constexpr double kAlike = 0.3;        // Intervals differ by less than this share of their median.
  constexpr double kMostRegular = 0.7;  // Share of such intervals.
  constexpr std::size_t kFewest = 3;
  const FiniteValues finite = FindFinite(values);
  if (finite.values.size() < 2 * kFewest) return std::nullopt;
  const auto [low, high] = RobustRange(finite.values);
  if (!(high > low)) return std::nullopt;
  const double amplitude = (high - low) / 2;
  std::vector<Crossing> crossings = FindCrossings(finite, low + amplitude, kHysteresis * amplitude);
  if (crossings.size() < kFewest) return std::nullopt;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < crossings.size(); ++i) intervals.push_back(crossings[i].row - crossings[i - 1].row);
  const double period = Median(intervals);
  const auto is_alike = [&](double interval) { return std::abs(interval - period) < kAlike * period; };
  const auto regular = static_cast<double>(std::ranges::count_if(intervals, is_alike));
  if (regular < kMostRegular * static_cast<double>(intervals.size()) || period < 2) return std::nullopt;
  const auto swing_of = [](const Crossing& crossing) { return (crossing.high - crossing.low) / 2; };
  SwingSignature found;
  found.rows_per_period = period;
  found.amplitude = amplitude;
  crossings.pop_back();  // its extremes may be cut off
  // Where a swing decays strongly, the middle of its range is not its zero, and times of crossings depend on the decay.
  std::vector<Crossing> again = FindCrossings(finite, low + amplitude + ZeroOf(crossings), kHysteresis * amplitude);
  if (again.size() >= kFewest) {
    intervals.clear();
    for (std::size_t i = 1; i < again.size(); ++i) intervals.push_back(again[i].row - again[i - 1].row);
    again.pop_back();
    crossings = std::move(again);
  }
  constexpr double kDecay = 0.98;
  const auto largest = std::ranges::max_element(crossings, {}, swing_of);
  found.first_amplitude = swing_of(*largest);
  found.last_amplitude = swing_of(crossings.back());
  found.decays = found.last_amplitude < kDecay * found.first_amplitude;
  const auto first = static_cast<std::size_t>(largest - crossings.begin());
  const std::size_t ends = std::min<std::size_t>(2, intervals.size() - first);
  const double late = std::accumulate(intervals.end() - static_cast<std::ptrdiff_t>(ends), intervals.end(), 0.0);
  found.period_ratio = intervals[first] / (late / static_cast<double>(ends));
  return found;
}

Eigen::MatrixXd SwingCovariance(const std::vector<Eigen::VectorXd>& columns, double rows_per_period) {
  constexpr double kWidth = 1.0 / 6;  // Of a period.
  const auto count = static_cast<Index>(columns.size());
  const auto width = std::max<Index>(1, std::lround(kWidth * rows_per_period));
  const auto half = std::max<Index>(1, std::lround(rows_per_period / 2));
  std::vector<Eigen::VectorXd> swings;
  for (const Eigen::VectorXd& column : columns) {
    const Eigen::VectorXd smooth = Smooth(column, width);
    const Index rows = std::max<Index>(smooth.size() - half, 0);
    swings.emplace_back(smooth.tail(rows) - smooth.head(rows));
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j <= i && swings[i].size() > 0; ++j) {
      covariance(i, j) = covariance(j, i) = swings[i].dot(swings[j]) / static_cast<double>(swings[i].size());
    }
  }
  return covariance;
}

double PendulumPeriodRatio(double amplitude) {
  constexpr double kTop = 3.1;  // rad; beyond it the period grows without limit.
  double a = 1, b = std::cos(std::min(std::abs(amplitude), kTop) / 2);
  while (std::abs(a - b) > 1e-12) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

}  // namespace pendulum
