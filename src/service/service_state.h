// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pendulum/base/time_limit.h"
#include "pendulum/batch/fit_store.h"
#include "pendulum/service/fitting_service.h"
#include "pendulum/service/http.h"
#include "pendulum/service/live_recording.h"
#include "pendulum/service/request_target.h"
#include "service/batch_queue.h"
#include "service/fitter.h"
#include "service/service_metrics.h"

namespace pendulum {

/// Keys of requests in progress.
class KeysInProgress {
 public:
  /// False: another request with this key is in progress.
  bool Begin(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    return keys_.insert(key).second;
  }

  void End(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    keys_.erase(key);
  }

 private:
  std::mutex mutex_;
  std::set<std::string> keys_;
};

/// State shared by all requests of a service.
struct ServiceState {
  ServiceState(ServiceOptions given, std::unique_ptr<FitStore> kept)
      : options(std::move(given)),
        store(std::move(kept)),
        fitter(options.fit_time, options.max_remembered),
        batch_fitter(kBatchTimeFactor * options.fit_time, 0),
        readings_limit(options.readings_time),
        queue(*store, batch_fitter, metrics, options.say) {
    if (!options.live.empty()) live.emplace(options.live);
  }

  /// Runs of batches have a lower priority, so they may take longer.
  static constexpr int kBatchTimeFactor = 4;

  ServiceOptions options;
  std::unique_ptr<FitStore> store;
  ServiceMetrics metrics;
  Fitter fitter, batch_fitter;
  TimeLimit readings_limit;
  KeysInProgress keys;
  std::optional<LiveRecording> live;
  std::atomic<bool> is_stopping = false;
  BatchQueue queue;  // last member: its threads use the members above
};

/// One request that is being answered.
struct Call {
  const HttpRequest& http;
  RequestTarget target;
  std::string id;  ///< The text in place of {id}, {name} or {path} in the path.
};

using Answer = HttpResponse (*)(ServiceState& state, const Call& call);

}  // namespace pendulum
