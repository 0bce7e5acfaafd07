// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "batch/run_groups.h"
#include "batch/sqlite.h"
#include "pendulum/batch/store_summary.h"

namespace pendulum {

/// Tests the runs of each pendulum under a model, with their stored estimates and covariances, by the rules of a joint
/// fit (EstimatesToCompare). Unlike there, priors are not removed, runs with a parameter at a bound are
/// left out because their estimates without bounds are not stored. A dependence on the amplitude is not examined;
/// instead, changes of parameters within the runs count as errors.
/// Groups of more than 500 runs and batches of more than 20 000 are not tested.
RunAgreement TestRunAgreement(SQLite::Database& database, const std::string& model, const RunGroups& groups);

}  // namespace pendulum
