// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

/// Detects numbers that lost digits at an end of a file but still parse as numbers.
namespace pendulum::csv {

/// Whether the first stamp lost its leading digits: it is far from the other stamps. Needs at least eight stamps.
inline bool IsTruncatedStamp(const Eigen::VectorXd& time) {
  // A lost digit reduces the stamp to a tenth or less. The first step must be longer than the others by the same ratio.
  constexpr double kFar = 10;
  constexpr Eigen::Index kSteps = 7;
  double usual = 0;
  for (Eigen::Index i = 2; i <= kSteps; ++i) usual = std::max(usual, time[i] - time[i - 1]);
  return time[0] >= 0 && kFar * time[0] <= time[1] && time[1] - time[0] > kFar * usual;
}

/// Whether the value in row `last` jumps more than twice as far as any earlier value.
inline bool IsTruncatedValue(const Eigen::VectorXd& value, Eigen::Index last) {
  constexpr double kLeap = 2;  // Ratio to the largest step between other rows.
  const double leap = std::abs(value[last] - value[last - 1]);
  const double usual = (value.segment(1, last - 1) - value.head(last - 1)).cwiseAbs().maxCoeff();
  return usual > 0 && leap > kLeap * usual;
}

}  // namespace pendulum::csv
