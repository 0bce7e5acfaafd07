// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// A parameter whose estimate has changed.
struct MovedParameter {
  std::string id, model, name, unit;
  double before = 0, after = 0;  ///< Estimates in `unit`.
  double errors = 0;             ///< The larger change (estimate or its error), divided by the smaller standard error.
};

/// A fit whose status has changed, such as from "converged" to "failed".
struct ChangedStatus {
  std::string id, model, before, after;
};

/// A fit that is only in the first store, or stale in the second.
struct RemovedFit {
  std::string id, model;
};

/// The differences between two stores for the same runs. Both use the same recordings, so a difference is not due to
/// chance.
struct StoreComparison {
  std::int64_t only_before = 0, only_after = 0;    ///< Fits (run, model) in only one of the stores.
  std::int64_t fits = 0;                           ///< Fits in both stores.
  std::int64_t stale_before = 0, stale_after = 0;  ///< Fits that are left out: statistics of their store do so, too.
  std::int64_t other_data = 0;                     ///< Runs whose recording has changed.
  std::int64_t renamed = 0;                        ///< Runs of the same recording under another id.
  std::int64_t identical = 0;                      ///< Parameters equal bit for bit, including the error.
  std::int64_t rounding = 0;                       ///< Equal within kRounding standard errors; typical of another CPU.
  std::int64_t within_errors = 0;                  ///< Equal within one standard error.
  std::int64_t moved = 0;                          ///< Different by more than one standard error.
  std::int64_t without_error = 0;                  ///< Different values without standard errors or in different units.
  std::int64_t changed_status = 0;
  std::vector<MovedParameter> most_moved;     ///< At most kMaxListed, the largest change first.
  std::vector<ChangedStatus> status_changes;  ///< At most kMaxListed.
  std::vector<RemovedFit> removed;            ///< At most kMaxListed.
  std::vector<std::string> cpus_before, cpus_after;

  static constexpr double kRounding = 1e-9;
  static constexpr int kMaxListed = 20;
};

/// Compares the results of two stores. Errors: of the stores.
Result<StoreComparison> CompareStores(Store& before, Store& after);

}  // namespace pendulum
