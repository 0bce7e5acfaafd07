// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/fitting/fit_problem.h"

namespace pendulum {

/// What a user should know of a fit that stands, each with what to do about it:
///
///   saturated             readings at an end of the sensor's range
///   lack_of_fit           residuals follow each other and exceed the noise between neighbours
///   correlated_residuals  residuals follow each other
///   quiet_sensor          noise below half the resolution
///   trace_accuracy        the trajectory's own error is not small against the noise
///   at_bound              a parameter at its bound
///   another_minimum       another number of half swings before the stop explains the data nearly as well
///   stop_is_a_kink        a stop that the data can hardly date
///
/// report: all but its warnings. trace: the trajectory at the solution. correlated: FollowEachOther of the residuals.
std::vector<Warning> FitWarnings(const Recording& recording, const FitProblem& problem, const Solution& solution,
                                 const TraceSummary& trace, bool correlated, const FitReport& report);

}  // namespace pendulum
