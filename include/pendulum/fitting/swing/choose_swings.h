// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Which part of a recording to fit. Times are s on the file's clock.
struct SwingChoice {
  static constexpr int kMostTelling = 0;
  static constexpr int kAll = -1;

  /// The window's first and last time; NaN: chosen from the data.
  double from = std::numeric_limits<double>::quiet_NaN();
  double to = std::numeric_limits<double>::quiet_NaN();
  int release = kMostTelling;  ///< The k-th free swing (from 1), kMostTelling or kAll.
  bool is_spring = false;      ///< The restoring torque is linear, so the angle may exceed 180 deg.
};

/// The free swings of a recording, and the numbers of the chosen swings.
struct ChosenSwings {
  std::vector<FreeSwing> found;
  std::vector<int> chosen;             ///< Numbers (from 1) of swings in `found`; at least one.
  std::vector<Warning> warnings = {};  ///< About the clock within the chosen swings.
};

/// Finds the free swings and chooses among them. A bound given by the user is used as it is; if both are given and no
/// release is chosen, there is no search. Where the user chooses nothing, the swing is taken that determines the period
/// best (InformationOn). A recording sampled too slowly for a pendulum such as the rig's (IsUndersampled) is one swing
/// from end to end. kInvalidArgument: no swing with that number, or an empty window.
/// kFailedPrecondition: as FindFreeSwings. kDataLoss: as CheckClock.
Result<ChosenSwings> ChooseSwings(const Recording& recording, const SwingChoice& choice,
                                  const std::optional<Rig>& rig = std::nullopt);

}  // namespace pendulum
