// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Repairs errors that can be recognized without a model. Each warning gives the number of readings. `unwrapped`: jumps
/// of an angle by a whole turn are removed. `stale_values`: readings repeated while the pendulum moves are left out.
/// `spikes`: readings are left out that lie 2 sqrt(2 ln N) + 0.5 standard deviations of the local noise, plus 2.5
/// resolutions, from both the line through the two previous readings and the line through the two following ones.
/// `many_spikes`: more than a tenth would be spikes, so they are kept. `event_driven`: there are rows only where the
/// value changes.
Recording RepairValues(Recording recording);

}  // namespace pendulum
