// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <boost/random/normal_distribution.hpp>

#include "pendulum/batch/run_statistics.h"

namespace pendulum::run_values {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Values of one rig in order, with a common standard error.
inline RunValues OneGroup(const std::vector<double>& estimates, double std_error = kNone) {
  RunValues values{estimates, {}, {}, {}};
  values.std_error.assign(estimates.size(), std_error);
  values.group.assign(estimates.size(), 0);
  values.order.resize(estimates.size());
  std::iota(values.order.begin(), values.order.end(), 0);
  return values;
}

/// `rigs` rigs whose mean values are 50 apart. Each rig has `runs` normal values with standard deviation `std_dev`; all
/// quoted errors are 1.
inline RunValues NormalRuns(std::size_t rigs, std::size_t runs, double std_dev, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  boost::random::normal_distribution<double> normal(0, std_dev);
  RunValues values;
  for (std::size_t i = 0; i < rigs * runs; ++i) {
    const std::size_t group = i % rigs;
    values.estimate.push_back(100 + 50 * static_cast<double>(group) + normal(engine));
    values.std_error.push_back(1);
    values.group.push_back(group);
    values.order.push_back(static_cast<double>(i));
  }
  return values;
}

}  // namespace pendulum::run_values
