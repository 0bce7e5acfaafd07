// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/swing_information.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pendulum {
namespace {

/// When half swing i begins. The first turning point may be anywhere in a hold.
double BeginOf(const FreeSwing& swing, std::size_t i) {
  return i == 0 ? std::clamp(swing.after_hold, swing.turns[0], swing.turns[1]) : swing.turns[i];
}

}  // namespace

double InformationOn(const FreeSwing& swing, double from, double to) {
  double weight = 0, first_moment = 0, second_moment = 0, within = 0;
  for (std::size_t i = 0; i < swing.heights.size(); ++i) {
    const double duration = swing.turns[i + 1] - BeginOf(swing, i);
    const double middle = BeginOf(swing, i) + 0.5 * duration;
    if (middle < from || middle > to) continue;
    const double time = middle - swing.turns.front();  // near 0, so that no digits are lost
    const double own = duration * swing.heights[i] * swing.heights[i];
    weight += own;
    first_moment += own * time;
    second_moment += own * time * time;
    within += own * duration * duration / 12;
  }
  return weight > 0 ? second_moment - first_moment * first_moment / weight + within : 0;
}

std::optional<LeftOut> LeftOutOf(const FreeSwing& swing, double from, double to) {
  LeftOut left_out;
  double largest_inside = 0, largest_outside = 0;
  for (std::size_t i = 0; i < swing.heights.size(); ++i) {
    const double middle = 0.5 * (BeginOf(swing, i) + swing.turns[i + 1]);
    const bool is_inside = middle >= from && middle <= to;
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
