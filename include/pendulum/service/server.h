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

/// Limits of a server. A client that exceeds one gets an error; other clients are not affected.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6 address, not a host name.
  std::uint16_t port = 8080;          ///< 0: any free port.
  int fit_threads = 0;                ///< Requests of Lane::kFit at a time; 0: one per core.
  int quick_threads = 2;
  int readings_threads = 1;                     ///< Requests of Lane::kReadings at a time.
  std::size_t max_queue = 64;                   ///< Waiting requests per lane; one more gets 429.
  std::chrono::milliseconds wait_time{30'000};  ///< Longest time in a queue; then the request gets 408.
  /// Limit for open connections. One more replaces the connection that has waited longest for a complete request head,
  /// if that wait exceeds yield_time; otherwise the new one gets 503 and is closed. Streams of events: half as many,
  /// then 429.
  std::size_t max_connections = 512;
  std::chrono::milliseconds yield_time{1000};
  std::size_t max_head = std::size_t{8} << 10;        ///< Bytes of request line and fields; more gets 431.
  std::size_t max_body = std::size_t{32} << 20;       ///< Bytes; more gets 413.
  std::size_t max_buffered = std::size_t{512} << 20;  ///< Bytes of all bodies and answers in memory; more gets 429.
  /// Time within which a request must be complete, otherwise the answer is 408. A client must also take each quarter of
  /// a megabyte of an answer within this time, otherwise the connection is closed.
  std::chrono::milliseconds request_time{30'000};
  std::chrono::milliseconds idle_time{60'000};    ///< Limit for a connection without a request.
  std::chrono::milliseconds max_silence{15'000};  ///< After it a comment keeps a silent stream of events open.
  std::chrono::milliseconds stop_time{20'000};    ///< Limit for running requests when the server stops.
};

/// Counts of the server for the metrics.
struct ServerCounts {
  std::size_t connections = 0;               ///< Open now, including streams.
  std::size_t waiting = 0, running = 0;      ///< Requests in the lanes.
  std::size_t streams = 0;                   ///< Streams of events.
  std::size_t buffered = 0;                  ///< Bytes of bodies in memory.
  std::uint64_t accepted = 0, answered = 0;  ///< Total numbers of connections and of answers.
  std::uint64_t refused = 0;                 ///< Answers made by the server itself, with HttpHandler::Refusal.
};

/// One answered request, for the log and the metrics.
struct Answered {
  std::string method, target;  ///< Unchanged; empty if no request line could be read.
  std::string peer;            ///< The address, without port.
  int status = 0;
  std::size_t bytes = 0;             ///< Bytes of head and body that the client received.
  std::chrono::microseconds time{};  ///< Time from the request's first byte to the last of its answer.
};

/// HTTP/1.1 (RFC 9112) with Boost.Beast. One thread does all input and output, others calculate; a slow client does not
/// block a thread. An exception of a handler is answered with Refusal(500, its message).
class Server {
  struct State;

 public:
  /// Binds and listens; `handler` must outlive the server. `answered`, if set, is called on the thread of Run.
  /// kInvalidArgument: not an address; kCannotWrite: the port is in use or not permitted.
  static Result<std::unique_ptr<Server>> Listen(const ServerOptions& options, HttpHandler& handler,
                                                std::function<void(const Answered&)> answered);

  explicit Server(std::unique_ptr<State> state);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;
  ~Server();

  std::uint16_t port() const;

  /// Serves until Stop; call it once. Returns when all work is done. After stop_time it waits only for handler calls
  /// that have begun.
  void Run();

  /// Accepts no new connections or requests, ends streams, and lets running requests finish. Call from any thread, but
  /// not from a signal handler.
  void Stop();

  bool is_stopping() const;

  /// Call from any thread.
  ServerCounts Count() const;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace pendulum
