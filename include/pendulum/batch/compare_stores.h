// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// A parameter whose estimate is not what it was.
struct MovedParameter {
  std::string id, model, name, unit;
  double before = 0, after = 0;  ///< In `unit`.
  double errors = 0;             ///< Of estimate or error, over the smaller standard error.
};

/// A fit that ended otherwise: "converged", "failed" ...
struct ChangedStatus {
  std::string id, model, before, after;
};

/// A fit that only the store before has.
struct GoneFit {
  std::string id, model;
};

/// What two stores say of the same runs. Both rest on the same recordings, so a difference is no matter of chance.
struct StoreComparison {
  std::int64_t only_before = 0, only_after = 0;  ///< Fits of (run, model) that one of them has.
  std::int64_t fits = 0;                         ///< That both have.
  std::int64_t other_data = 0;                   ///< Runs whose recording is another one now.
  std::int64_t identical = 0;                    ///< Parameters equal bit for bit, error and all,
  std::int64_t rounding = 0;                     ///< within kRounding standard errors, as on another type of CPU,
  std::int64_t within_errors = 0;                ///< within one standard error,
  std::int64_t moved = 0;                        ///< beyond it,
  std::int64_t without_error = 0;                ///< or other values without errors, or in another unit.
  std::int64_t changed_status = 0;
  std::vector<MovedParameter> most_moved;     ///< kMostListed of them at most, the largest first.
  std::vector<ChangedStatus> status_changes;  ///< kMostListed of them at most.
  std::vector<GoneFit> gone;                  ///< Likewise.
  std::vector<std::string> cpus_before, cpus_after;

  static constexpr double kRounding = 1e-9;
  static constexpr int kMostListed = 100;
};

/// Errors: as those of the stores.
Result<StoreComparison> CompareStores(Store& before, Store& after);

}  // namespace pendulum
