// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Of many samples those that a plot needs: the indices, increasing, of at most `most` of them, among which are the
/// first, the last, and the least and the largest value of each of (most - 2) / 2 equal blocks of time; all where there
/// are no more than `most`. time: N, s, increasing. value: N, any unit; NaN is no extreme. most >= 4. O(N).
std::vector<Eigen::Index> Thin(std::span<const double> time, std::span<const double> value, Eigen::Index most);

}  // namespace pendulum
