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

/// An Info of another version of the protocol: nothing else of it is understood.
struct OtherProtocol {
  int version;
};

/// What a logger says (firmware/README.md, "Protocol").
using LoggerMessage = std::variant<pendulum_logger::Info, pendulum_logger::Data, pendulum_logger::Ack,
                                   pendulum_logger::End, OtherProtocol>;

/// Finds messages in bytes as they come, whatever else is among them.
class MessageDecoder {
 public:
  /// The messages that these bytes complete.
  std::vector<LoggerMessage> Take(std::span<const std::uint8_t> bytes);

  /// Pieces between two zeros that were no frame, or none of a logger.
  int rejected() const { return rejected_; }

 private:
  std::optional<LoggerMessage> Message() const;

  pendulum_logger::Receiver receiver_;
  int rejected_ = 0;
};

/// The bytes of a command, behind a 0 that ends whatever came over the line before it.
template <class Command>
std::vector<std::uint8_t> CommandBytes(const Command& command) {
  std::vector<std::uint8_t> bytes(1 + pendulum_logger::kMostEncoded + 1);
  bytes.resize(1 + pendulum_logger::MakeFrame(command, bytes.data() + 1));
  return bytes;
}

/// For people: "Arduino Uno", "version 1.0", "supply voltage (AVcc)"; of unknown ones their numbers.
std::string BoardName(const pendulum_logger::Info& info);

std::string FirmwareVersion(const pendulum_logger::Info& info);

std::string ReferenceName(const pendulum_logger::Info& info);

}  // namespace pendulum
