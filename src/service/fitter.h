// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/base/time_limit.h"
#include "pendulum/batch/store.h"
#include "pendulum/identify/identify.h"
#include "pendulum/identify/identify_options.h"

namespace pendulum {

/// A finished run: its outcome for the store, and the fit with its samples if it succeeded.
struct FinishedRun {
  RunOutcome outcome;
  std::shared_ptr<const Identification> run;
  std::optional<Status> error;  ///< Why it could not be fitted.
  bool is_stopped = false;      ///< It exceeded the time limit, or was stopped.
};

/// Fits within a time limit and keeps the most recent fits with their samples. For any thread.
class Fitter {
 public:
  /// max_remembered: samples of all remembered fits.
  Fitter(std::chrono::milliseconds limit, std::int64_t max_remembered)
      : limit_(limit), max_remembered_(max_remembered) {}

  /// Fits one run. The result is the same as from fit_pendulum, but has no path. `unwanted`: nobody waits for it.
  FinishedRun Fit(const IdentifyOptions& asked, RunFiles files, const std::stop_token& unwanted = {});

  /// The fit of run `id`, made from these options and files: the remembered one, or a new one.
  Result<std::shared_ptr<const Identification>> FitOf(const std::string& id, const IdentifyOptions& options,
                                                      RunFiles files, const std::stop_token& unwanted = {});

  /// The remembered fit of a run; nullptr if there is none.
  std::shared_ptr<const Identification> Find(const std::string& id);

  /// Remembers the fit of a run, unless it has more than max_remembered samples. Forgets the fits that were not used
  /// for longest, if together they have more.
  void Remember(const std::string& id, std::shared_ptr<const Identification> run);

  /// Stops current and future fits.
  void StopAll() { limit_.StopAll(); }

  std::chrono::milliseconds limit() const { return limit_.limit(); }

  std::int64_t max_remembered() const { return max_remembered_; }

 private:
  struct Remembered {
    std::string id;
    std::shared_ptr<const Identification> run;
    std::int64_t samples;
  };

  void FitInto(const IdentifyOptions& asked, RunFiles files, const std::stop_token& unwanted, FinishedRun& fitted);

  TimeLimit limit_;
  std::int64_t max_remembered_;
  std::mutex mutex_;                  // for the members below
  std::list<Remembered> remembered_;  // most recently used first
};

}  // namespace pendulum
