// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pendulum/closed_form/turning_points.h"

namespace pendulum {

/// The turning point of a run at which a drive ends: a knee, after which the amplitude decays by a tenth in m half
/// swings (eight or more), and before which it lost in as many less than a fifth of that. Friction alone does not do
/// this: what it takes in a half swing grows with the amplitude, or hardly depends on it. The last knee counts if the
/// amplitude decays to 70 % after it; `run.first` if there is none.
std::size_t EndOfDrive(const TurningPointTable& table, const TurningPointRun& run);

}  // namespace pendulum
