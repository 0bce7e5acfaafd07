// SPDX-License-Identifier: Apache-2.0
// A recording with its fit, for tests of functions that take both.
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "pendulum/analysis/homogeneity.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {

/// The textbook's rig, as measured with a scale and a ruler.
inline Rig TextbookRig() {
  return Must(ParseRig(R"({"bob_mass": {"value": 0.380, "std_dev": 0.001}, "rod_mass": 0.095,
                           "rod_length": {"value": 0.43, "std_dev": 0.001}, "gravity": 9.81})",
                       "rig"));
}

struct FitOfRun {
  Recording recording;
  FitReport fit;
  std::optional<Rig> rig;
};

inline FitOfRun FitTo(Recording recording, const FitOptions& options) {
  FitReport fit = Fit(recording, options);
  return {std::move(recording), std::move(fit), options.rig};
}

/// Simulates the recording and fits a model to it.
inline FitOfRun FitTo(const SyntheticOptions& run, std::string_view model, const std::optional<Rig>& rig) {
  FitOptions options = ModelOptions(model);
  options.rig = rig;
  return FitTo(Must(SimulateRecording(run)), options);
}

/// The fit of a recording alone with its constancy, without its samples.
inline RunAlone Alone(const FitReport& fit, const Constancy& constancy) {
  static const Recording recording;
  static const FitOptions options;
  return {"", recording, fit, options, &constancy};
}

}  // namespace pendulum
