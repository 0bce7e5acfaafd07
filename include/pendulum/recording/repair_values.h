// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Repairs what needs no model, each with a warning that says how many readings it concerns: `unwrapped` (an angle's
/// jumps by a whole turn), `stale_values` (repeats while the pendulum moves on), `spikes` (readings that lie 2 sqrt(2
/// ln N) + 0.5 standard deviations of the noise there, and 2.5 resolutions, from the lines through the two before and
/// the two after; more than a tenth are `many_spikes` and stay). `event_driven`: a row only where the value changes.
Recording RepairValues(Recording recording);

}  // namespace pendulum
