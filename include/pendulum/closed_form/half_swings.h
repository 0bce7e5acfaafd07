// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The motion between two successive turning points of the reading, without a gap in the data.
struct HalfSwing {
  double crossing = 0;           ///< s, when the reading passes its zero
  double before = 0, after = 0;  ///< rad or rad/s, |reading - zero| at the turning points before and after
  bool continues = false;        ///< True if the previous half swing in the table ends where this one begins.
};

/// The half swings of a recording about its zero.
struct HalfSwingTable {
  Quantity quantity = Quantity::kAngle;
  Gravity gravity = Gravity::kSine;  ///< The gravity law that the closed forms assume; chosen by the caller.
  /// rad or rad/s: median of (e_{i-1} + 2 e_i + e_{i+1}) / 4 over turning points. Dry friction does not change this
  /// value.
  double zero = 0;
  std::vector<HalfSwing> half_swings;
};

/// Tabulates the half swings. A gap in the data longer than 0.6 of the typical half swing breaks the sequence.
/// kFailedPrecondition: fewer than three turning points, or no two half swings without a gap.
Result<HalfSwingTable> TabulateHalfSwings(const Recording& recording);

}  // namespace pendulum
