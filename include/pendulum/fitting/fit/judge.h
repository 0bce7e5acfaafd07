// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Turns a solution into a report: what converged, what is at its bound, what the data cannot tell, with which errors.
/// Converged means that the Newton step left to make is below 0.1 standard errors in every direction, whatever made the
/// solver stop, and that the trajectory leaves at most 12 % of the readings' variance, or 80 % where the residuals do
/// not follow each other. `recording` is the one the problem was made from; `cost` has the solution's noise.
FitReport Judge(const Recording& recording, const FitOptions& options, const FitProblem& problem, TrajectoryCost& cost,
                Solution solution);

}  // namespace pendulum
