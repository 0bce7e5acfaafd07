// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit_problem.h"

namespace pendulum {

/// The noise family for residuals of that standard deviation, rad or rad/s, and why.
struct ChosenNoise {
  NoiseFamily family = NoiseFamily::kGaussian;
  std::string why;
};

/// Quantized where the options ask for it, or leave the choice and the residuals are below one resolution: there
/// rounding errors are no white noise (Widrow & Kollár, Quantization Noise, Cambridge 2008, section 5.1). resolution:
/// of the readings, 0 for none.
ChosenNoise ChooseNoise(const FitOptions& options, double resolution, double residual_std_dev);

/// From the least squares of a search on to the largest likelihood of its noise family: parameters (Solve) and σ in
/// turn, until σ stays the same. The other minima that came near are solved as well, and the likeliest wins.
///
/// `cost` keeps the noise, so that its sums are those of the likelihood. Gaussian noise has σ² = RSS / (N - free
/// parameters), and then nothing is solved again unless priors weigh in. Quantized noise has σ of at least
/// kSmallestSigma resolutions: below, the likelihood has no maximum inside, and SamplePosterior has the say.
void MaximizeLikelihood(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options, Solution& solution);

inline constexpr double kSmallestSigma = 0.05;

}  // namespace pendulum
