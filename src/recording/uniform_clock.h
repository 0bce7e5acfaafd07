// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include <Eigen/Core>

/// Finds uniform clocks that agree with stamps rounded to whole steps.
namespace pendulum {

/// The clocks a + b i, i = 0, 1, ..., that are within half a step of every stamp. All values are in steps.
struct UniformClock {
  double start;            ///< a, the middle of the possible values.
  double slope;            ///< b, the middle of the possible values, > 0.
  double slope_tolerance;  ///< Half the width of the possible values of b.
};

/// The largest b with y_j - y_i + height >= b (j - i) for all i < j. Each pass finds the pair with the largest
/// violation and takes the b of this pair (Dinkelbach). A few passes reach the exact value.
inline double LargestSlope(const Eigen::VectorXd& y, double height) {
  const Eigen::Index last = y.size() - 1;
  for (double slope = (y[last] - y[0] + height) / static_cast<double>(last);;) {
    Eigen::Index highest = 0, from = 0, to = last;
    double highest_offset = y[0], least = y[last] - slope * static_cast<double>(last) - y[0];
    for (Eigen::Index j = 1; j <= last; ++j) {
      const double offset = y[j] - slope * static_cast<double>(j);
      if (offset - highest_offset < least) {
        least = offset - highest_offset;
        from = highest;
        to = j;
      }
      if (offset > highest_offset) {
        highest_offset = offset;
        highest = j;
      }
    }
    const double next = (y[to] - y[from] + height) / static_cast<double>(to - from);
    if (!(next < slope)) return slope;
    slope = next;
  }
}

/// The middle of all clocks that agree with the stamps [whole steps]; std::nullopt if no increasing clock agrees.
/// If stamps are truncated instead of rounded, the slopes are the same, but the true start is half a step later. Needs
/// at least two stamps.
inline std::optional<UniformClock> FindUniformClock(const Eigen::VectorXd& stamps) {
  // Width of the band that contains the stamps: one step, and a little more because a stamp halfway between two steps
  // may be rounded up or down.
  constexpr double kHeight = 1 + 1e-6;
  const double largest = LargestSlope(stamps, kHeight);
  const double least = -LargestSlope(-stamps, kHeight);
  if (!(least > 0) || least > largest) return std::nullopt;
  const double slope = (least + largest) / 2;
  double low = stamps[0], high = stamps[0];
  for (Eigen::Index i = 1; i < stamps.size(); ++i) {
    const double offset = stamps[i] - slope * static_cast<double>(i);
    low = std::min(low, offset);
    high = std::max(high, offset);
  }
  return UniformClock{(low + high) / 2, slope, (largest - least) / 2};
}

}  // namespace pendulum
