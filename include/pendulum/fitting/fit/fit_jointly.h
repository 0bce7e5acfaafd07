// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One of several recordings of one rig, and its own fit.
struct JointRun {
  const Recording& used;
  const FitReport& alone;
  FitOptions options;  ///< The options of `alone`. Priors on shared parameters are taken from the first run.
};

/// The fit of one model to several recordings: some parameters are shared, each recording has its own values of the
/// others.
struct JointFit {
  std::vector<std::string> shared;  ///< Names of the shared parameters, in the model's order.
  /// The results common to all recordings: the shared parameters with their errors, the termination, and the combined
  /// statistics of all recordings (SumStatistics). The noise is that of the first recording with autocorrelated
  /// residuals, or of the first recording if there is none. Start and samples are empty.
  FitReport whole;
  /// One report for each recording. Its parameters, errors and covariance come from the joint fit. Its noise, residuals
  /// and diagnostics are those of this recording; its suspicions are those of its separate fit.
  std::vector<FitReport> runs;
  int parameters = 0;  ///< Number of unfixed parameters that are not at a bound 0, plus one σ for each recording.

  bool IsShared(std::string_view name) const;
};

/// The number of samples that are not censored. Only these count in rms_residual.
double CountedSamples(const FitReport& fit);

/// Combines the rms of residuals, log L, effective samples, AIC, AICc and BIC of independent recordings. `parameters`
/// is the number for all recordings. The rms is meaningful only if all residuals have the same unit.
FitStatistics SumStatistics(std::span<const FitReport* const> fits, int parameters);

/// Fits one model to K >= 2 recordings of one rig. Each recording has its own start, zero and σ. The named physical
/// parameters that the model has are shared (MODEL.md eq. (10.1)).
///
/// The fit starts from the combined results of the separate fits. Sensors, sample rates, resolutions and kinds of start
/// may differ between recordings; the rig must be the same. Whether the fit is converged is judged as for one recording
/// (MakeFitReports). Too much unexplained variance suggests recordings of different rigs. If a separate fit has its
/// errors from a posterior, the joint estimates come from a combination of the separate results, in which each
/// log-likelihood is approximated by a parabola (UsePosteriors). The first run's options say which intervals are
/// computed; without intervals (kNone) there are no errors.
///
/// kInvalidArgument: fewer than two recordings, no shared parameter, a recording with another model or rig than the
/// first, bootstrap intervals, or invalid options as in FitRecording.
/// kFailedPrecondition: a recording that cannot be fitted alone.
/// kTryAgain: a stop was requested in the options of any run.
/// Cost: about half of the separate fits.
Result<JointFit> FitJointly(std::span<const JointRun> runs, const std::vector<std::string>& shared);

}  // namespace pendulum
