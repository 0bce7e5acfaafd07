// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Whether the samples are means of rounded readings with known levels, so that NoiseFamily::kAveraged can describe
/// them.
bool HasMeans(const FitProblem& problem);

/// Whether means with these residuals (root mean square, in the unit of the readings) may be affected by the rounding
/// of their readings. If not, they are normal variables.
bool MayShowRounding(const FitProblem& problem, double residual_std_dev);

/// Sets the motion of the value during each averaging window, of length `window` [s], at the solution's parameters: to
/// second order in the window for an angle, to first order for other readings.
void SetWindowMotions(const TrajectoryCost& cost, const FitProblem& problem, const Solution& solution, double window,
                      NoiseModel& noise);

/// The noise of means that is likeliest at the solution: σ among some values, the levels among the n that the means
/// allow if they are not known, and the length of the averaging window up to a sampling interval if it is not known.
/// `window` receives the length.
NoiseModel LikeliestAveraging(const TrajectoryCost& cost, const FitProblem& problem, const Solution& solution,
                              double* window);

}  // namespace pendulum
