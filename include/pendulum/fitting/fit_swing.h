// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit.h"

namespace pendulum {

/// Which part of a recording to fit. Times are s on the file's clock.
struct SwingChoice {
  static constexpr int kLongest = 0;
  static constexpr int kAll = -1;

  double from = std::numeric_limits<double>::quiet_NaN();  ///< The window's first time; NaN: as the data say.
  double to = std::numeric_limits<double>::quiet_NaN();    ///< Its last time; NaN: as the data say.
  int release = kLongest;                                  ///< The k-th free swing (from 1), kLongest or kAll.
};

/// The free swings of a recording, and those of them that were asked for.
struct ChosenSwings {
  std::vector<FreeSwing> found;
  std::vector<int> chosen;  ///< Numbers (from 1) of swings in `found`; at least one.
};

/// Finds the free swings between `from` and `to` and chooses. An end that the user gave is the end of the window; with
/// both given nothing is looked for, and the window is what lies between.
///
/// kInvalidArgument: no swing of that number, or an empty window. kFailedPrecondition: as FindFreeSwings.
Result<ChosenSwings> ChooseSwings(const Recording& recording, const SwingChoice& choice);

/// A fit to one free swing.
struct SwingFit {
  Recording used;   ///< The samples that were fitted, without warnings.
  FreeSwing swing;  ///< What was fitted and why: `from` and `to` may lie further in than what was asked for.
  FitReport fit;
};

/// Fits a free swing. Where the fit leaves more than noise, the swing's ends are looked at again by the richest law:
/// turning points at an end are left out while that makes the rest fit clearly better (warning `disturbed`), or until
/// the fit converges; ends that the user chose stay. A swing that is smaller than what lies outside gets the warning
/// `left_out`. One that is no pendulum's ends kNotConverged with the warning `not_a_pendulum` and numbers that say so.
///
/// Errors as FitRecording. Cost: that of FitRecording; where something is wrong, up to ten fits of a few thousand
/// samples more.
Result<SwingFit> FitSwing(Recording recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
