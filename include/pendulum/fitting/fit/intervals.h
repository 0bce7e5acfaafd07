// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/uncertainty/profile.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {

/// A solution and the results computed around it.
struct FittedModel {
  const FitOptions& options;
  const FitProblem& problem;
  TrajectoryCost& cost;
  Solution& solution;
  const Optimum& optimum;
  const Autocorrelation& correlation;
  const Eigen::VectorXd& quantile_residuals;  // N
};

/// Computes estimates, covariance, σ and intervals from draws of the posterior (SamplePosterior). This is necessary for
/// quantized noise below kSmallSigma resolutions with few samples near the edges of levels, because the likelihood is
/// then not parabolic. Returns an optimum whose free parameters match `errors`; parameters at a bound are free in it.
/// Returns std::nullopt if the noise is larger, the residuals are autocorrelated, or options.interval is not
/// kAuto.
std::optional<Optimum> UsePosterior(const FittedModel& fitted, Errors& errors, FitReport& report);

/// Sets the 95 % interval of every parameter that is not fixed, by the method of options.interval.
void SetIntervals(const FittedModel& fitted, const Errors& errors, FitReport& report);

/// Whether a parameter is at a bound or within three standard errors of one. Its interval is then not symmetric.
bool IsNearBound(const SolveOptions& solve, const Optimum& optimum, const std::vector<double>& parameters,
                 const Eigen::MatrixXd& covariance);

/// Sets intervals of estimate ± t std_error, within the bounds.
void SetCovarianceIntervals(const FitProblem& problem, const Solution& solution, const Optimum& optimum,
                            const Errors& errors, FitReport& report);

/// Sets one parameter's interval and curve.
void SetProfileInterval(const FitProblem& problem, int parameter, const ProfileInterval& interval, FitReport& report);

/// Sets how well the recording determines every parameter, from intervals, information and covariance.
void SetIdentifiability(const FitProblem& problem, const Optimum& optimum, FitReport& report);

inline constexpr double kSmallSigma = 0.12;                                            ///< resolutions
inline constexpr std::string_view kPosteriorIntervals = "quantiles of the posterior";  ///< FitReport::interval_method

}  // namespace pendulum
