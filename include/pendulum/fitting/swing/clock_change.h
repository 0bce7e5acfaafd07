// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A time at which the steps between rows change, although nothing shows whether the clock changed or the sampling.
struct StepChange {
  double time;               ///< s.
  double before, after;      ///< s, mean steps without gaps.
  bool is_near_end = false;  ///< Less than a twentieth of the samples is on one side.

  /// "clock_unproven".
  Warning ToWarning() const;
};

/// Refuses times whose clock changes its rate: the steps between rows change at one row, and from there on a swing
/// takes as many rows as before, but not as many seconds. If it takes as many seconds, the sampling changed, which is
/// no fault. is_spring: its period does not depend on the amplitude; otherwise both possibilities must say so. Returns
/// the change if it is neither, as without a half swing on both sides. kDataLoss: the message has the time of the
/// change and the two windows to choose from.
Result<std::optional<StepChange>> CheckClock(const Recording& recording, bool is_spring = false);

}  // namespace pendulum
