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

/// One of several recordings of one rig, and the fit to it alone.
struct JointRun {
  const Recording& used;
  const FitReport& alone;
  FitOptions options;  ///< Those `alone` was made with. Of priors on what is shared, those of the first run count.
};

/// One model fitted to several recordings at once: some parameters are the same in all, the others each has its own.
struct JointFit {
  std::vector<std::string> shared;  ///< Names of the parameters that are shared, in the model's order.
  /// What the recordings have in common: the shared parameters with their errors, how it ended, sums of statistics
  /// (rms, log L, criteria, effective samples; N and k are those of all). Its noise is one recording's, the first's
  /// that remembers or the first's; it has no start and no samples of its own.
  FitReport whole;
  /// The joint solution as each recording sees it: all of its parameters, errors and covariance those of the joint fit,
  /// noise, residuals and diagnostics its own.
  std::vector<FitReport> runs;
  int parameters = 0;  ///< Free ones of all recordings that are not at a bound 0, and σ of each.

  bool IsShared(std::string_view name) const;
};

/// The samples that rms_residual is of: those that are not censored.
double CountedSamples(const FitReport& fit);

/// rms of residuals, log L, effective samples, AIC, AICc and BIC of independent recordings as of one; so many
/// parameters describe all of them. rms has a meaning only where residuals have one unit.
FitStatistics SumStatistics(std::span<const FitReport* const> fits, int parameters);

/// Fits one model to K >= 2 recordings of one rig, each with a start, zero and σ of its own, and with those physical
/// parameters shared that are named and that the model has (MODEL.md eq. (56)). It begins where the fits alone lead;
/// sensors, rates, resolutions and kinds of start may differ, the rig may not. Converged means what Judge says, and
/// that every recording is explained as a fit alone must explain it: what shares no parameters is not of one rig. Where
/// the errors alone come from posteriors, the joint estimates combine these, as parabolas. kInvalidArgument: fewer than
/// two recordings, no shared parameter, another model or rig than the first, and what FitRecording says of options.
/// kFailedPrecondition: a recording that cannot be fitted alone. kTryAgain: a stop was requested in the options of any.
/// Cost: about half of the fits alone.
Result<JointFit> FitJointly(std::span<const JointRun> runs, const std::vector<std::string>& shared);

}  // namespace pendulum
