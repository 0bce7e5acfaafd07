// SPDX-License-Identifier: Apache-2.0
#include "closed_form/long_gap.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Whether the samples after `sample` begin after a long gap.
bool IsLongGap(const Recording& recording, double half_period, Index sample) {
  constexpr double kManyHalfPeriods = 20;
  const double longest = kManyHalfPeriods * half_period;
  const Eigen::VectorXd& time = recording.time;
  const double gap = time[sample + 1] - time[sample];
  if (!(gap > longest)) return false;
  double recorded = 0;
  for (Index i = 1; i < time.size(); ++i) {
    const double step = time[i] - time[i - 1];
    if (step < gap) recorded += step;
  }
  return gap > recorded;
}

}  // namespace

Index BeforeLongGap(const Recording& recording, double half_period, Index first, Index last) {
  while (first < last && !IsLongGap(recording, half_period, first)) ++first;
  return first;
}

Index AfterLongGap(const Recording& recording, double half_period, Index first, Index last) {
  while (last > first && !IsLongGap(recording, half_period, last - 1)) --last;
  return last;
}

}  // namespace pendulum
