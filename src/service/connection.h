// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include <boost/asio/steady_timer.hpp>

#include "pendulum/service/http.h"
#include "pendulum/service/server.h"
#include "service/byte_budget.h"
#include "service/channel.h"
#include "service/event_stream.h"
#include "service/request_parser.h"
#include "service/work_queue.h"

namespace pendulum::wire {

class Connection;

/// Data shared by all connections of a server. For the I/O thread only, except for the atomic members.
struct Serving {
  const ServerOptions& options;
  HttpHandler& handler;
  std::function<void(const Answered&)> answered;
  asio::io_context& io;
  ByteBudget& budget;
  WorkQueue &quick, &fits, &readings;                              ///< One for each Lane.
  std::function<void(const std::shared_ptr<Connection>&)> closed;  ///< Called when a connection is over.
  std::atomic<bool> is_stopping = false;
  std::atomic<std::size_t> streams = 0;
  std::atomic<std::uint64_t> answers = 0, refusals = 0;

  WorkQueue& QueueOf(Lane lane) const;
};

/// One client. Requests are read, passed to a lane and answered one after another. Runs on the I/O thread, except for
/// the handler.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::ip::tcp::socket socket, Serving& serving);

  void Start();

  /// Answers without reading a request, and closes.
  void RejectConnection(int status, const std::string& detail);

  /// Accepts no further request: closes an idle connection, ends a stream.
  void Finish();

  /// Closes at once, in any state.
  void Close();

  /// How long the connection has waited for a complete request head; zero while a request is processed.
  std::chrono::steady_clock::duration waited() const;

 private:
  void NextRequest();
  void Read();
  void HandleInput(const Code& code, std::size_t bytes);
  void Parse();
  bool ParseHead();
  std::optional<Refused> RefusalOfHead() const;
  void AskForBody();
  void ParseBody();
  void Dispatch();
  void WatchClient();
  HttpResponse Handle(std::chrono::steady_clock::time_point offered);

  HttpResponse MakeRefusal(const Refused& refused) const;
  void Refuse(const Refused& refused);
  void Answer(HttpResponse response, bool may_keep_alive);
  void SendBody(HttpResponse response);
  void SendEvents(HttpResponse response);
  void EndAnswer(bool is_whole);
  void Report();

  enum class Stage { kIdle, kHead, kBody, kHandling, kAnswering, kClosed };

  std::shared_ptr<Channel> channel_;
  Serving& serving_;
  Stage stage_ = Stage::kIdle;
  std::string bytes_;  ///< Received bytes that are not used yet.
  std::optional<RequestParser> parser_;
  std::string method_, target_;                  ///< Unchanged from the request line.
  std::chrono::steady_clock::time_point began_;  ///< Start of the request, or of waiting for it.
  HeldBytes held_;                               ///< Bytes of an answer.
  std::weak_ptr<EventStream> stream_;
  asio::steady_timer watch_;
  std::stop_source client_gone_;  ///< Of the request in progress.
  bool is_http11_ = true;
  bool keeps_alive_ = false;
  std::optional<Answered> answered_;  ///< The request that is being answered.
  std::size_t sent_before_ = 0;
};

}  // namespace pendulum::wire
