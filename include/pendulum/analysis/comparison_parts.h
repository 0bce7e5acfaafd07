// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/model_comparison.h"
#include "pendulum/fitting/residuals/arma_likelihood.h"

namespace pendulum {

/// What a row has without the other models: parameters, residuals, and why it is not judged.
ComparisonRow DescribeFit(const FitReport& fit);

/// The judged fit of the smallest AICc; whether others have memory does not matter, for wrong laws leave some.
/// nullptr: none converged.
const FitReport* BestFit(const std::vector<FitReport>& fits);

/// The residuals of a fit about its estimates; nothing when its motion cannot be traced. Parameters at a bound may move
/// away from it if `with_bounded`, and stay there else.
std::optional<CorrelatedResiduals> ResidualsOf(const Recording& used, const FitReport& fit, const FitOptions& options,
                                               bool with_bounded);

/// log L of probabilities instead of densities, as the fits have it.
double PerCount(const Recording& used);

/// The memory that all models are given: that of the best one, of a low order. What a law does not explain
/// looks like a process of very high order, of which the first few whiten nearly as well in a fraction of the time.
Autocorrelation SharedMemory(const FitReport& best);

/// What the criteria rest on, in words.
std::string DescribeLikelihood(Likelihood likelihood, const FitReport& best);

/// By the noise of the best fit; the resolution is that of its readings, in their unit.
Likelihood ChooseLikelihood(const FitReport& best, double resolution);

/// AIC and AICc of so many samples, BIC of so many effective ones, where there is a log-likelihood.
void SetCriteria(double samples, double effective_samples, ComparisonRow& row);

/// Differences to the best model, and Akaike's weights.
void SetDifferences(std::vector<ComparisonRow>& rows);

}  // namespace pendulum
