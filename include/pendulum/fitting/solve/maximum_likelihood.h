// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// The noise family for residuals of that standard deviation, rad or rad/s, and why.
struct ChosenNoise {
  NoiseFamily family = NoiseFamily::kGaussian;
  std::string why;
};

/// Quantized if the options say so, or leave it open and the residuals are below a resolution (rad, rad/s; 0: none).
ChosenNoise ChooseNoise(const FitOptions& options, double resolution, double residual_std_dev);

/// From the least squares of a search on to the largest likelihood of its noise family, over parameters and σ. `cost`
/// keeps the noise, so that its sums are those of the likelihood. Gaussian noise has σ² = RSS / (N - free parameters),
/// quantized noise a σ of at least kSmallestSigma resolutions.
void MaximizeLikelihood(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options, Solution& solution);

/// Of all samples at the solution's readings, as Solution::log_likelihood.
double LogLikelihoodOf(const FitProblem& problem, const Solution& solution);

inline constexpr double kSmallestSigma = 0.05;

}  // namespace pendulum
