// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include <Eigen/Core>

/// Finds uniform clocks that agree with rounded stamps.
namespace pendulum {

/// The true time of row i is between low[i] and high[i], in any unit.
struct StampIntervals {
  Eigen::VectorXd low, high;  ///< N x 1, low <= high.
};

/// The clocks a + b i, i = 0, 1, ..., that are in the interval of every stamp. All values are in the unit of the
/// stamps.
struct UniformClock {
  double start;            ///< a, the middle of the possible values.
  double slope;            ///< b, the middle of the possible values, > 0.
  double slope_tolerance;  ///< Half the width of the possible values of b.
};

/// The largest b with high_j - low_i >= b (j - i) for all i < j. Each pass finds the pair with the largest violation
/// and takes the b of this pair (Dinkelbach). A few passes reach the exact value.
inline double LargestSlope(const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  const Eigen::Index last = low.size() - 1;
  for (double slope = (high[last] - low[0]) / static_cast<double>(last);;) {
    Eigen::Index highest = 0, from = 0, to = last;
    double highest_offset = low[0], least = high[last] - slope * static_cast<double>(last) - low[0];
    for (Eigen::Index j = 1; j <= last; ++j) {
      const double shift = slope * static_cast<double>(j);
      if (high[j] - shift - highest_offset < least) {
        least = high[j] - shift - highest_offset;
        from = highest;
        to = j;
      }
      if (low[j] - shift > highest_offset) {
        highest_offset = low[j] - shift;
        highest = j;
      }
    }
    const double next = (high[to] - low[from]) / static_cast<double>(to - from);
    if (!(next < slope)) return slope;
    slope = next;
  }
}

/// The middle of all clocks that agree with the stamps; std::nullopt if no increasing clock agrees. Needs at least two
/// stamps.
inline std::optional<UniformClock> FindUniformClock(const StampIntervals& stamps) {
  const double largest = LargestSlope(stamps.low, stamps.high);
  const double least = -LargestSlope(-stamps.high, -stamps.low);
  if (!(least > 0) || least > largest) return std::nullopt;
  const double slope = (least + largest) / 2;
  double low = stamps.low[0], high = stamps.high[0];
  for (Eigen::Index i = 1; i < stamps.low.size(); ++i) {
    low = std::max(low, stamps.low[i] - slope * static_cast<double>(i));
    high = std::min(high, stamps.high[i] - slope * static_cast<double>(i));
  }
  return UniformClock{(low + high) / 2, slope, (largest - least) / 2};
}

/// The intervals of stamps rounded to whole steps. They are a little wider, because a stamp halfway between two steps
/// may be rounded up or down. If stamps are truncated instead of rounded, the slopes are the same, but the true start
/// is half a step later.
inline StampIntervals IntervalsOfWholeSteps(const Eigen::VectorXd& steps) {
  constexpr double kHalf = 0.5 + 5e-7;
  return {steps.array() - kHalf, steps.array() + kHalf};
}

}  // namespace pendulum
