// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Refuses times whose clock changes its rate. If the rows become more or less frequent while a swing still takes as
/// many rows, the clock changed; if it still takes as many seconds, the sampling did, which is no fault. Without a half
/// swing on both sides, and if neither is clear, there is no error. kDataLoss: the message has the time of the change
/// and the two windows to choose from.
Result<void> CheckClock(const Recording& recording);

}  // namespace pendulum
