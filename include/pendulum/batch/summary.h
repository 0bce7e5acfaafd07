// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"
#include "pendulum/batch/store_summary.h"

namespace pendulum {

/// Options for the summary of a store.
struct SummaryOptions {
  std::string group_by;  ///< A manifest column: runs with equal values are repeats of one pendulum; or folder, or all.
                         ///< Empty: what the manifest says (columns pendulum, group and rig_id, true values of
                         ///< simulated recordings, rig files), else folders or all runs.
  std::string trend_by;  ///< A manifest column of numbers or ISO 8601 dates; empty: the position in the manifest.
  bool main_law_only = false;      ///< Only the parameters of the main law.
  bool without_runs = false;       ///< Without the list of runs, which reads the results of some hundreds.
  bool without_agreement = false;  ///< Without the test of a joint fit, which reads the results of all runs.
};

/// Checks that the runs of a store can be grouped by this. kInvalidArgument: the manifest has no such column. Other
/// errors: of the store.
Result<void> CheckGroupBy(Store& store, const std::string& group_by);

/// Statistics of all refitted runs. First it says how many recordings were fitted, which
/// of them were taken for repeats of one pendulum, and whether these agree. Runs of different pendulums, and runs that
/// differ grossly although nothing says that they are of one pendulum, are not compared. It counts fits by model and
/// status, recommendations and failures. For each parameter of the converged fits it has the distribution, the
/// outliers, the repeatability within groups compared with the errors, and the trend. Only one parameter of one model
/// is in memory. kInvalidArgument: the manifest has no such column. kFailedPrecondition: no run was refitted. Other
/// errors: of the store.
Result<StoreSummary> Summarize(Store& store, const SummaryOptions& options);

}  // namespace pendulum
