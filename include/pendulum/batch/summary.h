// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// Options for the summary of a store.
struct SummaryOptions {
  std::string group_by;  ///< A manifest column: runs with equal values are of one rig. Empty: the column `rig` if it
                         ///< names several rigs, otherwise all runs are of one rig.
  std::string trend_by;  ///< A manifest column of numbers or ISO 8601 dates; empty: the position in the manifest.
};

/// Statistics of all refitted runs as JSON (summary.schema.json). It counts fits by model and status, recommendations
/// and failures. For each parameter of the converged fits it has the distribution, the outliers, the repeatability
/// within groups compared with the errors, and the trend. Only one parameter of one model is in memory.
/// kInvalidArgument: the manifest has no such column. kFailedPrecondition: no run was refitted. Other errors: of the
/// store.
Result<nlohmann::ordered_json> Summarize(Store& store, const SummaryOptions& options);

}  // namespace pendulum
