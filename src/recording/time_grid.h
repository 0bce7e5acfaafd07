// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

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

/// Whether all times, increasing, lie on one uniform grid but for the rounding of their last place; rows may be
/// missing. A clock that is read in each row hardly ever shows such times: a loop takes a little longer now and then.
inline bool AreOnGrid(const Eigen::VectorXd& time) {
  constexpr double kMostRounding = 0.05;  // of an interval: coarser times do not show whether they are on a grid
  if (time.size() < 3) return false;
  const Eigen::VectorXd steps = time.tail(time.size() - 1) - time.head(time.size() - 1);
  std::vector<double> sorted(steps.begin(), steps.end());
  std::ranges::nth_element(sorted, sorted.begin() + steps.size() / 2);
  const double step = sorted[static_cast<std::size_t>(steps.size() / 2)];
  if (!(step > 0)) return false;
  Eigen::VectorXd place(time.size());
  place[0] = 0;
  for (Eigen::Index i = 0; i < steps.size(); ++i) place[i + 1] = place[i] + std::round(steps[i] / step);
  const double interval = (time[time.size() - 1] - time[0]) / place[time.size() - 1];
  const double rounding = std::min(LastPlace(time), kMostRounding * interval);
  const Eigen::VectorXd off = time.array() - time[0] - interval * place.array();
  return (steps.array() > 0).all() && off.cwiseAbs().maxCoeff() <= rounding;
}

}  // namespace pendulum
