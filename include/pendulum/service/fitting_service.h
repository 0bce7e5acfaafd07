// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/batch/fit_store.h"
#include "pendulum/service/access.h"
#include "pendulum/service/fit_request.h"
#include "pendulum/service/http.h"
#include "pendulum/service/server.h"

namespace pendulum {

struct ServiceOptions {
  RequestLimits limits;
  AccessRules access;
  std::chrono::milliseconds fit_time{30'000};  ///< Longest time of one fit.
  /// Longest time of readings for other values, whose requests are answered one after the other.
  std::chrono::milliseconds readings_time{1'000};
  /// Samples of all fits in memory. A fit needs about a kilobyte per sample if several models are compared.
  std::int64_t max_remembered = 100'000;
  int threads = 0;                              ///< Runs of batches at a time; 0: one per core.
  std::string live;                             ///< Path of the recording in progress (LiveRecording), or empty.
  std::string docs;                             ///< Folder of the user guide, served at /docs; empty: none.
  std::function<void(const std::string&)> say;  ///< Receives messages for the operator, from any thread.
};

struct ServiceState;

/// Answers the requests listed in include/pendulum/service/openapi.json: fits recordings, keeps the results in a store,
/// runs batches, and serves the page. When a request is answered with success, its result is on the disk.
class FittingService : public HttpHandler {
 public:
  /// Continues the batches that wait in the store. Errors: of the store.
  static Result<std::unique_ptr<FittingService>> Begin(const ServiceOptions& options, std::unique_ptr<FitStore> store);

  explicit FittingService(std::unique_ptr<ServiceState> state);
  FittingService(const FittingService&) = delete;
  FittingService& operator=(const FittingService&) = delete;
  FittingService(FittingService&&) = delete;
  FittingService& operator=(FittingService&&) = delete;
  ~FittingService() override;

  Lane LaneOf(const HttpRequest& request) const override;
  std::optional<HttpResponse> RefuseHead(const HttpRequest& request) const override;
  HttpResponse Handle(const HttpRequest& request) override;
  HttpResponse Refusal(int status, const std::string& detail) const override;

  /// Counts an answer in the metrics.
  void Count(const Answered& answered);

  /// Sets the source of the server's numbers in the metrics.
  void CountServer(std::function<ServerCounts()> counts);

  /// Starts no more runs of batches, and reports the stop in health checks. Remaining runs wait for the next start.
  void Stop();

  /// Stops all fits and readings for other values; their requests are answered with 503.
  void StopFits();

 private:
  std::unique_ptr<ServiceState> state_;
};

}  // namespace pendulum
