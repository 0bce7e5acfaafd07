// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The lines of the error budget of a converged fit: noise, then FitReport::budget, then changes and friction of
/// another law. The parts are in the order of the parameters, 0 for those without an error.
std::vector<BudgetLine> BudgetOf(const FitReport& fit);

/// The error budget as a table, a line each: its size, its type in the sense of the GUM (A: from statistics, B: stated
/// or assumed), where the size comes from, and what it adds to the inertia and each friction. Empty without lines.
Sections BudgetSections(const FitReport& fit);

/// The same as JSON, with the parts of all parameters.
nlohmann::ordered_json BudgetJson(const FitReport& fit);

/// "The error of inertia comes mostly from the clock (...); compare ...: ± 2 % becomes ± 0.3 %.": the line whose
/// removal would make the error of inertia or friction smallest relative to what it is; empty if none would make it
/// much smaller, or nobody can do anything about it.
std::string LargestErrorText(const FitReport& fit);

}  // namespace pendulum
