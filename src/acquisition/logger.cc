// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/logger.h"

#include <cmath>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

namespace wire = pendulum_logger;

constexpr double kRepeatSeconds = 0.5;  // an unanswered command is then sent again
constexpr int kTries = 4;

tl::unexpected<Status> Interrupted() {
  return Error(StatusCode::kTryAgain, "interrupted before anything was recorded");
}

bool AreEqual(const wire::StraightLine& a, const wire::StraightLine& b) {
  return a.offset_deg == b.offset_deg && a.deg_per_count == b.deg_per_count && a.offset_variance == b.offset_variance &&
         a.covariance == b.covariance && a.slope_variance == b.slope_variance;
}

/// The message as the answer to the command `kind`; std::nullopt if it is not that answer.
std::optional<wire::Ack> AckOf(std::uint8_t kind, const TimedMessage& received) {
  const auto* ack = std::get_if<wire::Ack>(&received.message);
  return ack != nullptr && ack->command == kind ? std::optional(*ack) : std::nullopt;
}

std::string RefusalReason(std::uint8_t status) {
  if (status == wire::kOutOfRange) return "a value is out of its range";
  if (status == wire::kRunning) return "it is recording";
  return "it does not know the command";
}

}  // namespace

Result<std::optional<TimedMessage>> Logger::Receive(double seconds) {
  const double until = port_.Time() + seconds;
  while (pending_.empty()) {
    ASSIGN_OR_RETURN(const auto bytes, port_.Read(until - port_.Time()));
    const double now = port_.Time();
    bytes_ += bytes.size();
    for (const LoggerMessage& message : decoder_.Decode(bytes)) pending_.push_back({message, now});
    if (pending_.empty() && (stop_ || now >= until)) return std::nullopt;
  }
  const TimedMessage next = pending_.front();
  pending_.pop_front();
  return next;
}

tl::unexpected<Status> Logger::NoAnswer(double seconds) const {
  if (stop_) return Interrupted();
  const std::string waited = " within " + NumberText(seconds, 2) + " s";
  if (bytes_ == 0) {
    return Error(StatusCode::kDataLoss,
                 "no logger answers on " + port_.path() + waited +
                     "; check that firmware/pendulum_logger is on the board and that this is its port");
  }
  return Error(StatusCode::kDataLoss, "the device on " + port_.path() + " is not a pendulum_logger (" +
                                          std::to_string(bytes_) + " bytes" + waited +
                                          ", but no answer); check that the sketch firmware/pendulum_logger is on the "
                                          "board, with the baud rate of --baud");
}

/// Sends commands, and repeats them until `pick` accepts a message as the answer. `pick` returns an optional;
/// std::nullopt means that the message is not the answer.
template <typename Pick>
auto Logger::Exchange(const std::vector<std::uint8_t>& commands, int tries, const Pick& pick) {
  using Answer = Result<decltype(pick(TimedMessage()))>;
  for (int i = 0; i < tries && !stop_; ++i) {
    if (auto sent = port_.Write(commands); !sent) return Answer(tl::unexpected(sent.error()));
    const double repeat = port_.Time() + kRepeatSeconds;
    while (port_.Time() < repeat) {
      const auto received = Receive(repeat - port_.Time());
      if (!received) return Answer(tl::unexpected(received.error()));
      if (!*received) break;
      if (auto answer = pick(**received)) return Answer(std::move(answer));
    }
  }
  return Answer(std::nullopt);
}

Result<wire::Info> Logger::Connect(double timeout_seconds) {
  std::vector<std::uint8_t> commands = CommandBytes(wire::Command<wire::kStop>{});
  const std::vector<std::uint8_t> ask = CommandBytes(wire::Command<wire::kAskInfo>{});
  commands.insert(commands.end(), ask.begin(), ask.end());
  const auto pick = [this](const TimedMessage& received) -> std::optional<Result<wire::Info>> {
    if (const auto* other = std::get_if<OtherProtocol>(&received.message)) return OtherProtocolError(*other);
    const auto* info = std::get_if<wire::Info>(&received.message);
    return info != nullptr && info->is_running == 0 ? std::optional(CheckInfo(*info)) : std::nullopt;
  };
  ASSIGN_OR_RETURN(const auto answer,
                   Exchange(commands, static_cast<int>(std::ceil(timeout_seconds / kRepeatSeconds)), pick));
  if (!answer) return NoAnswer(timeout_seconds);
  return *answer;
}

tl::unexpected<Status> Logger::OtherProtocolError(const OtherProtocol& other) const {
  return Error(StatusCode::kDataLoss,
               "the logger on " + port_.path() + " speaks version " + std::to_string(other.version) +
                   " of the protocol, but this record_pendulum speaks version " + std::to_string(wire::kProtocol) +
                   "; put the firmware/pendulum_logger of the same release on the board");
}

/// Checks the properties that the host relies on to interpret times and counts.
Result<wire::Info> Logger::CheckInfo(const wire::Info& info) const {
  const auto differs = [&](const std::string& what, std::uint32_t its, std::uint32_t ours) {
    return Error(StatusCode::kDataLoss, "the logger on " + port_.path() + " has " + std::to_string(its) + " " + what +
                                            ", but this record_pendulum reads " + std::to_string(ours) +
                                            "; put the firmware/pendulum_logger of the same release on the board");
  };
  if (info.tick_hz != wire::kTickHz) return differs("ticks a second", info.tick_hz, wire::kTickHz);
  if (info.adc_bits != wire::kAdcBits) return differs("bits in its converter", info.adc_bits, wire::kAdcBits);
  return info;
}

/// The error for a logger that answered before but does not answer now.
tl::unexpected<Status> Logger::NoAnswerTo(std::uint8_t kind) const {
  if (stop_) return Interrupted();
  return Error(StatusCode::kDataLoss, "the logger on " + port_.path() + " answered before, but does not answer '" +
                                          static_cast<char>(kind) + "' within " +
                                          NumberText(kTries * kRepeatSeconds, 2) +
                                          " s; unplug the board, plug it in and try again");
}

Result<void> Logger::Ask(const std::vector<std::uint8_t>& command, std::uint8_t kind, const std::string& what) {
  ASSIGN_OR_RETURN(const auto ack,
                   Exchange(command, kTries, [kind](const TimedMessage& received) { return AckOf(kind, received); }));
  if (!ack) return NoAnswerTo(kind);
  if (ack->status == wire::kDone) return {};
  return Error(StatusCode::kDataLoss, "the logger refuses " + what + ": " + RefusalReason(ack->status));
}

Result<void> Logger::SetRate(const SamplingRate& rate) {
  return Ask(CommandBytes(wire::SetRate{rate.period, rate.oversample}), wire::kSetRate,
             NumberText(rate.Hz(), 6) + " Hz");
}

Result<wire::Info> Logger::StoreCalibration(const wire::StraightLine& line) {
  auto stored = Ask(CommandBytes(wire::StoreCalibration{line}), wire::kStoreCalibration, "the calibration");
  if (!stored) return tl::unexpected(stored.error());
  auto info = Connect();
  if (info && (info->has_calibration == 0 || !AreEqual(info->calibration, line))) {
    return Error(StatusCode::kDataLoss,
                 "the logger does not return the calibration that was stored; its EEPROM may be worn out");
  }
  return info;
}

Result<void> Logger::Start() {
  rejected_before_ = decoder_.rejected();
  const auto pick = [this](const TimedMessage& received) -> std::optional<wire::Ack> {
    if (!std::holds_alternative<wire::Data>(received.message)) return AckOf(wire::kStart, received);
    pending_.push_front(received);  // the run has started; only the answer was lost
    return wire::Ack{wire::kStart, wire::kDone};
  };
  const auto ack = Exchange(CommandBytes(wire::Command<wire::kStart>{}), kTries, pick);
  if (!ack || !*ack) {
    RequestStop();  // the run may have started although all its messages were lost
    return ack ? NoAnswerTo(wire::kStart) : tl::unexpected(ack.error());
  }
  // kRunning: only the answer to an earlier try was lost.
  if ((*ack)->status == wire::kDone || (*ack)->status == wire::kRunning) return {};
  return Error(StatusCode::kDataLoss, "the logger refuses to start: " + RefusalReason((*ack)->status));
}

Result<void> Logger::RequestStop() { return port_.Write(CommandBytes(wire::Command<wire::kStop>{})); }

}  // namespace pendulum
