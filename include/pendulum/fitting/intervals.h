// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit.h"
#include "pendulum/fitting/optimum.h"

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

/// For quantized noise below kQuietSigma resolutions and fewer than some hundred samples near edges of levels: takes
/// estimates, covariance, σ and intervals from draws of the posterior (SamplePosterior) instead, for there no parabola
/// describes the likelihood. False where that is not so, or intervals were asked for by another method.
bool UsePosterior(const FittedModel& fitted, Errors& errors, FitReport& report);

/// Sets the 95 % interval of every parameter that is not fixed by options.interval: estimate ± t std_error within the
/// bounds, the profile of its likelihood, or quantiles of bootstrap estimates. kAuto takes profiles for all where any
/// lies at its bound or within three standard errors of it.
void SetIntervals(const FittedModel& fitted, const Errors& errors, FitReport& report);

/// Sets what the recording can tell of every parameter, from intervals, information and covariance.
void SetIdentifiability(const FitProblem& problem, const Optimum& optimum, FitReport& report);

inline constexpr double kQuietSigma = 0.12;

}  // namespace pendulum
