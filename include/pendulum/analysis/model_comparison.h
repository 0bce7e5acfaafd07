// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/joint_fit.h"
#include "pendulum/analysis/prediction.h"
#include "pendulum/fitting/fit/fit.h"

namespace pendulum {

/// The likelihood behind the criteria.
enum class Likelihood {
  kIndependent,  ///< The likelihood of the fits: residuals without autocorrelation.
  kCorrelated,   ///< Gaussian with the autocorrelation of the best model's residuals, and q²/12 for rounding (eq.
                 ///< (9.1)).
  kScaled,       ///< That of the fits, where N autocorrelated readings count as the effective samples.
  kNone,         ///< No criterion, because no fit converged or residuals are rounding; Comparison::criterion says why.
};

/// One model among those compared.
struct ComparisonRow {
  std::string model;
  bool judged = false;  ///< Converged: it has criteria (if there are any) and may be recommended.
  int parameters = 0;   ///< Number of free parameters that are not at a bound 0, including those of the noise.
  double rms = 0;       ///< rad or rad/s, of the residuals.
  std::optional<double> log_likelihood, aic, aicc, bic;  ///< Densities in 1/rad or 1/(rad/s), or probabilities.
  std::optional<double> delta_bic;                       ///< Difference to the smallest BIC.
  std::optional<double> akaike_weight;  ///< exp(-ΔAICc / 2) over their sum (Burnham & Anderson 2002, section 2.9)
  bool is_rounding = false;             ///< Residuals are no larger than the error of the computed trajectory.
  Prediction cross_validation, forward;
  double lag1_correlation = 0;  ///< Lag-1 correlation of the quantile residuals.
  double ljung_box_p = 1;
  bool lack_of_fit = false;  ///< The fit reports that more than noise is left in its residuals.
  std::string reason;        ///< Why the model is not compared; empty if it is compared.
};

/// Test whether a law needs the parameters that it adds to a simpler one.
struct NestedTest {
  std::string simpler, richer;
  std::vector<std::string> added;  ///< Parameters that only the richer law has.
  double statistic = 0;            ///< 2 (log L of richer - log L of simpler), at least 0
  std::string null;                ///< Distribution of the statistic if the simpler law is true, in words.
  std::optional<double> p;
  std::string reason;  ///< Why there is no p; empty if there is one.
};

struct Comparison {
  std::string recommended;  ///< The name of a model; empty if there is none.
  std::string reason;       ///< Sentences: the reason for the recommendation, or why there is none.
  Likelihood likelihood = Likelihood::kIndependent;
  std::string criterion;            ///< The rows' criteria in words, or why there are none.
  double effective_samples = 0;     ///< n of BIC = k ln n - 2 log L
  std::vector<ComparisonRow> rows;  ///< Rows in the order of the fits.
  std::vector<NestedTest> tests;
};

struct CompareOptions {
  bool predict = true;  ///< Cross-validation and forward prediction.
};

/// Compares fits of several models to the same recordings. Recommends the simplest model that converged and is within
/// kWithinBic of the smallest BIC (MODEL.md eq. (9.2)). `options` are those of FitModels.
///
/// Several recordings: compares the joint fits. If the recordings disagree under the law that describes each of them
/// best, compares the fits to each recording alone, because then no law makes the joint fit right. Likelihoods are sums
/// over the recordings. Autocorrelated residuals have a separate autocorrelation for each recording, and the shared
/// parameters are the most likely ones for all recordings. Each recording is predicted from parts of itself. If units
/// differ there is no common rms; the residuals of a recording are then divided by the least σ of any model for this
/// recording.
Comparison CompareModels(const FittedRecordings& fitted, const FitOptions& options, const CompareOptions& how = {});

/// A smaller difference in BIC is no strong evidence (Kass & Raftery, JASA 90:773, 1995). With 2 in its place, a
/// law with a term that is not there had the better BIC in 14 of 100 short recordings of tests/simulator/law_study.py.
inline constexpr double kWithinBic = 6;

}  // namespace pendulum
