// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/batch/source.h"
#include "pendulum/batch/store.h"
#include "pendulum/identify/identify_options.h"

namespace pendulum {

/// Runs of a batch, counted as they are gone through.
struct RefitCounts {
  std::int64_t runs = 0;      ///< Of the batch, or its shard.
  std::int64_t current = 0;   ///< Whose rows are of the same data, rig, calibration, options and version already.
  std::int64_t refitted = 0;  ///< Whose rows are new.
  std::int64_t unfitted = 0;  ///< Of all of these, those that could not be fitted.
  bool stopped = false;       ///< Before all of them were gone through.

  std::int64_t done() const { return current + refitted; }
};

struct RefitOptions {
  IdentifyOptions run;                          ///< Of every run, unless its entry says otherwise.
  std::optional<std::string> rig, calibration;  ///< JSON of those whose entries name none.
  std::optional<Shard> shard;
  int threads = 0;                          ///< Each fits one recording at a time; 0: one a core. No row depends on it.
  bool force = false;                       ///< Also what is current.
  bool retry_failed = false;                ///< Also what could not be fitted.
  const std::atomic<bool>* stop = nullptr;  ///< Once true, what was begun is finished and stored, and no more.
  std::function<void(const RefitCounts&)> progress;  ///< After every run, from any thread, one at a time.
  std::function<Result<void>()> committed;  ///< After every commit, about once a second; an error ends the refit.
};

/// The result of one run, as fit_pendulum would have it.
RunOutcome RefitRun(const Source& source, const ManifestEntry& entry, const RefitOptions& options);

/// Refits those runs of the source whose rows in the store are not of what they would be made from now. A run that
/// cannot be read or fitted has rows that say why. Stored about once a second: stopped or killed at any time, the next
/// call goes on. Errors: of the source's entries and of the store.
Result<RefitCounts> Refit(const Source& source, Store& store, const RefitOptions& options);

}  // namespace pendulum
