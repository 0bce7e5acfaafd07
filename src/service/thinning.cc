// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/thinning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace pendulum {
namespace {

/// Appends the smallest and the largest value of [first, end), in their order; nothing if all are NaN.
void AppendExtremes(std::span<const double> value, std::size_t first, std::size_t end,
                    std::vector<Eigen::Index>& chosen) {
  std::size_t least = end, largest = end;
  for (std::size_t i = first; i < end; ++i) {
    if (std::isnan(value[i])) continue;
    if (least == end || value[i] < value[least]) least = i;
    if (largest == end || value[i] > value[largest]) largest = i;
  }
  if (least == end) return;
  chosen.push_back(static_cast<Eigen::Index>(std::min(least, largest)));
  if (least != largest) chosen.push_back(static_cast<Eigen::Index>(std::max(least, largest)));
}

}  // namespace

std::vector<Eigen::Index> Thin(std::span<const double> time, std::span<const double> value, Eigen::Index max_indices) {
  const std::size_t size = std::min(time.size(), value.size());
  std::vector<Eigen::Index> chosen;
  if (static_cast<Eigen::Index>(size) <= max_indices) {
    chosen.resize(size);
    std::iota(chosen.begin(), chosen.end(), Eigen::Index{0});
    return chosen;
  }
  const Eigen::Index blocks = std::max<Eigen::Index>(max_indices / 2 - 1, 1);
  const double begin = time[0], width = (time[size - 1] - begin) / static_cast<double>(blocks);
  chosen.push_back(0);
  std::size_t first = 1;
  for (Eigen::Index block = 0; block < blocks && first + 1 < size; ++block) {
    const double limit = begin + width * static_cast<double>(block + 1);
    std::size_t end = first;
    while (end + 1 < size && (time[end] < limit || block + 1 == blocks)) ++end;
    AppendExtremes(value, first, end, chosen);
    first = end;
  }
  chosen.push_back(static_cast<Eigen::Index>(size - 1));
  return chosen;
}

}  // namespace pendulum
