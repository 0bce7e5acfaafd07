// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/half_swings.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/median.h"
#include "pendulum/closed_form/extrema.h"

namespace pendulum {
namespace {

using Eigen::Index;

double ZeroOf(const std::vector<Extremum>& extrema) {
  std::vector<double> zeros;
  for (std::size_t i = 1; i + 1 < extrema.size(); ++i) {
    zeros.push_back(0.25 * (extrema[i - 1].value + 2 * extrema[i].value + extrema[i + 1].value));
  }
  return Median(std::move(zeros));
}

double TypicalHalfSwing(const std::vector<Extremum>& extrema) {
  std::vector<double> durations;
  for (std::size_t i = 1; i < extrema.size(); ++i) durations.push_back(extrema[i].time - extrema[i - 1].time);
  return Median(std::move(durations));
}

Index FirstSampleAfter(const Eigen::VectorXd& time, double instant) {
  return std::upper_bound(time.begin(), time.end(), instant) - time.begin();
}

double LongestGap(const Eigen::VectorXd& time, double from, double to) {
  const Index first = std::max<Index>(FirstSampleAfter(time, from) - 1, 0);
  const Index last = std::min<Index>(FirstSampleAfter(time, to), time.size() - 1);
  double gap = 0;
  for (Index i = first; i < last; ++i) gap = std::max(gap, time[i + 1] - time[i]);
  return gap;
}

/// The time at which the reading passes zero between two turning points. Fits a least-squares line of time on reading
/// to the samples within 0.35 of the smaller amplitude, or uses the two samples around the passage.
double CrossingTime(const Recording& recording, double zero, const Extremum& from, const Extremum& to) {
  const double near = 0.35 * std::min(std::abs(from.value - zero), std::abs(to.value - zero));
  double n = 0, sum_y = 0, sum_t = 0, sum_yy = 0, sum_yt = 0;
  Index i = FirstSampleAfter(recording.time, from.time);
  const double sign = to.value > from.value ? 1 : -1;
  double fallback = 0.5 * (from.time + to.time);
  for (; i < recording.size() && recording.time[i] < to.time; ++i) {
    const double y = recording.value[i] - zero;
    const double t = recording.time[i] - from.time;
    if (std::abs(y) < near) {
      n += 1, sum_y += y, sum_t += t, sum_yy += y * y, sum_yt += y * t;
    }
    const double y0 = i > 0 ? recording.value[i - 1] - zero : y;
    if (i > 0 && sign * y0 < 0 && sign * y >= 0) {
      fallback = recording.time[i - 1] + (recording.time[i] - recording.time[i - 1]) * y0 / (y0 - y);
    }
  }
  const double determinant = n * sum_yy - sum_y * sum_y;
  if (n < 4 || !(determinant > 0)) return fallback;
  return from.time + (sum_yy * sum_t - sum_y * sum_yt) / determinant;
}

}  // namespace

Result<HalfSwingTable> TabulateHalfSwings(const Recording& recording) {
  const Result<std::vector<Extremum>> extrema = FindExtrema(recording);
  if (!extrema) return tl::unexpected(extrema.error());
  HalfSwingTable table;
  table.quantity = recording.quantity;
  table.zero = ZeroOf(*extrema);
  const double longest_gap = 0.6 * TypicalHalfSwing(*extrema);
  bool continues = false;
  for (std::size_t i = 1; i < extrema->size(); ++i) {
    const Extremum& from = (*extrema)[i - 1];
    const Extremum& to = (*extrema)[i];
    const bool sides_differ = (from.value > table.zero) != (to.value > table.zero);
    if (!sides_differ || LongestGap(recording.time, from.time, to.time) > longest_gap) {
      continues = false;
      continue;
    }
    table.half_swings.push_back({CrossingTime(recording, table.zero, from, to), std::abs(from.value - table.zero),
                                 std::abs(to.value - table.zero), continues});
    continues = true;
  }
  if (std::none_of(table.half_swings.begin(), table.half_swings.end(),
                   [](const HalfSwing& h) { return h.continues; })) {
    return Error(StatusCode::kFailedPrecondition,
                 "no two half swings follow each other without a gap; record for longer or choose another window");
  }
  return table;
}

}  // namespace pendulum
