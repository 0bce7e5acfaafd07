// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {

/// Model, start, units and solver: what a report says whatever came out.
FitReport IntroduceFit(const Recording& recording, const FitProblem& problem, const TrajectoryCost& cost,
                       const Solution& solution);

/// A swing that the model describes leaves less of the variance than this, unless it drowns in noise, which does not
/// follow itself: chosen between the real recordings' worst fits (0.1) and what is no free swing (0.2 and more).
inline double MostUnexplained(bool correlated) { return correlated ? 0.12 : 0.8; }

/// A solution beside the readings, before it is judged.
struct Description {
  FitReport report;                    // with statistics, noise and residuals
  Eigen::VectorXd quantile_residuals;  // N
  TraceSummary trace;
  bool correlated = false;  // the residuals follow each other
};

/// `free_parameters`: how many the solution found from these readings.
Description Describe(const Recording& recording, const FitProblem& problem, const TrajectoryCost& cost,
                     const Solution& solution, int free_parameters);

/// The memory of the residuals, looked for where independence is in doubt; z are the quantile residuals, N.
Autocorrelation AutocorrelationOf(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                                  const Optimum& optimum, const Eigen::VectorXd& z, bool correlated);

/// Estimates, units and flags, without errors.
void SetParameters(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                   const Optimum& optimum, const Solution& solution, FitReport& report);

/// Covariance and errors of the free parameters, F as in `optimum`, in the units of the report.
void SetCovariance(const FitProblem& problem, const Optimum& optimum, const Errors& errors, FitReport& report);

/// From the systematic covariance, P x P in the problem's units.
void SetSystematicErrors(const FitProblem& problem, const Eigen::MatrixXd& covariance, FitReport& report);

/// Natural frequency, damping and so on, with errors that follow.
void SetDerived(const FitProblem& problem, const Optimum& optimum, const Errors& errors, const Solution& solution,
                FitReport& report);

}  // namespace pendulum
