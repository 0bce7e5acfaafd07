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
  FitOptions options;  ///< Those of `alone`. Priors on shared parameters are taken from the first run.
};

/// The fit of one model to several recordings: some parameters are shared, each recording has its own values of the
/// others.
struct JointFit {
  std::vector<std::string> shared;  ///< Names of the shared parameters, in the model's order.
  /// The results common to all recordings: the shared parameters with their errors, termination, and sums of statistics
  /// (rms, log L, criteria, effective samples; N and k are those of all). Its noise is that of the first recording with
  /// autocorrelated residuals, otherwise of the first. It has no start and no samples of its own.
  FitReport whole;
  /// One report for each recording. All its parameters, errors and covariance are those of the joint fit; noise,
  /// residuals and diagnostics are its own.
  std::vector<FitReport> runs;
  int parameters = 0;  ///< Free parameters of all recordings that are not at a bound 0, and one σ each.

  bool IsShared(std::string_view name) const;
};

/// The number of samples in rms_residual: those that are not censored.
double CountedSamples(const FitReport& fit);

/// Combines the rms of residuals, log L, effective samples, AIC, AICc and BIC of independent recordings. `parameters`
/// is the number for all recordings. The rms is meaningful only if all residuals have the same unit.
FitStatistics SumStatistics(std::span<const FitReport* const> fits, int parameters);

/// Fits one model to K >= 2 recordings of one rig. Each recording has its own start, zero and σ. The named physical
/// parameters that the model has are shared (MODEL.md eq. (10.1)).
///
/// The fit starts from the combined results of the separate fits. Sensors, rates, resolutions and kinds of start may
/// differ; the rig may not. Converged means that Judge accepts the fit and that every recording is explained as well as
/// a separate fit must explain it. Otherwise the recordings are not of one rig. If the errors of the separate fits come
/// from posteriors, the joint estimates combine these as parabolas.
///
/// kInvalidArgument: fewer than two recordings, no shared parameter, another model or rig than the first, or invalid
/// options as in FitRecording.
/// kFailedPrecondition: a recording that cannot be fitted alone.
/// kTryAgain: a stop was requested in the options of any run.
/// Cost: about half of the separate fits.
Result<JointFit> FitJointly(std::span<const JointRun> runs, const std::vector<std::string>& shared);

}  // namespace pendulum
