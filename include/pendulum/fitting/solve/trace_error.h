// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// The error of the trajectory that a fit is to stay below, rad or rad/s.
double MaxTraceError(const FitProblem& problem, const FitOptions& options);

/// The readings at a solution, and their largest difference to those of a hundredth of the tolerance, which the cost
/// has. False where one of them cannot be traced.
bool MeasureTraceError(TrajectoryCost& cost, double tolerance, Solution& solution);

/// The tolerance to try where the error is too large, and how often to do so.
double FinerTolerance(double tolerance);
inline constexpr int kMostTraceRefinements = 3;

}  // namespace pendulum
