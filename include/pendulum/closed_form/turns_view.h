// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Whether an acceleration is rather that along the rod than that across it: it stands near g, or, without gravity,
/// swings to one side of zero only.
bool IsRadial(const Recording& recording);

/// The sign of readings along the rod: 1 if the axis points to the pivot.
double RadialSide(const Recording& recording);

/// Whether turning points are looked for in another view of it.
inline bool HasOtherView(const Recording& recording) {
  return recording.quantity != Quantity::kAngle && recording.quantity != Quantity::kRate;
}

/// What turning points are looked for in: the recording itself if it is an angle or a rate; a coordinate, or an
/// acceleration across the rod, as an angle in an unknown unit; of an acceleration along the rod ±sqrt(M - a), M the
/// reading at the bottom, which is in proportion to sin(θ/2) (MODEL.md eq. (74)) and changes its sign at each bottom.
Recording TurnsView(const Recording& recording);

}  // namespace pendulum
