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
/// and errors. Converged means that
///   - the trajectories leave at most 12 % of the variance of each recording unexplained, or 80 % if its residuals are
///     not autocorrelated;
///   - the motion lasts at least half a period in some recording, and is plausible in each (ImplausibleReason);
///   - the remaining Newton step is below 0.1 standard errors in every direction, regardless of the solver's own
///     stopping criterion, or a jump of the sum of squares has stopped the search;
///   - autocorrelated residuals are worth more independent readings than there are free parameters.
/// Each cost has the noise of its solution; of several recordings to 0.3 %, but for posteriors.
/// optimum: at the solution; nullptr if there is no trajectory. separate: of several recordings; nullptr for one.
/// corrected: what the readings of one recording were corrected for.
std::vector<FitReport> MakeFitReports(const SolvedFit& fit, const Optimum* optimum, const SeparateFits* separate,
                                      const Correction& corrected = {});

/// The report of a fit to one recording.
FitReport MakeFitReport(const FittedRun& run, const Correction& corrected = {});

}  // namespace pendulum
