// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/acquisition/messages.h"
#include "pendulum/acquisition/received_run.h"
#include "tests/firmware/simulated_board.h"

namespace pendulum {

/// A simulated board, with the recorder's decoder and run at the other end of its line.
class Bench {
 public:
  /// The effect of a line on a byte: returns the byte that arrives, or std::nullopt if it is lost.
  using Line = std::function<std::optional<std::uint8_t>(std::uint8_t)>;

  explicit Bench(BoardOptions options) : board_(std::move(options)) { RunFor(0.1); }

  void set_line(Line line) { line_ = std::move(line); }

  /// Sends a command and returns the messages received within a fifth of a second.
  template <class Command>
  std::vector<LoggerMessage> Ask(const Command& command) {
    board_.Send(CommandBytes(command));
    messages_.clear();
    RunFor(0.2);
    return messages_;
  }

  /// The answer of that type to a command; std::nullopt without an answer.
  template <class Answer, class Command>
  std::optional<Answer> Answered(const Command& command) {
    for (const LoggerMessage& message : Ask(command)) {
      if (const auto* answer = std::get_if<Answer>(&message)) return *answer;
    }
    return std::nullopt;
  }

  /// The status of a command's Ack; -1 without one.
  template <class Command>
  int Status(const Command& command) {
    const auto ack = Answered<pendulum_logger::Ack>(command);
    return ack && ack->command == Command::kKind ? ack->status : -1;
  }

  /// Starts a run, records for `seconds` at that rate and stops it; calls `midway` in the middle.
  ReceivedRun& Record(const SamplingRate& rate, double seconds, const std::function<void()>& midway = {}) {
    Status(pendulum_logger::SetRate{rate.period, rate.oversample});
    run_.emplace(rate);
    first_ = board_.conversions().size();
    Ask(pendulum_logger::Command<pendulum_logger::kStart>{});
    board_.TakeLoad();
    RunFor(seconds / 2);
    if (midway) midway();
    RunFor(seconds / 2);
    load_ = board_.TakeLoad();
    Ask(pendulum_logger::Command<pendulum_logger::kStop>{});
    RunFor(0.3);
    return *run_;
  }

  void RunFor(double seconds) {
    constexpr double kStep = 0.02;
    const double end = board_.time() + seconds;
    while (board_.time() < end - 1e-6) {
      board_.RunUntil(std::min(end, board_.time() + kStep));
      Listen();
    }
  }

  /// The conversions of the run as made by the hardware.
  std::vector<AdcConversion> Conversions() const {
    return {board_.conversions().begin() + static_cast<std::ptrdiff_t>(first_), board_.conversions().end()};
  }

  SimulatedBoard& board() { return board_; }
  double load() const { return load_; }
  const std::string& text() const { return text_; }  ///< All received bytes as characters.

 private:
  void Listen() {
    std::vector<std::uint8_t> bytes;
    for (const LineByte& each : board_.TakeBytes()) {
      text_ += static_cast<char>(each.byte);
      if (const auto byte = line_ ? line_(each.byte) : each.byte) bytes.push_back(*byte);
    }
    for (const LoggerMessage& message : decoder_.Decode(bytes)) {
      messages_.push_back(message);
      if (!run_) continue;
      if (const auto* data = std::get_if<pendulum_logger::Data>(&message)) run_->AddFrame(*data, board_.time());
      if (const auto* end = std::get_if<pendulum_logger::End>(&message)) run_->SetEnd(*end);
    }
  }

  SimulatedBoard board_;
  Line line_;
  MessageDecoder decoder_;
  std::vector<LoggerMessage> messages_;
  std::optional<ReceivedRun> run_;
  std::size_t first_ = 0;
  double load_ = 0;
  std::string text_;
};

}  // namespace pendulum
