// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
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
  std::chrono::milliseconds fit_time{30'000};   ///< That one fit may take.
  int threads = 0;                              ///< Runs of batches at a time; 0: cores.
  std::string live;                             ///< The recording that is being made, as LiveRecording; empty for none.
  std::function<void(const std::string&)> say;  ///< Told, from any thread, what an operator should know.
};

struct ServiceState;

/// Answers the requests that include/pendulum/service/openapi.json lists: fits recordings, keeps the results
/// in a store, works off batches, and has the page. What it has answered with success is on the disk.
class FittingService : public HttpHandler {
 public:
  /// Takes up the batches that wait in the store. Errors: of the store.
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

  /// Counts an answer for the metrics.
  void Count(const Answered& answered);

  /// What the metrics say of the server.
  void CountServer(std::function<ServerCounts()> counts);

  /// Ends batches, whose runs wait for the next start, and says so to who asks for its health.
  void Stop();

  /// Stops all fits, whose requests are answered with 503.
  void StopFits();

 private:
  std::unique_ptr<ServiceState> state_;
};

}  // namespace pendulum
