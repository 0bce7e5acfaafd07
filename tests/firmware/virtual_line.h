// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace pendulum {

/// What goes over a VirtualLine. To the logger: bytes for the board, and how long the recorder waits for an answer. To
/// the recorder: the bytes that came from the board first within that time, and the time then.
struct LineMessage {
  double seconds = 0;
  std::vector<std::uint8_t> bytes;
};

/// One end of the line between a recorder and simulated_logger --virtual_clock. The clock runs only while the recorder
/// waits, so a run does not depend on how fast or busy the computer is. The line is a Unix socket.
class VirtualLine {
 public:
  /// std::nullopt if nobody listens at this path.
  static std::optional<VirtualLine> Connect(const std::string& path);

  explicit VirtualLine(int socket) : socket_(socket) {}
  VirtualLine(VirtualLine&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  VirtualLine(const VirtualLine&) = delete;
  VirtualLine& operator=(const VirtualLine&) = delete;
  VirtualLine& operator=(VirtualLine&&) = delete;
  ~VirtualLine();

  /// Returns false if the other end is closed.
  bool Send(double seconds, std::span<const std::uint8_t> bytes) const;

  /// Waits for the next message; std::nullopt if the other end is closed.
  std::optional<LineMessage> Receive() const;

  int socket() const { return socket_; }

 private:
  int socket_;
};

/// The file to which recorders connect, until the listener is destroyed.
class VirtualLineListener {
 public:
  /// Throws std::runtime_error if there can be no socket at this path.
  explicit VirtualLineListener(std::string path);
  VirtualLineListener(const VirtualLineListener&) = delete;
  VirtualLineListener& operator=(const VirtualLineListener&) = delete;
  ~VirtualLineListener();

  /// The line to the next recorder; waits for it.
  VirtualLine Accept() const;

  int socket() const { return socket_; }

 private:
  std::string path_;
  int socket_;
};

}  // namespace pendulum
