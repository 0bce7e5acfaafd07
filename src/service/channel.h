// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace pendulum::wire {

namespace asio = boost::asio;
using Code = boost::system::error_code;

/// A socket whose every wait ends: by bytes, by the other side, or by a limit. One read and one write at a time, all on
/// the thread of its io_context. What is called back holds its owner, so that nobody goes while something is under way.
class Channel : public std::enable_shared_from_this<Channel> {
 public:
  using Done = std::function<void(const Code&, std::size_t)>;

  /// `unread`: for how long the other side may leave bytes unacknowledged.
  Channel(asio::ip::tcp::socket socket, std::chrono::milliseconds unread);

  /// From now on; what is under way then, or begun later, ends with error::timed_out.
  void Limit(std::chrono::milliseconds time);
  void Unlimit();

  /// However it is limited later.
  void EndWithin(std::chrono::milliseconds time);

  /// Some bytes, at least one.
  void Read(asio::mutable_buffer buffer, Done done);

  /// Head and body, by pieces, each of which may take `time`. Unlimited afterwards.
  void Send(std::string head, std::string body, std::chrono::milliseconds time, Done done);

  /// Tells the other side that nothing will follow and closes once it has done so too, so that what it sent unasked
  /// does not cost it the answer (RFC 9112, section 9.6); bounded in time and bytes.
  void Linger(std::function<void()> done);

  /// What is under way ends with an error.
  void Close();

  bool is_open() const { return socket_.is_open(); }
  asio::ip::tcp::socket::executor_type executor() { return socket_.get_executor(); }

  /// Bytes that were sent, ever.
  std::size_t sent() const { return sent_; }

  /// The other side's address.
  const std::string& peer() const { return peer_; }

 private:
  void SendPiece(std::chrono::milliseconds time, Done done);
  void ReadAway(std::function<void()> done);
  Code ReasonOf(const Code& code) const;

  asio::ip::tcp::socket socket_;
  asio::steady_timer limit_;
  asio::steady_timer::time_point end_ = asio::steady_timer::time_point::max();
  bool is_late_ = false;
  std::string peer_;
  std::string head_, body_;      ///< Being sent.
  std::size_t sent_of_all_ = 0;  ///< Of both.
  std::size_t sent_ = 0, read_away_ = 0;
  std::array<char, 4096> away_ = {};
};

}  // namespace pendulum::wire
