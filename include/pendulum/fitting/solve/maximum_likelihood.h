// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// The chosen noise family, and the reason.
struct ChosenNoise {
  NoiseFamily family = NoiseFamily::kGaussian;
  std::string why;
};

/// Returns the family that the options request. If they request none: kQuantized if the residuals are smaller than the
/// resolution (rad, rad/s; 0: none), otherwise kGaussian.
ChosenNoise ChooseNoise(const FitOptions& options, double resolution, double residual_std_dev);

/// Continues from the least-squares solution of a search to the maximum likelihood over parameters and σ. Afterwards
/// `cost` uses the final noise, so its sums belong to the likelihood. For Gaussian noise σ² = RSS / (N - free
/// parameters); for quantized noise σ is at least kSmallestSigma resolutions.
void MaximizeLikelihood(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options, Solution& solution);

/// Log-likelihood of all samples at the solution's readings, as in Solution::log_likelihood.
double LogLikelihoodOf(const FitProblem& problem, const Solution& solution);

inline constexpr double kSmallestSigma = 0.05;  ///< In resolutions.

}  // namespace pendulum
