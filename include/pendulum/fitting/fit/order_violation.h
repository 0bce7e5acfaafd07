// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Checks the order of two parameters that the friction law requires (FindOrderedPair). If one is below the other,
/// returns a sentence that explains why the solution is invalid; otherwise an empty string.
std::string OrderViolation(const FitProblem& problem, const std::vector<double>& parameters);

/// Fits the simpler law in which the two parameters are equal, where the rest of the richer law has no effect. Reports
/// it as a fit of `model`, kNotIdentifiable with the given reason. Errors as FitRecording.
Result<FitReport> ReportSimplerLaw(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                   const std::string& reason);

}  // namespace pendulum
