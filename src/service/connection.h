// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "pendulum/service/http.h"
#include "pendulum/service/server.h"
#include "service/byte_budget.h"
#include "service/channel.h"
#include "service/event_stream.h"
#include "service/request_parser.h"
#include "service/work_queue.h"

namespace pendulum::wire {

class Connection;

/// What all connections of a server share. But for the numbers, on the I/O thread only.
struct Serving {
  const ServerOptions& options;
  HttpHandler& handler;
  std::function<void(const Answered&)> answered;
  asio::io_context& io;
  ByteBudget& budget;
  WorkQueue &quick, &fits;
  std::function<void(const std::shared_ptr<Connection>&)> closed;  ///< It is over with one.
  std::atomic<bool> is_stopping = false;
  std::atomic<std::size_t> streams = 0;
  std::atomic<std::uint64_t> answers = 0, refusals = 0;
};

/// One client: requests one after another, each read, handed to a lane, and answered. On the I/O thread but for the
/// handler's part.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::ip::tcp::socket socket, Serving& serving);

  void Start();

  /// Answers what has not been asked yet, and closes.
  void TurnAway(int status, const std::string& detail);

  /// No request after this one: closes if there is none, ends a stream.
  void Finish();

  /// At once, whatever is under way.
  void Close();

  /// For the head of a request, until it is whole; zero while there is something to do.
  std::chrono::steady_clock::duration waited() const;

 private:
  void NextRequest();
  void Read();
  void Take(const Code& code, std::size_t bytes);
  void Parse();
  bool ParseHead();
  std::optional<Refused> RefusalOfHead() const;
  void AskForBody();
  void ParseBody();
  void Dispatch();
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
  std::string bytes_;  ///< That have come and are not taken.
  std::optional<RequestParser> parser_;
  std::string method_, target_;                  ///< As they came.
  std::chrono::steady_clock::time_point began_;  ///< The request, or waiting for it.
  HeldBytes held_;                               ///< By an answer.
  std::weak_ptr<EventStream> stream_;
  bool keeps_alive_ = false;
  std::optional<Answered> answered_;  ///< What is being answered.
  std::size_t sent_before_ = 0;
};

}  // namespace pendulum::wire
