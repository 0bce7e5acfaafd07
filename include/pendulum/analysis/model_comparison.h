// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/prediction.h"
#include "pendulum/fitting/fit/fit.h"

namespace pendulum {

/// What the criteria rest on.
enum class Likelihood {
  kIndependent,  ///< That of the fits: residuals without memory.
  kCorrelated,   ///< Gaussian with the memory of the best model's residuals, and q²/12 for rounding (eq. (49)).
  kNone,         ///< No criterion: a memory of noise below half a count, or of a robust loss; nothing converged.
};

/// One model among those compared.
struct ComparisonRow {
  std::string model;
  bool judged = false;  ///< Converged, so that it has criteria (where there are any) and may be recommended.
  int parameters = 0;   ///< Free ones that are not at a bound 0, those of the noise among them.
  double rms = 0;       ///< rad or rad/s, of the residuals.
  std::optional<double> log_likelihood, aic, aicc, bic;  ///< Of densities in 1/rad, 1/(rad/s); probabilities of levels
  std::optional<double> delta_bic;                       ///< To the smallest.
  std::optional<double> akaike_weight;  ///< exp(-ΔAICc / 2) over their sum (Burnham & Anderson 2002, section 2.9)
  Prediction cross_validation, forward;
  double lag1_correlation = 0;  ///< Of the quantile residuals.
  double ljung_box_p = 1;
  bool lack_of_fit = false;  ///< The fit says that more than noise is left.
  std::string reason;        ///< Why it is not judged; empty when it is.
};

/// Whether a law needs what it adds to a simpler one.
struct NestedTest {
  std::string simpler, richer;
  std::vector<std::string> added;  ///< Parameters
  double statistic = 0;            ///< 2 (log L of richer - log L of simpler), at least 0
  std::string null;                ///< What it follows when the simpler law is true, in words.
  std::optional<double> p;
  std::string reason;  ///< Why there is no p; empty when there is.
};

struct Comparison {
  std::string recommended;  ///< The name of a model; empty when none is.
  std::string reason;       ///< Of the recommendation, or why there is none: sentences.
  Likelihood likelihood = Likelihood::kIndependent;
  std::string criterion;            ///< In words what the rows' criteria are, or why there are none.
  double effective_samples = 0;     ///< n of BIC = k ln n - 2 log L
  std::vector<ComparisonRow> rows;  ///< In the order of the fits.
  std::vector<NestedTest> tests;
};

struct CompareOptions {
  bool predict = true;  ///< Cross-validation and forward prediction.
};

/// Judges fits of several models to the same samples: the simplest that converged and is within kWithinBic of the
/// smallest BIC is recommended (MODEL.md eq. (50)). `options` are those of FitModels.
Comparison CompareModels(const FittedModels& fitted, const FitOptions& options, const CompareOptions& how = {});

inline constexpr double kWithinBic = 2;

}  // namespace pendulum
