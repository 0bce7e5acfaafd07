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

/// The optimum with what is at a bound free, as a posterior within the bounds has it.
Optimum WithoutBounds(const Optimum& optimum);

/// For quantized noise below kQuietSigma resolutions, with few samples near edges of levels: takes estimates,
/// covariance, σ and intervals from draws of the posterior (SamplePosterior) instead, for there no parabola describes
/// the likelihood. fitted.optimum: WithoutBounds. False where that is not so, or options.interval is not kAuto.
bool UsePosterior(const FittedModel& fitted, Errors& errors, FitReport& report);

/// Sets the 95 % interval of every parameter that is not fixed, by the method of options.interval.
void SetIntervals(const FittedModel& fitted, const Errors& errors, FitReport& report);

/// Sets what the recording can tell of every parameter, from intervals, information and covariance.
void SetIdentifiability(const FitProblem& problem, const Optimum& optimum, FitReport& report);

inline constexpr double kQuietSigma = 0.12;

}  // namespace pendulum
