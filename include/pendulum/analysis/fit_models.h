// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/constancy.h"
#include "pendulum/base/status.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One recording, and the fit of each model to it alone.
struct FittedRecording {
  Recording used;                         ///< The samples that all models were fitted to, without warnings.
  FreeSwing swing;                        ///< As in SwingFit.
  std::vector<FitReport> fits;            ///< In the order of the requested models; at least one.
  std::string label = {};                 ///< Of several recordings, its name in sentences: "recording 2 (b.csv)".
  std::vector<Constancy> constancy = {};  ///< Constancy of the fits, in their order; or empty.
};

/// `options` for one of several models. Options for parameters that only other models have are left out and listed.
struct OptionsForModel {
  FitOptions options;
  std::vector<std::string> ignored;
};

/// The options for `model`, one of `models`.
OptionsForModel ForModel(const FitOptions& options, const std::string& model, const std::vector<std::string>& models);

/// Names of inertia and of all friction parameters of the models.
std::vector<std::string> PhysicalNames(const std::vector<std::string>& models);

/// The checks of FitModels before its first fit. Cheap. Errors as CheckSwing for the richest law.
Result<void> CheckModels(const Recording& recording, const FreeSwing& swing, const FitOptions& options,
                         const std::vector<std::string>& models);

/// Fits each model to one free swing. The richest law among the models determines the window (FitSwing) and the kind of
/// start. All fits use the noise family chosen for the model with the smallest residuals, and the readings as recorded.
/// With one model the result equals that of FitSwing, which may correct them. Errors as FitSwing; if the richest law
/// can be fitted and another model cannot, its report is kFailed.
Result<FittedRecording> FitModels(Recording recording, const FreeSwing& swing, const FitOptions& options,
                                  const std::vector<std::string>& models);

}  // namespace pendulum
