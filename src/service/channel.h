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

/// A socket on which no operation waits forever: it ends with data, when the other side closes, or at a time limit. One
/// read and one write at a time, all on the thread of its io_context. A callback must own its object, so the object
/// lives as long as an operation runs.
class Channel : public std::enable_shared_from_this<Channel> {
 public:
  using Done = std::function<void(const Code&, std::size_t)>;

  /// `unread`: the longest time that the other side may leave bytes unacknowledged.
  Channel(asio::ip::tcp::socket socket, std::chrono::milliseconds unread);

  /// Limits current and later operations from now on; when the time is over they end with error::timed_out.
  void Limit(std::chrono::milliseconds time);
  void Unlimit();

  /// Ends all operations within that time, regardless of later limits.
  void EndWithin(std::chrono::milliseconds time);

  /// Reads at least one byte.
  void Read(asio::mutable_buffer buffer, Done done);

  /// Sends head and body in pieces, each within `time`. Afterwards there is no limit.
  void Send(std::string head, std::string body, std::chrono::milliseconds time, Done done);

  /// Ends the sending direction and closes when the other side has closed too, so unrequested input does not destroy
  /// the answer (RFC 9112, section 9.6). Time and bytes are limited.
  void Linger(std::function<void()> done);

  /// Ends running operations with an error.
  void Close();

  /// Whether the other side has closed the connection. A side that has only ended its sending looks the same until it
  /// is sent something; so such a side is sent an interim answer (RFC 9110, section 15.2), if it `understands_interim`
  /// ones. A closed side rejects it, which a later call sees.
  bool IsClosedByPeer(bool understands_interim);

  bool is_open() const { return socket_.is_open(); }
  asio::ip::tcp::socket::executor_type executor() { return socket_.get_executor(); }

  /// Total bytes sent.
  std::size_t sent() const { return sent_; }

  /// The other side's address.
  const std::string& peer() const { return peer_; }

 private:
  void SendPiece(std::chrono::milliseconds time, Done done);
  void DiscardInput(std::function<void()> done);
  Code ReasonOf(const Code& code) const;

  asio::ip::tcp::socket socket_;
  asio::steady_timer limit_;
  asio::steady_timer::time_point end_ = asio::steady_timer::time_point::max();
  bool is_late_ = false, has_probed_ = false;
  std::string peer_;
  std::string head_, body_;         ///< Data being sent.
  std::size_t sent_of_answer_ = 0;  ///< Sent bytes of head_ and body_.
  std::size_t sent_ = 0, discarded_ = 0;
  std::array<char, 4096> discard_buffer_ = {};
};

}  // namespace pendulum::wire
