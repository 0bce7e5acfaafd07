// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/run_options.h"
#include "pendulum/batch/run_parts.h"
#include "pendulum/recording/recording.h"
#include "pendulum/report/run_report.h"

namespace pendulum {

/// One free swing of one recording, fitted, or with its closed forms only; or several together.
struct FitRun {
  RunReport report;
  std::vector<Recording> used;  ///< The samples of the swing, or of each recording of a joint fit.
};

/// Fits the chosen swings of one recording one by one, with all that is concluded from the fits. One that cannot be
/// fitted keeps its place with its error: as FitModels, or kFailedPrecondition where neither fits nor closed forms were
/// found; of several swings, the message says which. kTryAgain once options.fit.stop is requested, whatever was ready
/// of the swing by then; those that were done before stay.
std::vector<Result<FitRun>> FitRuns(const RunOptions& options, ReadSwings one);

/// The exit code of a run: that of its fit, of several the recommended one; 0 for closed forms alone.
int ExitCodeOf(const FitRun& run);

}  // namespace pendulum
