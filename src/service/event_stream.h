// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "pendulum/service/http.h"
#include "pendulum/service/server.h"
#include "service/channel.h"

namespace pendulum::wire {

/// Server-sent events on a channel until the last event, until the client leaves, or until End. The next events are
/// requested only after the client has received the previous ones, so nothing accumulates.
class EventStream : public std::enable_shared_from_this<EventStream> {
 public:
  /// `done` is called once, when the stream ends; its argument is true if the client received everything.
  EventStream(std::shared_ptr<Channel> channel, NextEvents next, bool is_chunked, const ServerOptions& options,
              std::function<void(bool)> done);

  /// Sends the answer's head and the first events.
  void Start(std::string head);

  /// Ends the stream without further events. If the client does not take the remaining data within a short time, closes
  /// the connection.
  void End();

 private:
  void Watch();
  void Wait();
  void PollEvents();
  void Send(std::string text);
  void Finish(bool is_whole);

  std::shared_ptr<Channel> channel_;
  NextEvents next_;
  const bool is_chunked_;
  const ServerOptions& options_;
  std::function<void(bool)> done_;
  asio::steady_timer timer_;
  std::chrono::steady_clock::time_point last_sent_;
  bool is_last_ = false;
  bool is_waiting_ = false;  ///< It waits for the timer; nothing is being sent.
  std::array<char, 512> unexpected_input_ = {};
};

}  // namespace pendulum::wire
