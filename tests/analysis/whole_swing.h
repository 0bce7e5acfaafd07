// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace pendulum
