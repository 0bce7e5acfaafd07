// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_point_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The smallest and largest readings, ignoring a few outliers.
struct Extremes {
  double low = 0, high = 0;
};

/// Unlike the mean, these do not depend on how long the recording continues after the swing.
Extremes ExtremesOf(const Recording& recording) {
  const std::size_t outliers = 2 + static_cast<std::size_t>(recording.size()) / 10000;
  std::vector<double> value(recording.value.begin(), recording.value.end());
  const auto low = value.begin() + static_cast<std::ptrdiff_t>(outliers);
  const auto high = value.end() - 1 - static_cast<std::ptrdiff_t>(outliers);
  std::nth_element(value.begin(), low, value.end());
  std::nth_element(low + 1, high, value.end());
  return {*low, *high};
}

/// The passages through the bottom, which are maxima of the reading.
std::vector<TurningPoint> Bottoms(const Recording& upright, const TurningPointTable& table) {
  constexpr double kAlike = 0.25;  // of the reading's range; the loss of energy in one swing is smaller
  std::vector<TurningPoint> bottoms;
  for (std::size_t i = 0; i < table.half_swings(); ++i) {  // maxima and minima alternate
    if (table.points[i].value > table.points[i + 1].value) bottoms.push_back(table.points[i]);
  }
  // The first entry may be the start of the recording in the middle of a swing.
  if (bottoms.size() < 2) return bottoms;
  const double swing = bottoms[1].value - upright.value.minCoeff();
  if (bottoms[1].value - bottoms[0].value > kAlike * swing) bottoms.erase(bottoms.begin());
  return bottoms;
}

/// Replaces small values around each passage by a line between the values on both sides. Otherwise the square root of
/// the noise would have turning points of its own.
void InterpolatePassages(const std::vector<TurningPoint>& bottoms, double least, Recording& view) {
  Eigen::VectorXd& value = view.value;
  for (const TurningPoint& bottom : bottoms) {
    Index before = bottom.sample;
    Index after = bottom.sample;
    while (before > 0 && std::abs(value[before]) < least) --before;
    while (after + 1 < value.size() && std::abs(value[after]) < least) ++after;
    if (std::abs(value[before]) < least || std::abs(value[after]) < least) continue;
    const double slope = (value[after] - value[before]) / (view.time[after] - view.time[before]);
    for (Index i = before + 1; i < after; ++i) value[i] = value[before] + slope * (view.time[i] - view.time[before]);
  }
}

/// Replaces each reading y by ±sqrt(M - y), with the other sign after each passage (MODEL.md eq. (14.5)). M is
/// interpolated linearly between the readings at the passages.
Recording Unfolded(Recording recording) {
  recording.value *= RadialSide(recording);
  const TurningPointTable table = FindAllTurningPoints(recording);
  const std::vector<TurningPoint> bottoms = Bottoms(recording, table);
  if (bottoms.size() < 2) return recording;
  const double spacing = (bottoms.back().time - bottoms.front().time) / static_cast<double>(bottoms.size() - 1);
  std::size_t next = 0;
  for (Index i = 0; i < recording.size(); ++i) {
    const double time = recording.time[i];
    while (next < bottoms.size() && bottoms[next].time <= time) ++next;
    const TurningPoint& before = bottoms[next == 0 ? 0 : next - 1];
    const TurningPoint& after = bottoms[std::min(next, bottoms.size() - 1)];
    const double step = after.time - before.time;
    const double share = step > 0 ? (time - before.time) / step : 0;
    const double bottom = before.value + share * (after.value - before.value);
    const double side = next % 2 == 0 ? 1 : -1;
    // After the last bottom larger than the noise, no swing is visible.
    const bool is_over = next == bottoms.size() && time > bottoms.back().time + spacing;
    recording.value[i] = is_over ? 0.0 : side * std::sqrt(std::max(bottom - recording.value[i], 0.0));
  }
  InterpolatePassages(bottoms, std::sqrt(table.threshold), recording);
  return recording;
}

}  // namespace

bool IsAlongRod(const Recording& recording) {
  constexpr double kOneSided = 0.5;
  if (recording.shows_gravity) return std::abs(recording.value.mean()) > 0.5 * kStandardGravity;
  const Extremes extremes = ExtremesOf(recording);
  return std::abs(extremes.high + extremes.low) > kOneSided * (extremes.high - extremes.low);
}

double RadialSide(const Recording& recording) {
  if (recording.shows_gravity) return std::copysign(1.0, recording.value.mean());
  const Extremes extremes = ExtremesOf(recording);
  return std::copysign(1.0, extremes.high + extremes.low);
}

Recording TurningPointView(const Recording& recording) {
  if (!HasTurningPointView(recording)) return recording;
  const bool is_folded = recording.quantity == Quantity::kAcceleration && IsAlongRod(recording);
  Recording view = is_folded ? Unfolded(recording) : recording;
  if (is_folded) view.resolution = 0;
  view.quantity = Quantity::kAngle;  // in a fictitious unit, so that no code takes it for radians
  return view;
}

}  // namespace pendulum
