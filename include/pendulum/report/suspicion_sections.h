// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// What the residuals of a fit suggest: each named cause with its size, its significance, whether the estimates allow
/// for it, and what to measure. Empty for a fit without errors.
Sections SuspicionSections(const FitReport& fit);

/// [{"name", "size", "std_error", "unit", "significance", "corrected"}, ...], the strongest first.
nlohmann::ordered_json SuspicionsJson(const FitReport& fit);

/// "gain 1.0 ± 0.1 % (--calibration), backlash 0.05 ± 0.01 deg" of the suspicions that are not corrected, or without
/// flags of those that are.
std::string SuspectedText(const FitReport& fit, bool corrected);

}  // namespace pendulum
