// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/swing_information.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pendulum {
namespace {

struct HalfSwing {
  double duration = 0, middle = 0;  // s

  bool IsWithin(double from, double to) const { return middle >= from && middle <= to; }
};

/// Half swing i. The first turning point may be anywhere in a hold.
HalfSwing HalfSwingOf(const FreeSwing& swing, std::size_t i) {
  const double end = swing.turns[i + 1];
  const double begin = i == 0 ? std::clamp(swing.after_hold, swing.turns[0], end) : swing.turns[i];
  return {end - begin, 0.5 * (begin + end)};
}

}  // namespace

double InformationOn(const FreeSwing& swing, double from, double to) {
  double weight = 0, first_moment = 0, second_moment = 0, within = 0;
  for (std::size_t i = 0; i < swing.heights.size(); ++i) {
    const HalfSwing half = HalfSwingOf(swing, i);
    if (!half.IsWithin(from, to)) continue;
    const double time = half.middle - swing.turns.front();  // near 0, so that no digits are lost
    const double own = half.duration * swing.heights[i] * swing.heights[i];
    weight += own;
    first_moment += own * time;
    second_moment += own * time * time;
    within += own * half.duration * half.duration / 12;
  }
  return weight > 0 ? second_moment - first_moment * first_moment / weight + within : 0;
}

std::optional<LeftOut> LeftOutOf(const FreeSwing& swing, double from, double to) {
  LeftOut left_out;
  double largest_inside = 0, largest_outside = 0;
  for (std::size_t i = 0; i < swing.heights.size(); ++i) {
    const bool is_inside = HalfSwingOf(swing, i).IsWithin(from, to);
    double& largest = is_inside ? largest_inside : largest_outside;
    largest = std::max(largest, swing.heights[i]);
    left_out.half_swings += is_inside ? 0 : 1;
    ++left_out.all;
  }
  if (left_out.half_swings == 0 || left_out.half_swings == left_out.all) return std::nullopt;
  left_out.is_largest = largest_outside > largest_inside;
  const double ratio = InformationOn(swing, swing.turns.front(), swing.turns.back()) / InformationOn(swing, from, to);
  left_out.larger_errors = std::sqrt(std::max(ratio, 1.0));
  return left_out;
}

}  // namespace pendulum
