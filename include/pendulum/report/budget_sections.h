// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The lines of the error budget of a converged fit: noise, then FitReport::budget, then changes and friction of
/// another law. The parts are in the order of the parameters, 0 for those without an error.
std::vector<BudgetLine> BudgetOf(const FitReport& fit);

/// Where most of the variance of an estimate comes from, in words ("masses and length"), or the short names of the two
/// largest sources ("sensor, noise").
std::string MainSourcesText(double std_error, const SystematicErrors& systematic, const std::optional<Rig>& rig);

/// The error budget as a table, a line each: its size, its type in the sense of the GUM (A: from statistics, B: stated
/// or assumed), where the size comes from, and what it adds to each parameter that has an error. Empty if noise is the
/// only line.
Sections BudgetSections(const FitReport& fit);

/// The same as JSON, with the parts of all parameters.
nlohmann::ordered_json BudgetJson(const FitReport& fit);

/// "Improve first: clock; compare ...: inertia ± 2 %, at best ± 0.3 %.": the line without which the error of
/// inertia or friction would be smallest relative to what it is; empty if it would hardly be smaller, or nothing can be
/// done.
std::string LargestErrorText(const FitReport& fit);

/// What was assumed of sensor and clock: "an angle sensor (--sensor)", and "clock ±1 % for times on an exact grid
/// (--sensor)" if it may matter.
std::vector<std::string> SensorAssumptions(const SensorErrors& sensor);

}  // namespace pendulum
