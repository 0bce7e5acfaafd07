// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// The result of a search from another start.
struct AlternativeMinimum {
  std::vector<double> parameters;  ///< P, the problem's units.
  double log_likelihood = 0;       ///< Of the samples.
  double prior_sum = 0;            ///< Of squares, that of the priors.

  double log_posterior() const { return log_likelihood - 0.5 * prior_sum; }
};

/// For an accelerometer that measures across the rod: the solution with another radius and the motion to the other
/// side. Without friction it gives the same readings (MODEL.md eq. (14.6)). Returns std::nullopt if there is no such
/// solution, or if fixed values or bounds exclude it.
std::optional<std::vector<double>> MirrorImage(const FitProblem& problem, std::vector<double> parameters);

/// Changes a converged fit to kNotIdentifiable, with the warning `ambiguous_sensor`, if an alternative solution
/// explains the data nearly as well: its -2 log L is within 9 of the fit's (MODEL.md section 14). The alternative must
/// differ by more than three standard errors in a parameter of the pendulum, or in a scale or position of the sensor.
/// The sign of the motion does not count as a difference. `fit`: the fitted minimum. `effective_share`: effective
/// samples over samples of its residuals; autocorrelated samples tell less than their likelihood as independent ones.
void CheckAlternativeMinima(const FitProblem& problem, std::span<const AlternativeMinimum> alternatives,
                            const AlternativeMinimum& fit, double effective_share, FitReport& report);

}  // namespace pendulum
