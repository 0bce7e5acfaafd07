// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "batch/run_groups.h"
#include "batch/sqlite.h"
#include "pendulum/batch/store.h"
#include "pendulum/batch/store_summary.h"

namespace pendulum {

RunCounts CountRuns(SQLite::Database& database, const StoreMeta& meta);

/// The law of the conclusions: of the fitted recordings that have repeats (of all, if none has), the law that was most
/// often recommended or the only one. Otherwise the first model with a converged fit.
std::string MainLaw(SQLite::Database& database, const StoreOverview& overview, const RunGroups& groups);

/// Whether the errors of a law agree with the scatter between recordings. `quantities`: those of the summary.
/// `left_out`: whether recordings that disagree are left out.
ErrorVerdict VerdictOf(const std::string& law, const std::vector<QuantitySummary>& quantities, const RunGroups& groups,
                       bool left_out);

}  // namespace pendulum
