// SPDX-License-Identifier: Apache-2.0
#include "tests/firmware/virtual_line.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace pendulum {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 16;

/// Both ends are on one computer, so a message is one packet with the number as it is in memory.
int NewSocket() { return ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0); }

sockaddr_un AddressOf(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) throw std::runtime_error("too long for a socket: " + path);
  std::ranges::copy(path, address.sun_path);
  return address;
}

}  // namespace

std::optional<VirtualLine> VirtualLine::Connect(const std::string& path) {
  const sockaddr_un address = AddressOf(path);
  VirtualLine line(NewSocket());
  if (::connect(line.socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return std::nullopt;
  return line;
}

VirtualLine::~VirtualLine() {
  if (socket_ >= 0) ::close(socket_);
}

bool VirtualLine::Send(double seconds, std::span<const std::uint8_t> bytes) const {
  std::vector<std::uint8_t> packet(sizeof seconds + bytes.size());
  std::memcpy(packet.data(), &seconds, sizeof seconds);
  std::ranges::copy(bytes, packet.begin() + sizeof seconds);
  ssize_t count = -1;
  do {
    count = ::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL);
  } while (count < 0 && errno == EINTR);
  return count == static_cast<ssize_t>(packet.size());
}

std::optional<LineMessage> VirtualLine::Receive() const {
  LineMessage message;
  std::vector<std::uint8_t> packet(sizeof message.seconds + kMostBytes);
  ssize_t count = -1;
  do {
    count = ::recv(socket_, packet.data(), packet.size(), 0);
  } while (count < 0 && errno == EINTR);
  if (count < static_cast<ssize_t>(sizeof message.seconds)) return std::nullopt;
  std::memcpy(&message.seconds, packet.data(), sizeof message.seconds);
  message.bytes.assign(packet.begin() + sizeof message.seconds, packet.begin() + count);
  return message;
}

VirtualLineListener::VirtualLineListener(std::string path) : path_(std::move(path)), socket_(NewSocket()) {
  // Whoever sees the file may connect, so it gets its name when the socket listens.
  const std::string early = path_ + ".new";
  const sockaddr_un address = AddressOf(early);
  std::filesystem::remove(early);
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(socket_, 1) != 0) {
    throw std::runtime_error("no socket can be made at " + path_);
  }
  std::filesystem::rename(early, path_);
}

VirtualLineListener::~VirtualLineListener() {
  ::close(socket_);
  std::error_code error;
  std::filesystem::remove(path_, error);
}

VirtualLine VirtualLineListener::Accept() const {
  return VirtualLine(::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC));
}

}  // namespace pendulum
