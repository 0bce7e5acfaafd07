// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Checks the order of two parameters that the friction law requires (FindOrderedPair). If one is below the other,
/// returns a sentence that explains why the solution is invalid; otherwise an empty string.
std::string OrderViolation(const FitProblem& problem, const std::vector<double>& parameters);

/// Fits the simpler law to which the richer law reduces if the two parameters are equal. Returns the result as a fit of
/// the richer law, kNotIdentifiable with the given reason. Errors as FitRecording.
Result<FitReport> ReportSimplerLaw(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                   const std::string& reason);

}  // namespace pendulum
