// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/service/http.h"

namespace pendulum {

/// Limits within which a server serves; whoever goes beyond one is told, and costs the others nothing.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6, no name.
  std::uint16_t port = 8080;          ///< 0: any free one.
  int fit_threads = 0;                ///< Requests of Lane::kFit at a time; 0: cores.
  int quick_threads = 2;
  std::size_t max_queue = 64;                   ///< Requests that wait in a lane; one more is 429.
  std::chrono::milliseconds wait_time{30'000};  ///< That a request may wait there; then it is 408.
  /// One more takes the place of the one that has been without a whole head of a request the longest, if that is
  /// more than yield_time; else it gets 503 and is closed. Half as many streams of events, then 429.
  std::size_t max_connections = 512;
  std::chrono::milliseconds yield_time{1000};
  std::size_t max_head = std::size_t{8} << 10;        ///< Bytes of request line and fields; more is 431.
  std::size_t max_body = std::size_t{32} << 20;       ///< Bytes; more is 413.
  std::size_t max_buffered = std::size_t{512} << 20;  ///< Bytes of all bodies in memory, answers too; more is 429.
  /// For a request to come in whole, else 408, and for each quarter of a megabyte of an answer to be taken, else it is
  /// closed.
  std::chrono::milliseconds request_time{30'000};
  std::chrono::milliseconds idle_time{60'000};    ///< For a connection without a request.
  std::chrono::milliseconds max_silence{15'000};  ///< Of a stream of events; then a comment keeps it open.
  std::chrono::milliseconds stop_time{20'000};    ///< For what is under way when it stops.
};

/// What the server counts, for metrics.
struct ServerCounts {
  std::size_t connections = 0;               ///< Open now, streams among them.
  std::size_t waiting = 0, running = 0;      ///< Requests in the lanes.
  std::size_t streams = 0;                   ///< Of events.
  std::size_t buffered = 0;                  ///< Bytes of bodies in memory.
  std::uint64_t accepted = 0, answered = 0;  ///< Connections; answers.
  std::uint64_t refused = 0;                 ///< Answers that the server made itself, by HttpHandler::Refusal.
};

/// One answered request, for the log and the metrics.
struct Answered {
  std::string method, target;  ///< As they came; empty where no request line could be read.
  std::string peer;            ///< The address, without port.
  int status = 0;
  std::size_t bytes = 0;             ///< Of head and body that were taken.
  std::chrono::microseconds time{};  ///< From its first byte to the last of its answer.
};

/// HTTP/1.1 (RFC 9112) by Boost.Beast: one thread moves the bytes of all connections, others calculate, so that who
/// sends or takes slowly holds no thread. What a handler throws is answered with Refusal(500, what it says).
class Server {
  struct State;

 public:
  /// Binds and listens; `handler` must outlive the server. `answered`, if any, is called on the thread of Run.
  /// kInvalidArgument: not an address; kCannotWrite: the port is taken or not permitted.
  static Result<std::unique_ptr<Server>> Listen(const ServerOptions& options, HttpHandler& handler,
                                                std::function<void(const Answered&)> answered);

  explicit Server(std::unique_ptr<State> state);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;
  ~Server();

  std::uint16_t port() const;

  /// Serves until Stop, once. Returns when nothing is under way any more; after stop_time it waits for calls of the
  /// handler that have begun, and for nothing else.
  void Run();

  /// From any thread, but no signal handler: no new connections or requests; streams end, what is under way is
  /// answered.
  void Stop();

  bool is_stopping() const;

  /// From any thread.
  ServerCounts Count() const;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace pendulum
