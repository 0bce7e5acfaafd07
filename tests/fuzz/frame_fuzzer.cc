// SPDX-License-Identifier: Apache-2.0
// Any bytes on the line are frames or are rejected, and a run made from them is a recording with increasing times.
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "pendulum/acquisition/messages.h"
#include "pendulum/acquisition/received_run.h"
#include "pendulum/acquisition/rest.h"
#include "tests/fuzz/require.h"

namespace pendulum {
namespace {

/// Message to bytes to message: an accepted message does not change if it is sent again.
template <class Message>
void RequireSame(const Message& message) {
  std::vector<std::uint8_t> bytes = CommandBytes(message);
  MessageDecoder decoder;
  const std::vector<LoggerMessage> again = decoder.Decode(bytes);
  Require(again.size() == 1 && std::holds_alternative<Message>(again.front()) && decoder.rejected() == 0);
  Require(CommandBytes(std::get<Message>(again.front())) == bytes);
}

void RequireSame(const OtherProtocol& other) { Require(other.version != pendulum_logger::kProtocol); }

void Check(std::span<const std::uint8_t> bytes) {
  MessageDecoder decoder;
  const std::uint8_t choice = bytes.empty() ? 0 : bytes.back();
  ReceivedRun run(SamplingRate{static_cast<std::uint16_t>(choice % 2 == 0 ? 10000 : 250),
                               static_cast<std::uint8_t>(1 + choice % 64)});
  RestDetector rest;
  for (const LoggerMessage& message : decoder.Decode(bytes)) {
    std::visit([](const auto& each) { RequireSame(each); }, message);
    if (const auto* data = std::get_if<pendulum_logger::Data>(&message)) run.AddFrame(*data, 0);
    if (const auto* end = std::get_if<pendulum_logger::End>(&message)) run.SetEnd(*end);
  }
  for (std::size_t i = 0; i < run.size(); ++i) {
    Require(i == 0 || run.Time(i) > run.Time(i - 1));
    Require(run.Counts(i) >= 0 && run.Counts(i) <= kFullScaleCounts);
    rest.AddSample(run.Time(i), run.Counts(i));
    rest.IsAtRest();
  }
  Require(run.Losses().samples >= 0 && run.Losses().on_line >= 0);
  run.KeepUntil(1e-3 * choice);
  Require(run.size() == 0 || run.Time(run.size() - 1) < 1e-3 * choice);
  run.KeepFirst(choice % 16);
  Require(run.size() <= choice % 16u && run.Losses().samples >= 0);
}

/// The input with valid frames: every piece between two zeros gets the correct encoding and CRC, so that the code after
/// these checks is reached too.
std::vector<std::uint8_t> Repaired(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> mended, piece;
  for (const std::uint8_t byte : bytes) {
    if (byte != 0 || piece.empty()) {
      piece.push_back(byte);
      if (piece.size() < pendulum_logger::kMaxPayload) continue;
    }
    const std::uint16_t crc = pendulum_logger::Crc16(piece.data(), piece.size());
    piece.push_back(static_cast<std::uint8_t>(crc));
    piece.push_back(static_cast<std::uint8_t>(crc >> 8));
    std::vector<std::uint8_t> frame(piece.size() + 1);
    pendulum_logger::CobsEncode(piece.data(), piece.size(), frame.data());
    mended.insert(mended.end(), frame.begin(), frame.end());
    mended.push_back(0);
    piece.clear();
  }
  return mended;
}

}  // namespace
}  // namespace pendulum

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  pendulum::Check(bytes);
  pendulum::Check(pendulum::Repaired(bytes));
  return 0;
}
