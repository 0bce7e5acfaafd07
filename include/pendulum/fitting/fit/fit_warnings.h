// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// What a user should know of a fit that stands, each with what to do about it: saturated (readings at an end of the
/// sensor's range), lack_of_fit or correlated_residuals (they follow each other, and exceed the noise between
/// neighbours), zero_drift, quiet_sensor (noise below half the resolution taken as Gaussian), trace_accuracy (not small
/// against the noise), prior_conflict, at_bound, another_minimum (another number of half swings explains the data
/// nearly as well), stop_is_a_kink (a stop that the data can hardly date). report: all but its warnings. trace: at the
/// solution. quantile_residuals: N. correlated: whether they follow each other.
std::vector<Warning> FitWarnings(const Recording& recording, const FitProblem& problem, const Solution& solution,
                                 const TraceSummary& trace, const Eigen::VectorXd& quantile_residuals, bool correlated,
                                 const FitReport& report);

}  // namespace pendulum
