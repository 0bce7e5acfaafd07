// SPDX-License-Identifier: Apache-2.0
#include "service/event_stream.h"

#include <charconv>
#include <utility>

namespace pendulum::wire {
namespace {

constexpr std::chrono::milliseconds kPollInterval{100};

/// Time for a client to receive the remaining data when the stream ends.
constexpr std::chrono::milliseconds kFinishTime{1000};

std::string ChunkOf(const std::string& text) {
  std::array<char, 16> size = {};
  auto* const end = std::to_chars(size.data(), size.data() + size.size(), text.size(), 16).ptr;
  return std::string(size.data(), end) + "\r\n" + text + "\r\n";
}

}  // namespace

EventStream::EventStream(std::shared_ptr<Channel> channel, NextEvents next, bool is_chunked,
                         const ServerOptions& options, std::function<void(bool)> done)
    : channel_(std::move(channel)),
      next_(std::move(next)),
      is_chunked_(is_chunked),
      options_(options),
      done_(std::move(done)),
      timer_(channel_->executor()) {}

void EventStream::Start(std::string head) {
  Watch();
  last_sent_ = std::chrono::steady_clock::now();
  channel_->Send(std::move(head), "", options_.request_time,
                 [self = shared_from_this()](const Code& code, std::size_t) {
                   if (code) return self->Finish(false);
                   self->PollEvents();
                 });
}

void EventStream::End() {
  next_ = [] { return EventText{"", true}; };
  channel_->EndWithin(kFinishTime);
  if (is_waiting_) timer_.cancel();
}

/// Detects that the client closes the connection. Unexpected input is ignored; after such input a closed connection is
/// detected only when data is sent.
void EventStream::Watch() {
  channel_->Read(asio::buffer(unexpected_input_), [self = shared_from_this()](const Code& code, std::size_t) {
    if (code) self->channel_->Close();
    if (code && self->is_waiting_) self->timer_.cancel();
  });
}

void EventStream::Wait() {
  is_waiting_ = true;
  timer_.expires_after(kPollInterval);
  timer_.async_wait([self = shared_from_this()](const Code&) {
    self->is_waiting_ = false;
    if (!self->channel_->is_open()) return self->Finish(false);
    self->PollEvents();
  });
}

void EventStream::PollEvents() {
  EventText events;
  try {
    events = next_();
  } catch (...) {  // a bug of the handler; the missing last chunk shows the client that the stream is incomplete
    return Finish(false);
  }
  is_last_ = is_last_ || events.is_last;
  if (!events.text.empty() || is_last_) return Send(std::move(events.text));
  if (std::chrono::steady_clock::now() - last_sent_ >= options_.max_silence) return Send(":\n\n");
  Wait();
}

void EventStream::Send(std::string text) {
  last_sent_ = std::chrono::steady_clock::now();
  std::string all = is_chunked_ && !text.empty() ? ChunkOf(text) : std::move(text);
  if (is_chunked_ && is_last_) all += "0\r\n\r\n";
  channel_->Send("", std::move(all), options_.request_time, [self = shared_from_this()](const Code& code, std::size_t) {
    if (code || self->is_last_) return self->Finish(!code);
    self->Wait();
  });
}

void EventStream::Finish(bool is_whole) {
  next_ = nullptr;
  if (const auto done = std::exchange(done_, nullptr)) done(is_whole);
}

}  // namespace pendulum::wire
