// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/uncertainty/profile.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {

/// A solution and what is known around it.
struct FittedModel {
  const FitOptions& options;
  const FitProblem& problem;
  TrajectoryCost& cost;
  Solution& solution;
  const Optimum& optimum;
  const Autocorrelation& correlation;
  const Eigen::VectorXd& quantile_residuals;  // N
};

/// For quantized noise below kQuietSigma resolutions, with few samples near edges of levels: takes estimates,
/// covariance, σ and intervals from draws of the posterior (SamplePosterior) instead, for there no parabola describes
/// the likelihood. Gives the optimum whose free parameters `errors` then has: those at a bound are among them. Nothing
/// where that is not so, the residuals remember, or options.interval is not kAuto.
std::optional<Optimum> UsePosterior(const FittedModel& fitted, Errors& errors, FitReport& report);

/// Sets the 95 % interval of every parameter that is not fixed, by the method of options.interval.
void SetIntervals(const FittedModel& fitted, const Errors& errors, FitReport& report);

/// Whether a parameter is at a bound or within three standard errors of one: no parabola has its interval.
bool IsNearBound(const SolveOptions& solve, const Optimum& optimum, const std::vector<double>& parameters,
                 const Eigen::MatrixXd& covariance);

/// Estimate ± t std_error, within the bounds.
void SetCovarianceIntervals(const FitProblem& problem, const Solution& solution, const Optimum& optimum,
                            const Errors& errors, FitReport& report);

/// One parameter's interval and curve.
void SetProfileInterval(const FitProblem& problem, int parameter, const ProfileInterval& interval, FitReport& report);

/// Sets what the recording can tell of every parameter, from intervals, information and covariance.
void SetIdentifiability(const FitProblem& problem, const Optimum& optimum, FitReport& report);

inline constexpr double kQuietSigma = 0.12;
inline constexpr std::string_view kPosteriorIntervals = "quantiles of the posterior";  ///< FitReport::interval_method

}  // namespace pendulum
