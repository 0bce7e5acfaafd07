// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/base/status.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

struct SwingFit {
  Recording used;  ///< The samples that were fitted, without warnings.
  /// The fitted window, with reasons and, if it is shorter than the requested one, with what that costs.
  FreeSwing swing;
  FitReport fit;
  std::string linear_reason = {};  ///< Why the motion is that of a linear oscillator, if the fit was rejected for that.
};

/// The checks of FitSwing before its first fit. Cheap. Errors: those of CheckReadings; kFailedPrecondition: the period
/// is not that of a pendulum. The readings of an undersampled swing are not checked.
Result<void> CheckSwing(const Recording& recording, const FreeSwing& swing, const FitOptions& options);

/// Fits a free swing; an undersampled swing is fitted by FitUndersampled. If the residuals are more than noise,
/// disturbed ends are left out as long as the richest law then fits the remaining window clearly better (warning
/// `ends_trimmed`). If the fit does not converge, the window ends earlier. Ends chosen by the user stay. Larger motion
/// outside the window gives the warning `larger_motion_outside`. A motion that is not a pendulum's ends kNotConverged,
/// with `not_a_pendulum`. If it is a linear oscillator's, options.may_be_spring is set and the unit of the readings is
/// beyond doubt, it is fitted again with a linear restoring torque, with `linear_restoring_torque`. If an angle's zero
/// jumps by whole counts, the later readings are shifted back, also in `used` (`lost_counts`). If the zero jumps by
/// another amount, the fit ends kNotConverged, with `offset_jumps`. A possible jump gives `offset_unsteady`. Small
/// swings to which no friction law applies are named (`presliding`), and left out if the fit of the larger ones
/// improves; a vibration over the swing is named (`vibration`). A swing that few samples show may be fitted as a faster
/// one, or the choice is named (`ambiguous_frequency`). Errors as FitRecording and CheckSwing. Cost: as FitRecording,
/// and some tens of small fits if something is wrong.
Result<SwingFit> FitSwing(Recording recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
