// SPDX-License-Identifier: Apache-2.0
#include "closed_form/long_gap.h"

#include <algorithm>

namespace pendulum {

std::vector<Eigen::Index> FindLongGaps(const Recording& recording, double half_period) {
  constexpr double kManyHalfPeriods = 20;
  const Eigen::VectorXd& time = recording.time;
  const double many = kManyHalfPeriods * half_period;
  double recorded = 0;
  std::vector<Eigen::Index> gaps;
  if (!(half_period > 0)) return gaps;
  for (Eigen::Index i = 0; i + 1 < time.size(); ++i) {
    const double step = time[i + 1] - time[i];
    if (step > many) {
      gaps.push_back(i);
    } else {
      recorded += step;
    }
  }
  std::erase_if(gaps, [&](Eigen::Index i) { return time[i + 1] - time[i] <= recorded; });
  return gaps;
}

}  // namespace pendulum
