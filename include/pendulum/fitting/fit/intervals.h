// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {

/// Computes estimates, covariance, σ and intervals of the fit to one recording from draws of the posterior
/// (SamplePosterior). This is necessary for quantized noise below kSmallSigma resolutions with few samples near the
/// edges of levels, because the likelihood is then not parabolic. Returns an optimum whose free parameters match
/// `errors`; parameters at a bound are free in it. Returns std::nullopt if the noise is larger, the residuals are
/// autocorrelated, or options.interval is not kAuto.
std::optional<Optimum> UsePosterior(const FittedRun& run, const Optimum& smooth, Errors& errors, FitReport& report);

/// Whether the options ask for profiles, or a parameter is at a bound or within three standard errors of one. Its
/// interval is then not symmetric.
bool NeedsProfiles(const SolvedFit& fit, const Optimum& optimum, const Errors& errors);

/// Sets intervals of estimate ± t std_error, within the bounds. optimum, errors: of this recording.
void SetCovarianceIntervals(const FittedRun& run, const Optimum& optimum, const Errors& errors, FitReport& report);

/// Sets interval and profile of every parameter that is common to all recordings and not fixed, in all K reports.
void SetProfileIntervals(const SolvedFit& fit, const Optimum& optimum, const std::vector<FitReport*>& reports);

/// Sets the intervals of the fit to one recording from bootstrap fits. quantile_residuals: N.
void SetBootstrapIntervals(const FittedRun& run, const Optimum& optimum, const Eigen::VectorXd& quantile_residuals,
                           FitReport& report);

/// Sets how well the recording determines every parameter, from intervals, information and covariance.
void SetIdentifiability(const FitProblem& problem, const Optimum& optimum, FitReport& report);

inline constexpr double kSmallSigma = 0.12;                                            ///< resolutions
inline constexpr std::string_view kPosteriorIntervals = "quantiles of the posterior";  ///< FitReport::interval_method

}  // namespace pendulum
