// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/closed_form/turning_points.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Classification of a half swing compared with its neighbours.
enum class Verdict {
  kFree,           ///< Crosses the zero, and loses as much amplitude and takes as long as its neighbours.
  kFreeAfterHold,  ///< The same, but takes more than 1.5 times as long: the turning point before it is a hold.
  kGains,          ///< Gains amplitude permanently: the pendulum was pushed, or lifted by a hand.
  kIrregular       ///< Otherwise: braked, too short, or with lost samples.
};

/// One verdict for each half swing i, from turning point i to i + 1 of FindAllTurningPoints(recording). A single
/// deviating turning point is an outlier and disturbs no half swing. Next to a gap in the samples, a half swing is
/// either kGains or kFree.
std::vector<Verdict> ClassifyHalfSwings(const Recording& recording, const TurningPointTable& table);

}  // namespace pendulum
