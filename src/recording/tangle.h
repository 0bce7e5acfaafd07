// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include <Eigen/Core>

/// Groups of stamps that are out of order, and the fewest rows to leave out of them.
namespace pendulum {

/// Rows [begin, end) that must be examined together: all previous rows are earlier, all following ones later.
struct Tangle {
  Eigen::Index begin;
  Eigen::Index end;
};

/// All tangles of at least two rows.
inline std::vector<Tangle> FindTangles(const Eigen::VectorXd& time) {
  std::vector<double> earliest_after(time.size(), std::numeric_limits<double>::infinity());
  for (Eigen::Index i = time.size() - 1; i > 0; --i) earliest_after[i - 1] = std::min(earliest_after[i], time[i]);
  std::vector<Tangle> tangles;
  double latest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index begin = 0, i = 0; i < time.size(); ++i) {
    latest = std::max(latest, time[i]);
    if (latest >= earliest_after[i]) continue;
    if (i > begin) tangles.push_back({begin, i + 1});
    begin = i + 1;
  }
  return tangles;
}

/// Marks all rows of the tangle except a longest increasing sequence (patience sorting, O(n log n)).
inline Eigen::Index LeaveOutFewest(const Eigen::VectorXd& time, Tangle tangle, std::vector<bool>& keep) {
  std::vector<Eigen::Index> tails;  // For sequences of each length, the smallest last row.
  std::vector<Eigen::Index> before(tangle.end - tangle.begin,
                                   Eigen::Index{-1});  // The previous row in each row's sequence.
  for (Eigen::Index i = tangle.begin; i < tangle.end; ++i) {
    keep[i] = false;
    const auto place = std::ranges::lower_bound(tails, time[i], {}, [&](Eigen::Index row) { return time[row]; });
    if (place != tails.begin()) before[i - tangle.begin] = *std::prev(place);
    if (place == tails.end()) {
      tails.push_back(i);
    } else {
      *place = i;
    }
  }
  for (Eigen::Index i = tails.back(); i >= 0; i = before[i - tangle.begin]) keep[i] = true;
  return tangle.end - tangle.begin - static_cast<Eigen::Index>(tails.size());
}

}  // namespace pendulum
