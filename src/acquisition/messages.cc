// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/messages.h"

namespace pendulum {
namespace {

namespace wire = pendulum_logger;

}  // namespace

std::optional<LoggerMessage> MessageDecoder::Message() const {
  const auto size = static_cast<std::size_t>(receiver_.size());
  const std::span<const std::uint8_t> payload(receiver_.payload(), size);
  if (size >= 2 && payload[0] == wire::kInfo && payload[1] != wire::kProtocol) return OtherProtocol{payload[1]};
  if (wire::Info info{}; receiver_.Read(info)) return info;
  if (wire::Data data{}; receiver_.Read(data) && data.count > 0) return data;
  if (wire::Ack ack{}; receiver_.Read(ack)) return ack;
  if (wire::End end{}; receiver_.Read(end)) return end;
  return std::nullopt;
}

std::vector<LoggerMessage> MessageDecoder::Decode(std::span<const std::uint8_t> bytes) {
  std::vector<LoggerMessage> messages;
  for (const std::uint8_t byte : bytes) {
    const wire::Receiver::Event event = receiver_.Take(byte);
    if (event == wire::Receiver::kNothing) continue;
    const auto message = event == wire::Receiver::kFrame ? Message() : std::nullopt;
    if (message) {
      messages.push_back(*message);
    } else {
      ++rejected_;
    }
  }
  return messages;
}

std::string BoardName(const wire::Info& info) {
  if (info.board == wire::kUno) return "Arduino Uno";
  if (info.board == wire::kMega2560) return "Arduino Mega 2560";
  return "board " + std::to_string(info.board);
}

std::string FirmwareVersion(const wire::Info& info) {
  return "version " + std::to_string(info.firmware >> 8) + "." + std::to_string(info.firmware & 0xFF);
}

std::string ReferenceName(const wire::Info& info) {
  if (info.reference == 0) return "external voltage (AREF)";
  if (info.reference == 1) return "supply voltage (AVcc)";
  if (info.board == wire::kUno && info.reference == 3) return "internal voltage (1.1 V)";
  if (info.board == wire::kMega2560 && info.reference == 2) return "internal voltage (1.1 V)";
  if (info.board == wire::kMega2560 && info.reference == 3) return "internal voltage (2.56 V)";
  return "voltage " + std::to_string(info.reference);
}

}  // namespace pendulum
