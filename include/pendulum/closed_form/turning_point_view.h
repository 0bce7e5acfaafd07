// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Whether an acceleration was measured along the rod rather than across it. Its readings are near g or, without
/// gravity, lie on one side of zero only.
bool IsAlongRod(const Recording& recording);

/// The sign of readings along the rod: 1 if the axis points to the pivot.
double RadialSide(const Recording& recording);

/// Whether turning points are searched in a transformed recording.
inline bool HasTurningPointView(const Recording& recording) {
  return recording.quantity != Quantity::kAngle && recording.quantity != Quantity::kRate;
}

/// The recording in which turning points are searched. An angle or a rate stays as it is. A coordinate, or an
/// acceleration across the rod, counts as an angle in an unknown unit. An acceleration along the rod becomes ±sqrt(M -
/// a) with M the reading at the bottom. This is proportional to sin(θ/2) (MODEL.md eq. (14.5)) and changes its sign at
/// each bottom.
Recording TurningPointView(const Recording& recording);

}  // namespace pendulum
