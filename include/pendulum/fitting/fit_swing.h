// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit.h"

namespace pendulum {

/// A fit to the undisturbed part of a free swing.
struct SwingFit {
  Recording used;             ///< What was fitted.
  FreeSwing swing;            ///< With from, to, begins and ends of what was fitted.
  FitReport fit;
};

Result<SwingFit> FitSwing(const Recording& recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
