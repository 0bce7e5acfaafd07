// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Where a search from another start ended.
struct RivalSolution {
  std::vector<double> parameters;  ///< P, the problem's units.
  double log_posterior = 0;        ///< Log-likelihood of samples and priors.
};

/// Of an accelerometer across the rod: the other radius, with the motion to the other side, at which it shows the same
/// but for friction (MODEL.md eq. (75)). Nothing where there is none, or where what is fixed or bounded excludes it.
std::optional<std::vector<double>> MirrorImage(const FitProblem& problem, std::vector<double> parameters);

/// Ends a fit that converged kNotIdentifiable where a rival within 9 of its -2 log L differs by more than three of its
/// standard errors in a parameter of the pendulum, or in a scale or place of the sensor (warning `ambiguous_sensor`).
/// Which side of the motion is called positive is no difference. log_posterior: of the fit.
void ConcludeFromRivals(const FitProblem& problem, std::span<const RivalSolution> rivals, double log_posterior,
                        FitReport& report);

}  // namespace pendulum
