// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "pendulum/service/server.h"

namespace pendulum {

/// Counters of the service in Prometheus' text format. For any thread.
class ServiceMetrics {
 public:
  ServiceMetrics();
  ServiceMetrics(const ServiceMetrics&) = delete;
  ServiceMetrics& operator=(const ServiceMetrics&) = delete;
  ServiceMetrics(ServiceMetrics&&) = delete;
  ServiceMetrics& operator=(ServiceMetrics&&) = delete;
  ~ServiceMetrics();

  /// Counts an answer. `route`: the path with {id} for the variable part, so that there are few routes.
  void CountAnswer(const std::string& method, const std::string& route, int status, std::chrono::microseconds time);

  /// Counts a finished fit; `kind` is request or batch.
  void CountFit(const std::string& kind, int exit_code, std::chrono::steady_clock::duration time);

  /// Counts a run of a batch that must wait because the store is not available.
  void CountRetry();

  /// Sets the source of the server's numbers.
  void set_server(std::function<ServerCounts()> counts);

  /// All metrics, with `waiting` waiting runs of batches.
  std::string Text(std::size_t waiting);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pendulum
