// SPDX-License-Identifier: Apache-2.0
#include "service/channel.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace pendulum::wire {
namespace {

/// A client must receive this many bytes within one time limit: with 30 s, 9 kB/s are enough.
constexpr std::size_t kPiece = std::size_t{256} << 10;

constexpr std::chrono::seconds kLingerTime{2};
constexpr std::size_t kMaxDiscarded = std::size_t{1} << 20;

std::string PeerOf(const asio::ip::tcp::socket& socket) {
  Code code;
  const auto endpoint = socket.remote_endpoint(code);
  if (code) return "";
  const asio::ip::address address = endpoint.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

}  // namespace

Channel::Channel(asio::ip::tcp::socket socket, std::chrono::milliseconds unread)
    : socket_(std::move(socket)), limit_(socket_.get_executor()), peer_(PeerOf(socket_)) {
  Code ignored;
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  const auto milliseconds = static_cast<unsigned int>(unread.count());
  ::setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_USER_TIMEOUT, &milliseconds, sizeof milliseconds);
}

void Channel::Limit(std::chrono::milliseconds time) {
  is_late_ = false;
  limit_.expires_at(std::min(asio::steady_timer::clock_type::now() + time, end_));
  limit_.async_wait([this, self = shared_from_this()](const Code& code) {
    // An old timer may still call back after it was reset.
    if (code || limit_.expiry() > asio::steady_timer::clock_type::now()) return;
    is_late_ = true;
    Code ignored;
    socket_.cancel(ignored);
  });
}

void Channel::Unlimit() {
  is_late_ = false;
  limit_.expires_at(asio::steady_timer::time_point::max());
}

void Channel::EndWithin(std::chrono::milliseconds time) {
  end_ = asio::steady_timer::clock_type::now() + time;
  Limit(time);
}

Code Channel::ReasonOf(const Code& code) const { return code && is_late_ ? Code(asio::error::timed_out) : code; }

void Channel::Read(asio::mutable_buffer buffer, Done done) {
  if (is_late_) {
    asio::post(socket_.get_executor(), [done = std::move(done)] { done(asio::error::timed_out, 0); });
    return;
  }
  socket_.async_read_some(buffer, [this, self = shared_from_this(), done = std::move(done)](
                                      const Code& code, std::size_t bytes) { done(ReasonOf(code), bytes); });
}

void Channel::Send(std::string head, std::string body, std::chrono::milliseconds time, Done done) {
  head_ = std::move(head);
  body_ = std::move(body);
  sent_of_answer_ = 0;
  SendPiece(time, std::move(done));
}

void Channel::SendPiece(std::chrono::milliseconds time, Done done) {
  const auto rest_of = [](const std::string& text, std::size_t from, std::size_t max_bytes) {
    const std::size_t begin = std::min(from, text.size());
    return asio::const_buffer(text.data() + begin, std::min(max_bytes, text.size() - begin));
  };
  const std::size_t of_body = sent_of_answer_ - std::min(sent_of_answer_, head_.size());
  const std::array<asio::const_buffer, 2> pieces = {rest_of(head_, sent_of_answer_, head_.size()),
                                                    rest_of(body_, of_body, kPiece)};
  Limit(time);
  asio::async_write(socket_, pieces,
                    [this, self = shared_from_this(), time, done = std::move(done)](const Code& code, std::size_t n) {
                      sent_ += n;
                      sent_of_answer_ += n;
                      const Code reason = ReasonOf(code);
                      if (!reason && sent_of_answer_ < head_.size() + body_.size()) return SendPiece(time, done);
                      head_.clear();
                      std::string().swap(body_);
                      if (!reason) Unlimit();
                      done(reason, sent_of_answer_);
                    });
}

void Channel::Linger(std::function<void()> done) {
  Code ignored;
  socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  Limit(kLingerTime);
  DiscardInput(std::move(done));
}

void Channel::DiscardInput(std::function<void()> done) {
  Read(asio::buffer(discard_buffer_),
       [this, self = shared_from_this(), done = std::move(done)](const Code& code, std::size_t n) {
         discarded_ += n;
         if (!code && discarded_ < kMaxDiscarded) return DiscardInput(done);
         Close();
         done();
       });
}

bool Channel::IsClosedByPeer(bool understands_interim) {
  constexpr std::string_view kProbe = "HTTP/1.1 102 Processing\r\n\r\n";
  tcp_info info = {};
  socklen_t size = sizeof info;
  if (::getsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return false;
  if (info.tcpi_state == TCP_CLOSE_WAIT && understands_interim && !has_probed_) {
    has_probed_ = ::send(socket_.native_handle(), kProbe.data(), kProbe.size(), MSG_DONTWAIT | MSG_NOSIGNAL) > 0;
  }
  return info.tcpi_state == TCP_CLOSE;
}

void Channel::Close() {
  Code ignored;
  limit_.cancel();
  socket_.close(ignored);
}

}  // namespace pendulum::wire
