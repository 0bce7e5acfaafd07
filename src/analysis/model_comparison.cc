// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/model_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "pendulum/analysis/comparison_parts.h"
#include "pendulum/analysis/nested_tests.h"
#include "pendulum/analysis/recommendation.h"

namespace pendulum {
namespace {

void SetCorrelatedLikelihood(const FittedModels& fitted, const FitReport& fit, const Autocorrelation& like,
                             const FitOptions& options, ComparisonRow& row) {
  const std::optional<CorrelatedResiduals> data = ResidualsOf(fitted.used, fit, options, true);
  const auto likelihood = data ? MaximizeCorrelatedLikelihood(*data, like, options.stop) : std::nullopt;
  if (!likelihood) {
    row.judged = false;
    row.reason =
        "the likelihood of its residuals cannot be computed with the autocorrelation of the best model's residuals";
    return;
  }
  row.log_likelihood = likelihood->log_likelihood + SumOfLogLevelWidths(fitted.used);
  row.parameters += likelihood->parameters - 1;
}

void SetLikelihoods(const FittedModels& fitted, const FitReport& best, const FitOptions& options,
                    Comparison& comparison) {
  const auto samples = static_cast<double>(fitted.used.size());
  for (std::size_t i = 0; i < fitted.fits.size(); ++i) {
    ComparisonRow& row = comparison.rows[i];
    const FitReport& fit = fitted.fits[i];
    if (!row.judged || comparison.likelihood == Likelihood::kNone) continue;
    double counted = samples;
    if (comparison.likelihood == Likelihood::kIndependent) {
      row.log_likelihood = fit.statistics.log_likelihood;
    } else if (comparison.likelihood == Likelihood::kScaled) {
      row.log_likelihood = ScaledLikelihood(fit, best, samples);
      counted = comparison.effective_samples;
    } else {
      SetCorrelatedLikelihood(fitted, fit, SharedAutocorrelation(best), options, row);
    }
    SetCriteria(counted, comparison.effective_samples, row);
  }
  SetDifferences(comparison.rows);
}

void SetPredictions(const FittedModels& fitted, const FitOptions& options, Comparison& comparison) {
  std::vector<std::string> models;
  for (const FitReport& fit : fitted.fits) models.emplace_back(fit.model.name);
  for (std::size_t i = 0; i < fitted.fits.size(); ++i) {
    if (fitted.fits[i].termination != Termination::kConverged) continue;
    const FitOptions own = ForModel(options, models[i], models).options;
    comparison.rows[i].cross_validation = CrossValidate(fitted.used, fitted.fits[i], own);
    comparison.rows[i].forward = PredictForward(fitted.used, fitted.fits[i], own);
  }
}

ComparedRuns AsCompared(const FittedModels& fitted) {
  ComparedRun run{fitted.used, {}};
  for (const FitReport& fit : fitted.fits) run.fits.push_back(&fit);
  std::vector<std::string> models;
  for (const FitReport& fit : fitted.fits) models.emplace_back(fit.model.name);
  return {{std::move(run)}, PhysicalNames(models)};
}

}  // namespace

Comparison CompareModels(const FittedModels& fitted, const FitOptions& options, const CompareOptions& how) {
  Comparison comparison;
  for (const FitReport& fit : fitted.fits) comparison.rows.push_back(DescribeFit(fit));
  const FitReport* best = BestFit(fitted.fits);
  if (best == nullptr) {
    comparison.likelihood = Likelihood::kNone;
    comparison.criterion = "none: no fit converged";
    comparison.reason = "no model converged, so none is recommended";
    return comparison;
  }
  comparison.likelihood = ChooseLikelihood(*best, fitted.used.resolution);
  // With ln n >= 2 the penalty is never weaker than that of AIC.
  comparison.effective_samples = std::max(best->statistics.effective_samples, std::exp(2.0));
  comparison.criterion = DescribeLikelihood(comparison.likelihood, *best);
  SetLikelihoods(fitted, *best, options, comparison);
  if (how.predict) SetPredictions(fitted, options, comparison);
  comparison.tests = TestNested(AsCompared(fitted), comparison.rows, options, comparison.likelihood);
  Recommend(fitted.fits, comparison);
  return comparison;
}

}  // namespace pendulum
