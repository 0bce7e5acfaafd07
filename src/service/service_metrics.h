// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "pendulum/service/server.h"

namespace pendulum {

/// What a service counts, in Prometheus' text format. For any thread.
class ServiceMetrics {
 public:
  ServiceMetrics();
  ServiceMetrics(const ServiceMetrics&) = delete;
  ServiceMetrics& operator=(const ServiceMetrics&) = delete;
  ServiceMetrics(ServiceMetrics&&) = delete;
  ServiceMetrics& operator=(ServiceMetrics&&) = delete;
  ~ServiceMetrics();

  /// An answer: `route` is a path with {id} for what differs, so that there are few of them.
  void CountAnswer(const std::string& method, const std::string& route, int status, std::chrono::microseconds time);

  /// A fit that was made: `kind` is request or batch.
  void CountFit(const std::string& kind, int exit_code, std::chrono::steady_clock::duration time);

  /// A run of a batch that has to wait until the store can be had again.
  void CountRetry();

  /// What the server says of itself when the metrics are asked for.
  void set_server(std::function<ServerCounts()> counts);

  /// All of it, with `waiting` runs of batches.
  std::string Text(std::size_t waiting);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pendulum
