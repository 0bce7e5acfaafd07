// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Refuses times whose clock changes its rate: the steps between rows change at one row, and from there on a swing
/// takes as many rows as before, but not as many seconds. If it takes as many seconds, the sampling changed, which is
/// no fault. is_spring: its period does not depend on the amplitude; otherwise both possibilities must say so. Without
/// a half swing on both sides there is no error. kDataLoss: the message has the time of the change and the two windows
/// to choose from.
Result<void> CheckClock(const Recording& recording, bool is_spring = false);

}  // namespace pendulum
