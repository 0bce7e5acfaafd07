// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Repairs what can be repaired without a model, each with a warning that says how many readings it concerns:
///
///   unwrapped       an angle that jumps by a whole turn where its sensor begins again is continued
///   stale_values    a reading that only repeats the one before while the pendulum moves on is left out
///   spikes          a reading far from what its neighbours on both sides agree on is left out
///
/// Neighbours are four samples before and after; "far" is 12 of their robust standard deviations about a line, and more
/// than four resolutions. At most one reading in ten is left out as a spike; where there are more, none is, and the
/// warning `many_spikes` says so. Cost: a few passes.
Recording RepairValues(Recording recording);

}  // namespace pendulum
