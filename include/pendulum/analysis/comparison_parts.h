// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/model_comparison.h"
#include "pendulum/fitting/residuals/arma_likelihood.h"

namespace pendulum {

/// The part of a row that needs no other model: parameters, residuals, and the reason if it is not compared.
ComparisonRow DescribeFit(const FitReport& fit);

/// The judged fit with the smallest AICc. Autocorrelated residuals do not exclude the other fits: a wrong law leaves
/// such residuals. nullptr: no fit converged.
const FitReport* BestFit(const std::vector<FitReport>& fits);

/// Residuals of a fit, linearized about its estimates. Parameters at a bound may move away from it if `with_bounded`;
/// otherwise they stay there. std::nullopt: the trajectory cannot be computed.
std::optional<CorrelatedResiduals> ResidualsOf(const Recording& used, const FitReport& fit, const FitOptions& options,
                                               bool with_bounded);

/// The term that converts log L from densities to probabilities of levels; the fits use the same term.
double PerCount(const Recording& used);

/// The autocorrelation that all models share: that of the best model, of low order. Misfit looks like a process of very
/// high order; a low order whitens it nearly as well in a fraction of the time.
Autocorrelation SharedAutocorrelation(const FitReport& best);

/// Describes the likelihood behind the criteria, in words.
std::string DescribeLikelihood(Likelihood likelihood, const FitReport& best);

/// Chooses the likelihood that suits the noise of the best fit. `resolution`: of the readings, in their unit.
Likelihood ChooseLikelihood(const FitReport& best, double resolution);

/// Sets AIC and AICc with `samples`, and BIC with `effective_samples`, for a row that has a log-likelihood.
void SetCriteria(double samples, double effective_samples, ComparisonRow& row);

/// Sets the differences to the best model, and Akaike's weights.
void SetDifferences(std::vector<ComparisonRow>& rows);

}  // namespace pendulum
