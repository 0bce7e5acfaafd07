// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/solve.h"

namespace pendulum {

/// Why a minimum of the sum of squares does not describe the readings; empty if nothing speaks against it. A search can
/// end at a minimum whose trajectory is not the pendulum's: then a parameter of the sensor or of the start takes the
/// place of the motion. Three signs are sure:
///   - a zero that lies outside the readings, by more than a quarter of their range;
///   - a hysteresis of more than 5 counts of an event-driven encoder, whose play is a fraction of a count;
///   - a start that misses the readings: in the first half swing the best multiple of the trajectory differs from 1 by
///     more than 0.3, although the residuals are no noise (`correlated`) and have 3 % of the variance.
/// Fixed parameters are not judged. Only angles and rates of direct sensors have a zero and a start that are judged.
std::string ImplausibleReason(const FitProblem& problem, const Solution& solution, bool correlated);

/// Why the residuals leave nothing to estimate errors from; empty if they do. Residuals that are no noise and worth at
/// most as many independent readings as there are free parameters cannot test the model.
std::string TooFewEffectiveSamples(double effective_samples, int free_parameters, double unexplained);

}  // namespace pendulum
