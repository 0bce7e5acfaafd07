// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/fitting/effects/check_effects.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"
#include "pendulum/fitting/uncertainty/systematic.h"

namespace pendulum {

/// What is known of several recordings before their common fit is judged.
struct SeparateFits {
  std::vector<const FitReport*> alone;           ///< K, the fit of each recording alone.
  std::vector<SystematicCovariance> systematic;  ///< Of the common fit.
  /// The optimum is the combination of posteriors of the separate fits, so it is that of no likelihood.
  bool are_posteriors = false;
};

/// Turns the solution of a fit to K >= 1 recordings into K reports: termination, parameters at bounds, identifiability,
/// and errors. Converged means that the remaining Newton step is below 0.1 standard errors in every direction,
/// regardless of the solver's own stopping criterion. The trajectories must also leave at most 12 % of the variance of
/// the readings unexplained, or 80 % if the residuals are not autocorrelated. Each cost has the noise of its solution.
/// optimum: at the solution; nullptr if there is no trajectory. separate: of several recordings; nullptr for one.
/// corrected: what the readings of one recording were corrected for.
std::vector<FitReport> MakeFitReports(const SolvedFit& fit, const Optimum* optimum, const SeparateFits* separate,
                                      const Correction& corrected = {});

/// The report of a fit to one recording.
FitReport MakeFitReport(const FittedRun& run, const Correction& corrected = {});

}  // namespace pendulum
