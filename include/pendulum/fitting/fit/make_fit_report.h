// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Turns a solution into a report: termination, parameters at bounds, identifiability, and errors. Converged means that
/// the remaining Newton step is below 0.1 standard errors in every direction, regardless of the solver's own stopping
/// criterion. The trajectory must also leave at most 12 % of the readings' variance unexplained, or 80 % if the
/// residuals are not autocorrelated. The problem was made from `recording`; `cost` has the solution's noise.
/// `corrected`: what the readings of `recording` were corrected for.
FitReport MakeFitReport(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                        TrajectoryCost& cost, Solution solution, const Correction& corrected = {});

}  // namespace pendulum
