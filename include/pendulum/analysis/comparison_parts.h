// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/model_comparison.h"
#include "pendulum/fitting/residuals/arma_likelihood.h"

namespace pendulum {

/// Whether residuals are as small as the trajectory's numerical error: rounding, not a sensor's noise.
bool IsRounding(const FitReport& fit);

/// The part of a row that needs no other model: parameters, residuals, and the reason if the fit is not compared.
ComparisonRow DescribeFit(const FitReport& fit);

/// The converged fit with the smallest AICc. Fits with autocorrelated residuals are included, because every wrong law
/// leaves such residuals. nullptr: no fit converged.
const FitReport* BestFit(const std::vector<FitReport>& fits);

/// Residuals of a fit, linearized about its estimates. Parameters at a bound may move away from it if `with_bounded`;
/// otherwise they stay at it. std::nullopt: the trajectory cannot be computed.
std::optional<CorrelatedResiduals> ResidualsOf(const Recording& used, const FitReport& fit, const FitOptions& options,
                                               bool with_bounded);

/// N ln q for N readings with resolution q; 0 without a resolution. Added to log L, it converts densities to
/// probabilities of levels; the fits add the same term.
double SumOfLogLevelWidths(const Recording& used);

/// The autocorrelation used for all models: that of the best model, with order 8 at most. Misfit looks like a process
/// of very high order; a low order whitens it nearly as well in a fraction of the time.
Autocorrelation SharedAutocorrelation(const FitReport& best);

/// Describes the likelihood behind the criteria, in words.
std::string DescribeLikelihood(Likelihood likelihood, const FitReport& best);

/// Chooses the likelihood that suits the noise of the best fit. `resolution`: of the readings, in their unit.
Likelihood ChooseLikelihood(const FitReport& best, double resolution);

/// Likelihood::kScaled of a fit: the log-likelihood of independent residuals times the share of the `samples` readings
/// that count as independent, which is that of the best model's residuals for all models (MODEL.md section 9).
double ScaledLikelihood(const FitReport& fit, const FitReport& best, double samples);

/// Sets AIC and AICc with `samples`, and BIC with `effective_samples`, for a row that has a log-likelihood.
void SetCriteria(double samples, double effective_samples, ComparisonRow& row);

/// Sets the differences to the smallest BIC, and Akaike's weights.
void SetDifferences(std::vector<ComparisonRow>& rows);

}  // namespace pendulum
