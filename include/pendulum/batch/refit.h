// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/batch/source.h"
#include "pendulum/batch/store.h"
#include "pendulum/identify/identify_options.h"

namespace pendulum {

/// Progress of a refit: numbers of runs.
struct RefitCounts {
  std::int64_t runs = 0;      ///< Runs in the batch, or in its shard.
  std::int64_t current = 0;   ///< Runs whose rows already have the same data, rig, calibration, options and version.
  std::int64_t refitted = 0;  ///< Runs that were fitted, or tried, again.
  std::int64_t unfitted = 0;  ///< Runs of both kinds that could not be fitted and have no former result.
  std::int64_t restored = 0;  ///< Current runs whose former result is current again.
  std::int64_t renamed = 0;   ///< Refitted runs that were in the store under another id (Store::TakeOver).
  std::int64_t stale = 0;     ///< Runs of both kinds that keep a former result.
  std::int64_t stale_before = 0;  ///< Of these, runs that were not tried again.
  std::int64_t changed = 0;       ///< Runs whose rig or calibration changed during the refit; they need another one.
  bool stopped = false;           ///< Stopped before all runs were processed.

  std::int64_t done() const { return current + refitted; }
};

struct RefitOptions {
  IdentifyOptions run;                          ///< Options of every run; its entry may change some.
  std::optional<std::string> rig, calibration;  ///< JSON, for entries that name none.
  std::optional<Shard> shard;
  int threads = 0;                   ///< Each fits one recording; 0: one per core. Rows do not depend on it.
  bool force = false;                ///< Refits current runs, too.
  bool retry_failed = false;         ///< Refits runs that could not be fitted, too.
  bool replace_by_failures = false;  ///< Otherwise as Store::PutUnlessWorse.
  std::chrono::milliseconds fit_time = std::chrono::minutes(10);  ///< Longest fit; a longer one fails with kTryAgain.
  const std::atomic<bool>* stop = nullptr;  ///< If true, the refit ends soon; runs in progress are left for the next.
  std::string group_by;                     ///< As in SummaryOptions; checked before the fits, which may take hours.
  std::string flags;                        ///< As in StoreMeta.
  std::function<void(const RefitCounts&)> progress;  ///< Called after every run, from any thread, one at a time.
  std::function<Result<void>()> committed;  ///< Called after commits, about once a second; errors end the refit.
};

/// Refits one run. The result is the same as from fit_pendulum.
RunOutcome RefitRun(const Source& source, const ManifestEntry& entry, const RefitOptions& options);

/// Refits the runs of the source that have no rows yet, or whose rows have another provenance than new rows would have.
/// A run that cannot be read or fitted gets rows with the reason, unless it has a result from before: that stays, and
/// is marked stale. Results are stored about once a second; after a stop or a crash at any time, the next call
/// continues. Errors: of the source's entries and of the store.
Result<RefitCounts> Refit(const Source& source, Store& store, const RefitOptions& options);

}  // namespace pendulum
