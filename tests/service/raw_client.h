// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace pendulum {

/// The answer to a request.
struct RawAnswer {
  int status = 0;  ///< 0: no answer.
  std::string head, body;
  std::map<std::string, std::string> fields;  ///< Values by field names in lower case.

  std::string operator[](const std::string& name) const { return fields.contains(name) ? fields.at(name) : ""; }
};

/// A connection to 127.0.0.1 at the level of bytes. Reads time out after ten seconds.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience = {10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  RawClient(RawClient&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)),
        is_connected_(other.is_connected_),
        ahead_(std::move(other.ahead_)) {}
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  RawClient& operator=(RawClient&&) = delete;
  ~RawClient() { Close(); }

  bool is_connected() const { return is_connected_; }

  /// False if the other side accepts no more bytes.
  bool Send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// Reads up to and including `end` and returns it; returns all bytes if `end` never arrives.
  std::string ReadUntil(const std::string& end) {
    std::size_t found = 0;
    while ((found = ahead_.find(end)) == std::string::npos) {
      if (!ReadMore()) return std::exchange(ahead_, "");
    }
    return TakeAhead(found + end.size());
  }

  /// Reads one answer. Its body has a Content-Length, is chunked, or ends with the connection.
  RawAnswer Read(bool is_of_head = false) {
    RawAnswer answer;
    answer.head = ReadUntil("\r\n\r\n");
    if (!answer.head.starts_with("HTTP/1.1 ")) return answer;
    answer.status = std::stoi(answer.head.substr(9, 3));
    ReadFields(answer);
    if (is_of_head || answer.status < 200 || answer.status == 204 || answer.status == 304) return answer;
    if (answer["transfer-encoding"] == "chunked") {
      answer.body = ReadChunks();
    } else if (const std::string length = answer["content-length"]; !length.empty()) {
      while (ahead_.size() < std::stoul(length) && ReadMore()) continue;
      answer.body = TakeAhead(std::min<std::size_t>(ahead_.size(), std::stoul(length)));
    } else {
      answer.body = ReadAll();
    }
    return answer;
  }

  RawAnswer Ask(std::string_view bytes) {
    Send(bytes);
    return Read(bytes.starts_with("HEAD "));
  }

  /// Reads until the end of the connection.
  std::string ReadAll() {
    while (ReadMore()) continue;
    return std::exchange(ahead_, "");
  }

  /// Whether the other side closes the connection within ten seconds without sending anything.
  bool IsEnded() {
    std::array<char, 1> byte = {};
    return ahead_.empty() && ::recv(socket_, byte.data(), byte.size(), 0) != 1 && errno != EAGAIN;
  }

  void EndSending() { ::shutdown(socket_, SHUT_WR); }

  void Close() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }

  /// Closes with a reset, which the other side sees as an error.
  void Reset() {
    const linger at_once = {1, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    Close();
  }

 private:
  bool ReadMore() {
    std::array<char, 65536> bytes = {};
    errno = 0;
    const ssize_t read = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (read <= 0) return false;
    ahead_.append(bytes.data(), static_cast<std::size_t>(read));
    return true;
  }

  std::string TakeAhead(std::size_t size) {
    std::string taken = ahead_.substr(0, size);
    ahead_.erase(0, size);
    return taken;
  }

  static void ReadFields(RawAnswer& answer) {
    std::size_t at = answer.head.find("\r\n") + 2;
    for (std::size_t end = 0; (end = answer.head.find("\r\n", at)) != at; at = end + 2) {
      const std::string line = answer.head.substr(at, end - at);
      std::string name = line.substr(0, line.find(':'));
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
      answer.fields[name] = line.substr(std::min(line.size(), line.find(':') + 2));
    }
  }

  std::string ReadChunks() {
    std::string body;
    for (;;) {
      const std::string line = ReadUntil("\r\n");
      const std::size_t size = line.empty() ? 0 : std::stoul(line, nullptr, 16);
      while (ahead_.size() < size + 2 && ReadMore()) continue;
      const std::string chunk = TakeAhead(size + 2);
      if (size == 0) return body;
      body += chunk.substr(0, size);
    }
  }

  int socket_;
  bool is_connected_ = false;
  std::string ahead_;
};

}  // namespace pendulum
