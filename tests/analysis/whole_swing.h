// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "pendulum/analysis/joint_fit.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A free swing whose window is the whole recording.
inline FreeSwing Whole(const Recording& recording) {
  FreeSwing swing;
  swing.from = recording.time[0];
  swing.to = recording.time[recording.size() - 1];
  swing.from_given = swing.to_given = true;
  return swing;
}

/// The only recording, with the fits of each model.
inline FittedRecordings OnlyOne(FittedRecording fitted) {
  FittedRecordings only;
  for (const FitReport& fit : fitted.fits) only.models.emplace_back(fit.model.name);
  only.recordings.push_back(std::move(fitted));
  return only;
}

}  // namespace pendulum
