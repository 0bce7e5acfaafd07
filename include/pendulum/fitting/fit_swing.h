// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit.h"

namespace pendulum {

/// Which part of a recording to fit. Times are s on the file's clock.
struct SwingChoice {
  static constexpr int kLongest = 0;
  static constexpr int kAll = -1;

  /// The window's first and last time; NaN: as the data say.
  double from = std::numeric_limits<double>::quiet_NaN();
  double to = std::numeric_limits<double>::quiet_NaN();
  int release = kLongest;  ///< The k-th free swing (from 1), kLongest or kAll.
};

/// The free swings of a recording, and those of them that were asked for.
struct ChosenSwings {
  std::vector<FreeSwing> found;
  std::vector<int> chosen;  ///< Numbers (from 1) of swings in `found`; at least one.
};

/// Finds the free swings and chooses. An end the user gave is the end of the window; with both nothing is looked for.
/// What is sampled too slowly for a pendulum such as the rig's (IsUndersampled) is one swing from end to end.
/// kInvalidArgument: no swing of that number, or an empty window. kFailedPrecondition: as FindFreeSwings.
Result<ChosenSwings> ChooseSwings(const Recording& recording, const SwingChoice& choice,
                                  const std::optional<Rig>& rig = std::nullopt);

struct SwingFit {
  Recording used;   ///< The samples that were fitted, without warnings.
  FreeSwing swing;  ///< What was fitted and why: `from` and `to` may lie further in than what was asked for.
  FitReport fit;
};

/// Fits a free swing. Where more than noise is left, turning points at its ends are left out as long as the rest then
/// fits clearly better by the richest law (warning `disturbed`), or until the fit converges; ends that the user chose
/// stay. A swing that is undersampled goes to FitUndersampled. Warns `left_out` of larger motion outside. What is no
/// pendulum's swing ends kNotConverged, `not_a_pendulum`. Readings before which an angle's zero jumped by whole counts
/// are moved back, in `used` too (`lost_counts`); a zero that jumps otherwise ends kNotConverged, `zero_jumps`, and one
/// that may have jumped is said, `zero_unsteady`. Errors as FitRecording. Cost: that of FitRecording, and where
/// something is wrong some tens of small fits more.
Result<SwingFit> FitSwing(Recording recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
