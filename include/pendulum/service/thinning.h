// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Selects samples for a plot. Returns at most `max_indices` increasing indices: the first, the last, and the smallest
/// and the largest value of each of (max_indices - 2) / 2 blocks of equal duration; all indices if there are at most
/// `max_indices`. time: N, s, increasing. value: N, any unit; NaN is never an extreme. max_indices >= 4. O(N).
std::vector<Eigen::Index> Thin(std::span<const double> time, std::span<const double> value, Eigen::Index max_indices);

}  // namespace pendulum
