// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// What statistics of a store leave out, so that it can be removed.
struct Prunable {
  std::vector<std::string> stale_runs;                       ///< Ids of runs with a former result only.
  std::vector<std::string> unlisted_runs;                    ///< Ids of runs that the last refit was not given.
  std::vector<std::pair<std::string, std::int64_t>> models;  ///< Of other runs: models not asked for, numbers of fits.
};

/// kFailedPrecondition: the last refit is not complete, so nothing may be removed. Other errors: of the store.
Result<Prunable> FindPrunable(Store& store);

/// Removes it, and returns what it was. Runs with a former result only are new to the next refit. Errors: as
/// FindPrunable.
Result<Prunable> Prune(Store& store);

}  // namespace pendulum
