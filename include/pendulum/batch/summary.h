// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// How the runs of a store are looked at.
struct SummaryOptions {
  std::string group_by;  ///< A column of the manifest: runs of one value are of one rig; empty: by `rig` where several
                         ///< are named, else all are.
  std::string trend_by;  ///< A column of the manifest, numbers or ISO 8601 dates; empty: the position in it.
};

/// What the refitted runs say together, as JSON (summary.schema.json): fits by model and status, recommendations and
/// failures counted; of each parameter of the converged fits its distribution, its outliers, its repeatability
/// against the quoted errors within groups, and its trend. Memory: one parameter of one model.
/// kInvalidArgument: the manifest has no such column. kFailedPrecondition: no run was refitted. Else as the store.
Result<nlohmann::ordered_json> Summarize(Store& store, const SummaryOptions& options);

}  // namespace pendulum
