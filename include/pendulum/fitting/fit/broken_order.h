// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Why a solution is none of its friction law's: a parameter came out below one that it is never below (OrderOf). Empty
/// when that is not so.
std::string BrokenOrder(const FitProblem& problem, const std::vector<double>& parameters);

/// The report of the simpler law that such a recording asks for, as that of `model`: where the two parameters are equal
/// the rest of the richer law has no effect. It is kNotIdentifiable, for the reason given. Errors as FitRecording.
Result<FitReport> ReportSimplerLaw(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                   const std::string& reason);

}  // namespace pendulum
