// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/base/status.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

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
