// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <pendulum_logger/frame.h>

namespace pendulum {

/// An Info of another protocol version. Only its version can be understood.
struct OtherProtocol {
  int version;
};

/// A message from a logger (src/docs/hardware.md, "The protocol").
using LoggerMessage = std::variant<pendulum_logger::Info, pendulum_logger::Data, pendulum_logger::Ack,
                                   pendulum_logger::End, OtherProtocol>;

/// Finds messages in a stream of bytes that may contain other data.
class MessageDecoder {
 public:
  /// Returns the messages that these bytes complete.
  std::vector<LoggerMessage> Decode(std::span<const std::uint8_t> bytes);

  /// Number of pieces of data between two zero bytes that were not a frame, or not a message of a logger.
  int rejected() const { return rejected_; }

 private:
  std::optional<LoggerMessage> Message() const;

  pendulum_logger::Receiver receiver_;
  int rejected_ = 0;
};

/// The bytes of a command, preceded by a 0 that ends anything received before it.
template <class Command>
std::vector<std::uint8_t> CommandBytes(const Command& command) {
  std::vector<std::uint8_t> bytes(1 + pendulum_logger::kMaxEncoded + 1);
  bytes.resize(1 + pendulum_logger::MakeFrame(command, bytes.data() + 1));
  return bytes;
}

/// Texts for people: "Arduino Uno", "version 1.0", "supply voltage (AVcc)"; unknown values are shown as numbers.
std::string BoardName(const pendulum_logger::Info& info);

std::string FirmwareVersion(const pendulum_logger::Info& info);

std::string ReferenceName(const pendulum_logger::Info& info);

}  // namespace pendulum
