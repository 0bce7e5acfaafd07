// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/median.h"

/// Times that a program counted instead of measuring.
namespace pendulum {

/// The last decimal place that any of the numbers uses, 1 to 1e-9: 0.001 for 0.25 and 1.375.
inline double LastPlace(const Eigen::VectorXd& numbers) {
  constexpr double kFinest = 1e-9, kRounding = 1e-4;  // of a place: what binary numbers deviate from decimals
  double place = 1;
  for (const double number : numbers) {
    while (place > kFinest && std::abs(number / place - std::round(number / place)) > kRounding) place /= 10;
  }
  return place;
}

/// The row of each time on a uniform grid, from 0; empty if the times do not increase. The interval is refined on the
/// way, because a single step is rounded.
inline Eigen::VectorXd RowsOf(const Eigen::VectorXd& time) {
  const Eigen::VectorXd steps = time.tail(time.size() - 1) - time.head(time.size() - 1);
  if (!(steps.array() > 0).all()) return {};
  const double median = Median({steps.begin(), steps.end()});
  double sum = 0, count = 0;  // of single steps
  for (const double step : steps) {
    if (std::round(step / median) != 1) continue;
    sum += step;
    ++count;
  }
  Eigen::VectorXd rows(time.size());
  rows[0] = 0;
  for (Eigen::Index i = 0; i < steps.size(); ++i)
    rows[i + 1] = rows[i] + std::max(std::round(steps[i] * count / sum), 1.0);
  return rows;
}

/// Whether all times, increasing, lie on one uniform grid but for the rounding of their last place; rows may be missing
/// if that place is much finer than the grid. A clock that is read in each row shows such times only if its steps are
/// coarser than the scatter of the loop.
inline bool AreOnGrid(const Eigen::VectorXd& time) {
  constexpr double kRounding = 0.75;  // places: half of one, and some for the fitted line
  constexpr double kFine = 0.2;       // of an interval
  if (time.size() < 3) return false;
  const Eigen::VectorXd rows = RowsOf(time);
  if (rows.size() == 0) return false;
  const Eigen::VectorXd from_mean = rows.array() - rows.mean();
  const Eigen::VectorXd later = time.array() - time.mean();
  const double interval = from_mean.dot(later) / from_mean.squaredNorm();
  const double place = LastPlace(time);
  const bool is_complete = rows[rows.size() - 1] == static_cast<double>(rows.size() - 1);
  if (place > kFine * interval && !is_complete) return false;
  return (later - interval * from_mean).cwiseAbs().maxCoeff() <= kRounding * place;
}

}  // namespace pendulum
