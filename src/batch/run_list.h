// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "batch/sqlite.h"
#include "pendulum/batch/store.h"
#include "pendulum/batch/store_summary.h"

namespace pendulum {

/// What the last refit did.
RefitNews NewsOf(SQLite::Database& database, const StoreMeta& meta);

/// The runs of the last refit, at most some hundreds: first those without a result, then those that need a look (with
/// doubts, or among `outliers`, which say how they differ), then those that the last refit tried, then the others, in
/// the order of the manifest.
std::vector<ListedRun> ListRuns(SQLite::Database& database, const StoreMeta& meta,
                                const std::map<std::string, std::string>& outliers);

}  // namespace pendulum
