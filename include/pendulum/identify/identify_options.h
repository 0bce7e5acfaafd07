// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/warning.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// Which fits are checked. The check against closed forms and the test of constancy take most of the time of a result.
enum class Checks {
  kNone,      ///< No closed forms, no constancy: inconstancy is not counted among the systematic errors.
  kStandard,  ///< The main fit. For several recordings also the constancy of all fits, for the test of agreement.
  kFull,      ///< All fits.
};

/// How to read recordings, which swings to use, which models to fit, and how to fit them.
struct IdentifyOptions {
  ReadOptions read;
  SwingChoice swing;
  std::vector<std::string> models;   ///< In the requested order; several models are compared.
  FitOptions fit;                    ///< Its model is the first of `models`; its rig is replaced by the recording's.
  bool rig_chooses_gravity = false;  ///< A rig with a stiffness gives each model a linear restoring torque.
  Checks checks = Checks::kStandard;
  bool closed_form_only = false;  ///< No fit is made; of `fit`, only the model and the stop token are used.
  nlohmann::ordered_json rig_values = nlohmann::ordered_json::object();  ///< They replace those of a rig file.
  std::optional<SensorStatement> sensor;  ///< Replaces what a recording states about its sensor.
  std::vector<Warning> notes;             ///< What was assumed about the options, for the warnings of the report.
  std::vector<std::string> shared;  ///< For a joint identification: names of the parameters that all recordings share.
};

/// The options for reading, with the window of the fit.
inline ReadOptions ReadOptionsOf(const IdentifyOptions& options) {
  ReadOptions read = options.read;
  read.window = {options.swing.from, options.swing.to};
  return read;
}

}  // namespace pendulum
