// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// The maximum permitted error of a fit's trajectory, rad or rad/s.
double MaxTraceError(const FitProblem& problem, const FitOptions& options);

/// Computes the readings at a solution, and their largest difference from readings with a hundredth of the tolerance.
/// `tolerance` is the tolerance of `cost`. Returns false if either trajectory cannot be computed.
bool MeasureTraceError(TrajectoryCost& cost, double tolerance, Solution& solution);

/// The next tolerance to try if the error is too large. It is refined at most kMaxTraceRefinements times.
double FinerTolerance(double tolerance);
inline constexpr int kMaxTraceRefinements = 3;

}  // namespace pendulum
