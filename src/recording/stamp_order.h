// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include <Eigen/Core>

/// Ranges of rows whose time stamps are out of order, and the fewest rows to remove from each.
namespace pendulum {

/// Rows [begin, end) whose stamps are out of order. All rows before them are earlier; all rows after them are later.
struct UnorderedRows {
  Eigen::Index begin;
  Eigen::Index end;
};

/// All ranges of two rows or more.
inline std::vector<UnorderedRows> FindUnorderedRows(const Eigen::VectorXd& time) {
  std::vector<double> earliest_after(time.size(), std::numeric_limits<double>::infinity());
  for (Eigen::Index i = time.size() - 1; i > 0; --i) earliest_after[i - 1] = std::min(earliest_after[i], time[i]);
  std::vector<UnorderedRows> unordered;
  double latest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index begin = 0, i = 0; i < time.size(); ++i) {
    latest = std::max(latest, time[i]);
    if (latest >= earliest_after[i]) continue;
    if (i > begin) unordered.push_back({begin, i + 1});
    begin = i + 1;
  }
  return unordered;
}

/// Keeps a longest increasing sequence of the rows (patience sorting, O(n log n)). Returns how many rows it drops.
inline Eigen::Index DropOutOfOrderRows(const Eigen::VectorXd& time, UnorderedRows rows, std::vector<bool>& keep) {
  std::vector<Eigen::Index> tails;  // For each length, the row with the earliest stamp that ends a sequence.
  std::vector<Eigen::Index> before(rows.end - rows.begin,
                                   Eigen::Index{-1});  // The previous row in each row's sequence.
  for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
    keep[i] = false;
    const auto place = std::ranges::lower_bound(tails, time[i], {}, [&](Eigen::Index row) { return time[row]; });
    if (place != tails.begin()) before[i - rows.begin] = *std::prev(place);
    if (place == tails.end()) {
      tails.push_back(i);
    } else {
      *place = i;
    }
  }
  for (Eigen::Index i = tails.back(); i >= 0; i = before[i - rows.begin]) keep[i] = true;
  return rows.end - rows.begin - static_cast<Eigen::Index>(tails.size());
}

}  // namespace pendulum
