// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One free swing and what each model makes of it.
struct FittedModels {
  Recording used;               ///< The samples that all were fitted to, without warnings.
  FreeSwing swing;              ///< As in SwingFit.
  std::vector<FitReport> fits;  ///< In the order asked for; at least one.
};

/// `options` for one of several models: what they say of parameters that only others have is left out, and named.
struct OptionsForModel {
  FitOptions options;
  std::vector<std::string> ignored;
};

/// The options for `model`, one of `models`.
OptionsForModel ForModel(const FitOptions& options, const std::string& model, const std::vector<std::string>& models);

/// Names of inertia and friction of any of the models.
std::vector<std::string> PhysicalNames(const std::vector<std::string>& models);

/// Fits each model to one free swing: the window is that of the richest law among them (FitSwing), and all begin as it
/// does and have the noise family that the model of the smallest residuals asks for. One model is FitSwing. Errors as
/// FitSwing; what only one of several models cannot do is a report that is kFailed.
Result<FittedModels> FitModels(Recording recording, const FreeSwing& swing, const FitOptions& options,
                               const std::vector<std::string>& models);

}  // namespace pendulum
