// SPDX-License-Identifier: Apache-2.0
#include "service/connection.h"

#include <algorithm>
#include <ctime>
#include <exception>
#include <utility>

#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>

#include "service/answer_head.h"

namespace pendulum::wire {
namespace {

constexpr std::size_t kReadOfHead = std::size_t{4} << 10, kReadOfBody = std::size_t{64} << 10;

/// Calls handler code. An exception is a bug of the handler and is caught here.
template <typename Call, typename Failed>
auto Guarded(const Call& call, const Failed& failed) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    return failed(std::string(error.what()));
  } catch (...) {
    return failed(std::string("an exception of an unknown kind"));
  }
}

}  // namespace

WorkQueue& Serving::QueueOf(Lane lane) const {
  switch (lane) {
    case Lane::kQuick: break;
    case Lane::kFit: return fits;
    case Lane::kReadings: return readings;
  }
  return quick;
}

Connection::Connection(asio::ip::tcp::socket socket, Serving& serving)
    : channel_(std::make_shared<Channel>(std::move(socket), serving.options.request_time)),
      serving_(serving),
      held_(serving.budget),
      watch_(serving.io) {}

void Connection::Start() { NextRequest(); }

void Connection::RejectConnection(int status, const std::string& detail) {
  began_ = std::chrono::steady_clock::now();
  Refuse({status, detail});
}

void Connection::Finish() {
  if (stage_ == Stage::kIdle) channel_->Close();
  if (const auto stream = stream_.lock()) stream->End();
}

void Connection::Close() {
  if (std::exchange(stage_, Stage::kClosed) == Stage::kClosed) return;
  Report();
  channel_->Close();
  serving_.closed(shared_from_this());
}

std::chrono::steady_clock::duration Connection::waited() const {
  if (stage_ != Stage::kIdle && stage_ != Stage::kHead) return {};
  return std::chrono::steady_clock::now() - began_;
}

void Connection::NextRequest() {
  stage_ = Stage::kIdle;
  began_ = std::chrono::steady_clock::now();
  parser_.emplace(serving_.options.max_head, serving_.options.max_body, serving_.budget);
  method_.clear();
  target_.clear();
  channel_->Limit(serving_.options.idle_time);
  if (bytes_.empty()) return Read();
  Parse();
}

void Connection::Read() {
  const std::size_t size = bytes_.size(), more = stage_ == Stage::kBody ? kReadOfBody : kReadOfHead;
  bytes_.resize(size + more);
  channel_->Read(asio::buffer(bytes_.data() + size, more),
                 [self = shared_from_this(), size](const Code& code, std::size_t bytes) {
                   self->bytes_.resize(size + bytes);
                   self->HandleInput(code, bytes);
                 });
}

void Connection::HandleInput(const Code& code, std::size_t bytes) {
  if (stage_ == Stage::kClosed) return;
  if (!code && bytes > 0) return Parse();
  if (stage_ == Stage::kIdle || (stage_ == Stage::kHead && bytes_.empty())) return Close();
  if (code == asio::error::timed_out) {
    return Refuse({408, "the request did not arrive completely within the time limit"});
  }
  if (code == asio::error::eof) return Refuse({400, "the request ends before it is complete"});
  Close();
}

void Connection::Parse() {
  if (stage_ == Stage::kIdle) {
    stage_ = Stage::kHead;
    began_ = std::chrono::steady_clock::now();
    channel_->Limit(serving_.options.request_time);
  }
  if (stage_ == Stage::kHead && !ParseHead()) return;
  ParseBody();
}

/// True if ParseBody can continue with the received bytes. Otherwise more bytes are awaited or an answer is sent.
bool Connection::ParseHead() {
  while (bytes_.starts_with("\r\n")) bytes_.erase(0, 2);  // RFC 9112, section 2.2
  const auto size = parser_->ReadHead(bytes_);
  method_ = parser_->request().method;
  target_ = parser_->request().target;
  if (!size) {
    Refuse(size.error());
    return false;
  }
  if (*size == 0) {
    Read();
    return false;
  }
  bytes_.erase(0, *size);
  stage_ = Stage::kBody;
  HttpRequest& request = parser_->request();
  if (request.method == "HEAD") request.method = "GET";
  if (serving_.is_stopping) {
    Refuse({503, "the server is stopping"});
    return false;
  }
  auto response = Guarded([&] { return serving_.handler.RefuseHead(request); },
                          [&](const std::string& what) {
                            return std::optional(MakeRefusal({500, what}));
                          });
  if (response) {
    Answer(std::move(*response), true);
    return false;
  }
  if (const auto refused = RefusalOfHead()) {
    Refuse(*refused);
    return false;
  }
  if (parser_->is_done() || !bytes_.empty()) return true;
  AskForBody();
  return false;
}

std::optional<Refused> Connection::RefusalOfHead() const {
  if (parser_->is_done()) return std::nullopt;
  if (parser_->head().content_length > serving_.options.max_body) {
    return BodyTooLong(serving_.options.max_body);
  }
  if (serving_.budget.is_full()) return TooMuchAtOnce();
  return std::nullopt;
}

void Connection::AskForBody() {
  if (!parser_->head().expects_continue) return Read();
  channel_->Send("HTTP/1.1 100 Continue\r\n\r\n", "", serving_.options.request_time,
                 [self = shared_from_this()](const Code& code, std::size_t) {
                   if (code) return self->Close();
                   const auto spent = std::chrono::steady_clock::now() - self->began_;
                   self->channel_->Limit(std::chrono::duration_cast<std::chrono::milliseconds>(
                       self->serving_.options.request_time - spent));
                   self->Read();
                 });
}

void Connection::ParseBody() {
  if (!parser_->is_done()) {
    const auto size = parser_->ReadBody(bytes_);
    if (!size) return Refuse(size.error());
    bytes_.erase(0, *size);
    if (!parser_->is_done()) return Read();
  }
  Dispatch();
}

void Connection::Dispatch() {
  stage_ = Stage::kHandling;
  channel_->Unlimit();
  bytes_.shrink_to_fit();
  client_gone_ = {};
  parser_->request().client_gone = client_gone_.get_token();
  is_http11_ = parser_->head().is_http11;
  const Lane lane = Guarded([&] { return serving_.handler.LaneOf(parser_->request()); },
                            [](const std::string&) { return Lane::kQuick; });
  const bool is_queued =
      serving_.QueueOf(lane).Offer([self = shared_from_this(), offered = std::chrono::steady_clock::now()] {
        auto response = std::make_shared<HttpResponse>(self->Handle(offered));
        asio::post(self->serving_.io, [self, response] { self->Answer(std::move(*response), true); });
      });
  if (!is_queued) return Refuse({429, "too many requests are waiting; try again later"});
  if (lane == Lane::kFit) WatchClient();
}

/// Looks from time to time whether the client is still there, so that nobody fits for a client that has gone.
void Connection::WatchClient() {
  constexpr std::chrono::milliseconds kInterval{250};
  watch_.expires_after(kInterval);
  watch_.async_wait([self = shared_from_this()](const Code& code) {
    if (code || self->stage_ != Stage::kHandling) return;
    if (!self->channel_->IsClosedByPeer(self->is_http11_)) return self->WatchClient();
    self->client_gone_.request_stop();
  });
}

/// Runs on a thread of a lane, which owns the request meanwhile.
HttpResponse Connection::Handle(std::chrono::steady_clock::time_point offered) {
  if (parser_->request().client_gone.stop_requested())
    return MakeRefusal({408, "the client has closed the connection"});
  if (std::chrono::steady_clock::now() - offered > serving_.options.wait_time) {
    return MakeRefusal({408, "the request waited too long; try again later"});
  }
  const auto failed = [&](const std::string& what) { return MakeRefusal({500, what}); };
  if (serving_.budget.is_exceeded()) return MakeRefusal(TooMuchAtOnce());
  HttpResponse response = Guarded([&] { return serving_.handler.Handle(parser_->request()); }, failed);
  parser_->Forget();
  if (response.status >= 200 && response.status <= 599) return response;
  return failed("an answer with status " + std::to_string(response.status));
}

HttpResponse Connection::MakeRefusal(const Refused& refused) const {
  ++serving_.refusals;
  return Guarded([&] { return serving_.handler.Refusal(refused.status, refused.detail); },
                 [&](const std::string&) {
                   return HttpResponse{refused.status, {}, "", nullptr};
                 });
}

/// After a request that was not understood, no further request can be read.
void Connection::Refuse(const Refused& refused) {
  HttpResponse response = MakeRefusal(refused);
  response.events = nullptr;
  Answer(std::move(response), refused.status == 429 || refused.status == 500);
}

void Connection::Answer(HttpResponse response, bool may_keep_alive) {
  if (stage_ == Stage::kClosed) return;
  stage_ = Stage::kAnswering;
  watch_.cancel();
  if (parser_) parser_->Forget();
  const bool is_whole = parser_ && parser_->is_done();
  keeps_alive_ = may_keep_alive && is_whole && parser_->head().keeps_alive && !serving_.is_stopping;
  if (response.events && method_ != "HEAD") {
    if (serving_.streams >= std::max<std::size_t>(1, serving_.options.max_connections / 2)) {
      return Refuse({429, "too many streams of events are open; try again later"});
    }
    keeps_alive_ = false;
  }
  ++serving_.answers;
  sent_before_ = channel_->sent();
  answered_ = Answered{method_, target_, channel_->peer(), response.status, 0, {}};
  if (response.events) return SendEvents(std::move(response));
  SendBody(std::move(response));
}

void Connection::SendBody(HttpResponse response) {
  Framing framing{std::nullopt, false, keeps_alive_};
  if (MayHaveBody(response.status)) framing.length = response.body.size();
  const bool has_body = framing.length && method_ != "HEAD";
  std::string body = has_body ? std::move(response.body) : "";
  held_.Add(body.size());
  channel_->Send(AnswerHead(response, framing, std::time(nullptr)), std::move(body), serving_.options.request_time,
                 [self = shared_from_this()](const Code& code, std::size_t) { self->EndAnswer(!code); });
}

void Connection::SendEvents(HttpResponse response) {
  const auto set = [&](const char* name, const char* value) {
    if (!HttpRequest{"", "", response.fields, ""}.Field(name)) response.fields.push_back({name, value});
  };
  set("Content-Type", "text/event-stream");
  set("Cache-Control", "no-store");
  const bool is_chunked = parser_->head().is_http11;
  const std::string head = AnswerHead(response, {std::nullopt, is_chunked, false}, std::time(nullptr));
  if (method_ == "HEAD") {
    return channel_->Send(head, "", serving_.options.request_time,
                          [self = shared_from_this()](const Code& code, std::size_t) { self->EndAnswer(!code); });
  }
  ++serving_.streams;
  const auto stream = std::make_shared<EventStream>(channel_, std::move(response.events), is_chunked, serving_.options,
                                                    [self = shared_from_this()](bool is_whole) {
                                                      --self->serving_.streams;
                                                      self->EndAnswer(is_whole);
                                                    });
  stream_ = stream;
  stream->Start(head);
  if (serving_.is_stopping) stream->End();
}

void Connection::EndAnswer(bool is_whole) {
  held_.Release();
  Report();
  if (!is_whole || stage_ == Stage::kClosed) return Close();
  if (keeps_alive_ && !serving_.is_stopping) return NextRequest();
  channel_->Linger([self = shared_from_this()] { self->Close(); });
}

void Connection::Report() {
  if (!answered_) return;
  answered_->bytes = channel_->sent() - sent_before_;
  answered_->time = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - began_);
  Guarded(
      [&] {
        if (serving_.answered) serving_.answered(*answered_);
      },
      [](const std::string&) {});
  answered_.reset();
}

}  // namespace pendulum::wire
