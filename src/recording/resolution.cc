// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/resolution.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Levels = std::vector<double>;  // distinct readings, increasing

constexpr std::size_t kMinLevels = 5;
constexpr double kLargestSpread = 0.12;  // rms distance to the levels, in steps; random readings have 0.29

Levels SortedSample(const Eigen::VectorXd& value) {
  constexpr Index kMaxValues = 20000;
  const Index count = std::min(value.size(), kMaxValues);
  Levels sample;
  for (Index i = 0; i < count; ++i) sample.push_back(value[i * value.size() / count]);
  std::ranges::sort(sample);
  return sample;
}

/// Distinct readings. If nearly all occur repeatedly, those that occur only once are omitted, because they are not
/// levels.
Levels DistinctReadings(const Levels& sorted) {
  constexpr double kRounding = 1e-12;  // of a unit conversion
  constexpr double kNearlyAll = 0.9;
  const double same = kRounding * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  Levels all;
  Levels repeated;
  std::size_t repeats = 0;
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i + 1;
    while (end < sorted.size() && sorted[end] - sorted[end - 1] <= same) ++end;
    all.push_back(sorted[i]);
    if (end - i > 1) repeated.push_back(sorted[i]);
    repeats += end - i > 1 ? end - i : 0;
    i = end;
  }
  const bool nearly_all = static_cast<double>(repeats) > kNearlyAll * static_cast<double>(sorted.size());
  return nearly_all ? repeated : all;
}

/// Small gaps between neighbours and fractions of them. If any two levels are adjacent, one of the candidates is
/// nearly the step.
Levels Candidates(const Levels& levels) {
  Levels gaps;
  for (std::size_t i = 1; i < levels.size(); ++i) gaps.push_back(levels[i] - levels[i - 1]);
  std::ranges::sort(gaps);
  Levels candidates;
  for (const double share : {0.0, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5}) {
    const double gap = gaps[static_cast<std::size_t>(share * static_cast<double>(gaps.size() - 1))];
    for (const double part : {1, 2, 3, 4, 5, 6}) candidates.push_back(gap / part);
  }
  std::ranges::sort(candidates, std::greater<>());
  return candidates;
}

/// Improves a step using the distances between levels up to `reach`; std::nullopt if too many distances are not
/// multiples of the step.
std::optional<double> ImprovedStep(const Levels& levels, double step, double reach) {
  constexpr double kNear = 0.25;
  constexpr double kMaxFarShare = 0.3;  // share of the pairs; half for random readings
  constexpr double kOutliers = 2;
  // Omits the highest 2 % of levels, which may be outliers and would otherwise be paired with all levels below.
  const double highest = levels[levels.size() - 1 - levels.size() / 50];
  double sum_of_products = 0;
  double sum_of_squares = 0;
  double far = 0;
  double pairs = 0;
  for (std::size_t i = 0, j = 0; i < levels.size(); ++i) {
    if (highest - levels[i] <= reach) break;
    while (levels[j + 1] - levels[i] <= reach) ++j;
    if (j <= i) {
      j = i;
      continue;
    }
    const double steps = (levels[j] - levels[i]) / step;
    const double whole = std::round(steps);
    ++pairs;
    if (std::abs(steps - whole) > kNear || whole == 0) {
      ++far;
      continue;
    }
    sum_of_products += whole * (levels[j] - levels[i]);
    sum_of_squares += whole * whole;
  }
  if (sum_of_squares == 0 || far > kMaxFarShare * pairs + kOutliers) return std::nullopt;
  return sum_of_products / sum_of_squares;
}

/// The step from a least-squares fit of step and offset, and the rms distance of all levels to the fitted grid.
struct LevelGrid {
  double step = 0;
  double spread = 0;  ///< In steps.
};

/// The offset near the middle at which the phases of all levels agree best.
double CommonOffset(const Levels& levels, double step) {
  const double middle = levels[levels.size() / 2];
  std::complex<double> sum = 0;
  for (const double level : levels) sum += std::polar(1.0, 2 * kPi * (level - middle) / step);
  return middle + step * std::arg(sum) / (2 * kPi);
}

LevelGrid FitLevelGrid(const Levels& levels, double step) {
  constexpr double kNear = 0.25;
  double offset = CommonOffset(levels, step);
  LevelGrid grid{step, 0};
  for (int pass = 0; pass < 3; ++pass) {
    double count = 0, k = 0, v = 0, kk = 0, kv = 0, square = 0;
    for (const double level : levels) {
      const double steps = (level - offset) / grid.step;
      const double whole = std::round(steps);
      square += std::pow(steps - whole, 2);
      if (std::abs(steps - whole) > kNear) continue;
      const double distance = level - offset;
      count += 1, k += whole, v += distance, kk += whole * whole, kv += whole * distance;
    }
    grid.spread = std::sqrt(square / static_cast<double>(levels.size()));
    const double determinant = count * kk - k * k;
    if (determinant <= 0 || pass == 2) break;
    const double slope = (count * kv - k * v) / determinant;
    offset += (v - slope * k) / count;
    grid.step = slope;
  }
  return grid;
}

/// Improves a step over distances that double each time, so that adjacent multiples remain distinguishable.
std::optional<LevelGrid> RefinedGrid(const Levels& levels, double step) {
  const double span = levels.back() - levels.front();
  for (double reach = 1.5 * step; reach < 0.6 * span; reach *= 2) {
    const std::optional<double> improved = ImprovedStep(levels, step, reach);
    if (!improved) return std::nullopt;
    step = *improved;
  }
  return FitLevelGrid(levels, step);
}

/// Whether the levels fit the grid beyond chance: the likelihood ratio of a normal density of their distances to a
/// uniform one exceeds e^16.
bool IsSignificant(const Levels& levels, const LevelGrid& grid) {
  constexpr double kUniform = 0.2420;  // 1/sqrt(2 pi e): spread of a normal density with the entropy of a uniform one
  constexpr double kMinSpread = 1e-3;
  constexpr double kEvidence = 16;
  const double fitted = 2;  // step and offset
  const double gain = std::log(kUniform / std::max(grid.spread, kMinSpread));
  return grid.spread < kLargestSpread && (static_cast<double>(levels.size()) - fitted) * gain > kEvidence;
}

/// True if nearly all readings are distinct and nearly all levels of the grid occur. This is a ramp, not a sensor with
/// levels.
bool IsRamp(const Levels& levels, const LevelGrid& grid, std::size_t readings) {
  constexpr double kNearlyAll = 0.9;
  const double possible = (levels.back() - levels.front()) / grid.step + 1;
  const auto found = static_cast<double>(levels.size());
  return found > kNearlyAll * static_cast<double>(readings) && found > kNearlyAll * possible;
}

}  // namespace

/// Returns the spacing of the sensor's own levels. If more than one in twenty distinct readings lie halfway between
/// these levels, as averages of two readings do, returns the finer spacing.
double FindResolution(const Eigen::VectorXd& value) {
  constexpr double kFinest = 1e-6;
  if (value.size() < static_cast<Index>(kMinLevels)) return 0;
  const Levels sorted = SortedSample(value);
  const Levels levels = DistinctReadings(sorted);
  if (levels.size() < kMinLevels) return 0;
  const double span = levels.back() - levels.front();
  for (const double candidate : Candidates(levels)) {
    if (candidate < kFinest * span) break;
    const std::optional<LevelGrid> grid = RefinedGrid(levels, candidate);
    if (!grid || !IsSignificant(levels, *grid)) continue;
    return IsRamp(levels, *grid, sorted.size()) ? 0 : grid->step;
  }
  return 0;
}

}  // namespace pendulum
