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
/// "Far" is 2 sqrt(2 ln N) + 0.5 standard deviations of the noise there, and two and a half resolutions, from the lines
/// through the two readings before and the two after. At most one reading in ten is left out as a spike; where there
/// are more, none is, and the warning `many_spikes` says so. Cost: a few passes.
Recording RepairValues(Recording recording);

}  // namespace pendulum
