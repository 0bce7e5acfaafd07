// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <latch>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/service/server.h"
#include "tests/service/raw_client.h"

namespace pendulum {

/// Answers with the request itself. Some paths have a special behavior: /fit uses the lane of fits and waits for
/// `gate`, /readings uses the lane of readings, /refused is refused by its head, /throw throws.
class EchoHandler : public HttpHandler {
 public:
  Lane LaneOf(const HttpRequest& request) const override {
    if (request.target.starts_with("/readings")) return Lane::kReadings;
    return request.target.starts_with("/fit") ? Lane::kFit : Lane::kQuick;
  }

  std::optional<HttpResponse> RefuseHead(const HttpRequest& request) const override {
    ++heads;
    if (!request.target.starts_with("/refused")) return std::nullopt;
    return HttpResponse{401, {{"WWW-Authenticate", "Bearer"}}, "who is there?", nullptr};
  }

  HttpResponse Handle(const HttpRequest& request) override {
    ++calls;
    if (request.target.starts_with("/fit")) {
      ++waiting;
      gate.wait();
    }
    if (request.target.starts_with("/throw")) throw std::runtime_error("the handler's bug");
    if (const std::lock_guard lock(mutex); answer) return answer(request);
    return {
        200, {{"Content-Type", "text/plain"}}, request.method + " " + request.target + "\n" + request.body, nullptr};
  }

  HttpResponse Refusal(int status, const std::string& detail) const override {
    HttpResponse response{status, {{"Content-Type", "text/plain"}}, detail, nullptr};
    if (status == 408 || status == 429 || status == 503) response.fields.push_back({"Retry-After", "1"});
    return response;
  }

  mutable std::atomic<int> heads = 0;
  std::atomic<int> calls = 0, waiting = 0;
  std::latch gate{1};
  std::mutex mutex;
  std::function<HttpResponse(const HttpRequest&)> answer;  ///< Used instead of the request itself.
};

/// A server on a free port during a test, with limits small enough to reach.
class Served : public testing::Test {
 protected:
  Served() {
    options_.port = 0;
    options_.fit_threads = 2;
    options_.max_queue = 3;
    options_.max_connections = 300;
    options_.max_body = 100'000;
    options_.max_buffered = 300'000;
    options_.stop_time = std::chrono::seconds(10);
  }

  ~Served() override {
    if (thread_.joinable()) StopAndJoin();
  }

  void Start() {
    auto server = Server::Listen(options_, handler_, [&](const Answered& answered) {
      const std::lock_guard lock(mutex_);
      answered_.push_back(answered);
    });
    ASSERT_TRUE(server) << server.error().message();
    server_ = std::move(*server);
    thread_ = std::thread([&] { server_->Run(); });
  }

  void StopAndJoin() {
    if (!handler_.gate.try_wait()) handler_.gate.count_down();
    server_->Stop();
    thread_.join();
  }

  RawClient Connect(int receive_buffer = 0) const { return RawClient(server_->port(), receive_buffer); }

  /// Waits at most a minute for a condition set by other threads; returns whether it became true.
  static bool Eventually(const std::function<bool()>& is_true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!is_true()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

  std::vector<Answered> answered() {
    const std::lock_guard lock(mutex_);
    return answered_;
  }

  ServerOptions options_;
  EchoHandler handler_;
  std::unique_ptr<Server> server_;
  std::thread thread_;

 private:
  std::mutex mutex_;
  std::vector<Answered> answered_;
};

/// A request without a body.
inline std::string Get(const std::string& target, const std::string& fields = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

/// A request with a body of known length.
inline std::string Post(const std::string& target, const std::string& body, const std::string& fields = "") {
  return "POST " + target + " HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         fields + "\r\n" + body;
}

}  // namespace pendulum
