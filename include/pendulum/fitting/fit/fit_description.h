// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"
#include "pendulum/fitting/uncertainty/systematic.h"

namespace pendulum {

/// Sets model, start, units and solver: the parts of a report that do not depend on the result.
FitReport InitializeReport(const FittedRun& run);

/// Largest share of the variance that a converged fit may leave unexplained. For correlated residuals, the limit lies
/// between the worst fits of real recordings (0.1) and recordings without a free swing (0.2 and more). Uncorrelated
/// residuals are noise, which may be large.
inline double MaxUnexplainedShare(bool correlated) { return correlated ? 0.12 : 0.8; }

/// A solution compared with the readings, before it is judged.
struct Description {
  FitReport report;                    // with statistics, noise and residuals
  Eigen::VectorXd quantile_residuals;  // N
  TraceSummary trace;
  bool correlated = false;  // the residuals are autocorrelated
};

/// `free_parameters`: number of parameters estimated from these readings.
Description Describe(const FittedRun& run, int free_parameters);

/// The autocorrelation of the residuals. It is estimated only if the residuals may be autocorrelated. optimum: of this
/// recording.
Autocorrelation AutocorrelationOf(const FittedRun& run, const Optimum& optimum, const Description& described);

/// Sets estimates, units and flags, without errors. optimum: of this recording.
void SetParameters(const FittedRun& run, const Optimum& optimum, FitReport& report);

/// Sets covariance and errors of the free parameters of `optimum`, in the units of the report.
void SetCovariance(const FitProblem& problem, const Optimum& optimum, const Errors& errors, FitReport& report);

/// Sets the systematic errors of the parameters, and their covariance.
void SetSystematicErrors(const FitProblem& problem, const std::vector<SystematicCovariance>& covariances,
                         FitReport& report);

/// Sets natural frequency, damping and so on, with their errors. optimum, errors, covariances: of this recording.
void SetDerived(const FittedRun& run, const Optimum& optimum, const Errors& errors,
                const std::vector<SystematicCovariance>& covariances, FitReport& report);

}  // namespace pendulum
