// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"
#include "pendulum/identify/identify.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/service/time_limit.h"

namespace pendulum {

/// A run that is done: what there is to be kept of it, and the fit with its samples where it could be fitted.
struct FittedRun {
  RunOutcome outcome;
  std::shared_ptr<const Identification> run;
  std::optional<Status> error;  ///< Why it could not be fitted.
  bool is_stopped = false;      ///< It took longer than it may, or all are stopped.
};

/// Fits within a limit of time, and remembers the last fits with their samples for who asks for these. For any thread.
class Fitter {
 public:
  explicit Fitter(std::chrono::milliseconds limit) : limit_(limit) {}

  /// The result is that of fit_pendulum, without a path.
  FittedRun Fit(const IdentifyOptions& asked, RunFiles files);

  /// The fit of the run of that id, which was made from these: remembered, or made once more.
  Result<std::shared_ptr<const Identification>> FitOf(const std::string& id, const IdentifyOptions& options,
                                                      RunFiles files);

  /// Remembers the fit of a run.
  void Remember(const std::string& id, std::shared_ptr<const Identification> run);

  /// Stops what is under way, and what is still to come.
  void StopAll() { limit_.StopAll(); }

  std::chrono::milliseconds limit() const { return limit_.limit(); }

 private:
  /// A fit has about a kilobyte a sample where several models are compared.
  static constexpr Eigen::Index kMostRemembered = 100'000;  // samples

  struct Remembered {
    std::string id;
    std::shared_ptr<const Identification> run;
    Eigen::Index samples;
  };

  void FitInto(const IdentifyOptions& asked, RunFiles files, FittedRun& fitted);
  std::shared_ptr<const Identification> Find(const std::string& id);

  TimeLimit limit_;
  std::mutex mutex_;                  // of what follows
  std::list<Remembered> remembered_;  // the last used first
};

}  // namespace pendulum
