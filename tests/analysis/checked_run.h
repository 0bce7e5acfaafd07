// SPDX-License-Identifier: Apache-2.0
// A fitted recording, its closed forms and their comparison (CheckClosedForms), for tests.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "pendulum/analysis/closed_form_check.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum {

struct CheckedRun {
  FitOfRun run;
  ClosedForms forms;
  ClosedFormCheck check;

  const ClosedFormRow& Row(std::string_view quantity) const {
    const auto row = std::ranges::find(check.rows, quantity, &ClosedFormRow::quantity);
    if (row == check.rows.end()) throw std::runtime_error("no row " + std::string(quantity));
    return *row;
  }

  bool Has(std::string_view quantity) const {
    return std::ranges::find(check.rows, quantity, &ClosedFormRow::quantity) != check.rows.end();
  }
};

inline CheckedRun CheckFit(FitOfRun run) {
  ClosedForms forms = Must(EstimateClosedForms(run.recording, run.fit.model));
  ClosedFormCheck check = CheckClosedForms(run.recording, forms, run.fit, run.rig);
  return {std::move(run), std::move(forms), std::move(check)};
}

/// Simulates the recording, fits a model to it and checks the fit.
inline CheckedRun CheckRun(const SyntheticOptions& run, std::string_view model, const std::optional<Rig>& rig = {}) {
  return CheckFit(FitTo(run, model, rig));
}

/// The textbook rig with noise of 2 mrad.
inline SyntheticOptions NoisyTextbookRun(std::string_view model) {
  SyntheticOptions run = TextbookRun(model);
  run.noise = 0.002;
  return run;
}

}  // namespace pendulum
