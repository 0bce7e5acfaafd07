// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/steady_hold.h"

#include "pendulum/closed_form/steady.h"
#include "pendulum/recording/window.h"

namespace pendulum {
using Eigen::Index;

std::optional<FreeSwing> WithSteadyHold(const Recording& recording, const FreeSwing& swing, double sigma) {
  if (!(swing.hold_from < swing.hold_to)) return std::nullopt;
  const Result<Recording> held = SelectWindow(recording, swing.hold_from, swing.hold_to);
  if (!held) return std::nullopt;
  for (Index first = 0; held->size() - first >= kMinimumSamples; first += (held->size() - first + 1) / 2) {
    if (!IsSteady(held->value.tail(held->size() - first), sigma)) continue;
    FreeSwing with_hold = swing;
    with_hold.from = held->time[first];
    with_hold.begins = {WindowBegin::Reason::kHeld};
    return with_hold;
  }
  return std::nullopt;
}

}  // namespace pendulum
