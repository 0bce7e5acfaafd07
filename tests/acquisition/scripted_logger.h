// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pendulum_logger/frame.h>

#include "pendulum/acquisition/port.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// How a ScriptedLogger deviates from the behaviour in src/docs/hardware.md.
struct LoggerScript {
  /// What happens after `frames` frames of data.
  enum class Then { kSilence, kUnplugged, kReset, kEnd };

  std::vector<std::uint8_t> greeting;           ///< Sent when the board is switched on.
  std::vector<std::uint8_t> chatter;            ///< Sent repeatedly.
  double deaf_seconds = 0;                      ///< For this time after power-on input is ignored, as by a boot loader.
  bool is_mute = false;                         ///< It never answers.
  bool begins_running = false;                  ///< An earlier program left it running.
  bool forgets_calibration = false;             ///< Its EEPROM stores nothing.
  std::map<char, int> lost_answers;             ///< For each command, how many of its first answers are lost.
  std::map<char, std::uint8_t> refused;         ///< Refused commands and the status that is answered.
  pendulum_logger::Info info = {.protocol = 1,  ///< The answer to kAskInfo.
                                .firmware = 0x0100,
                                .board = 1,
                                .reference = 1,
                                .adc_bits = 10,
                                .tick_hz = 2000000,
                                .baud = 115200,
                                .period = 10000,
                                .oversample = 1,
                                .is_running = 0,
                                .run = 41,
                                .has_calibration = 0,
                                .calibration = {}};

  std::function<int(double time)> counts = [](double) { return 500; };  ///< The reading at a time since the start [s].
  double frame_seconds = 0.04;                                          ///< Between frames of 8 samples.
  int frames = 1000000;                                                 ///< After so many frames, `then` happens.
  Then then = Then::kSilence;
  std::set<int> lost_frames;  ///< Lost on the line; numbered from 0.
  bool sends_end = true;
};

/// A logger, and the port to it. Its clock runs only while the host waits in Read, by whole milliseconds, so tests take
/// no time and always give the same.
class ScriptedLogger final : public Port {
 public:
  explicit ScriptedLogger(LoggerScript script)
      : script_(std::move(script)), info_(script_.info), sent_(script_.greeting) {
    info_.is_running = script_.begins_running ? 1 : 0;
  }

  Result<std::vector<std::uint8_t>> Read(double seconds) override {
    const std::int64_t end = milliseconds_ + static_cast<std::int64_t>(std::ceil(1000 * std::max(0.0, seconds)));
    while (sent_.empty() && !is_unplugged_ && milliseconds_ < end) {
      ++milliseconds_;
      if (Turn()) break;
    }
    if (sent_.empty() && is_unplugged_) return Disconnected();
    return std::exchange(sent_, {});
  }

  Result<void> Write(std::span<const std::uint8_t> bytes) override {
    if (is_unplugged_) return Disconnected();
    if (Time() < script_.deaf_seconds) return {};
    for (const std::uint8_t byte : bytes) {
      if (receiver_.Take(byte) == pendulum_logger::Receiver::kFrame) Obey();
    }
    return {};
  }

  double Time() const override { return static_cast<double>(milliseconds_) / 1000; }
  double ClockStdDev() const override { return 30e-6; }  // of a quartz
  const std::string& path() const override { return path_; }

  /// Calls `action` at that time [s], which ends a wait as a signal does.
  void At(double time, std::function<void()> action) { actions_.emplace(time, std::move(action)); }

  /// The first byte of each command received, in order.
  const std::string& Heard() const { return heard_; }

 private:
  static constexpr int kBlock = 8;  // samples in a frame

  tl::unexpected<Status> Disconnected() const { return Error(StatusCode::kDataLoss, path_ + " was disconnected"); }

  /// What happens in a millisecond. Returns whether an action was called.
  bool Turn() {
    constexpr int kBetweenChatter = 20;
    if (milliseconds_ % kBetweenChatter == 0) Send(script_.chatter);
    if (info_.is_running != 0) Run();
    const auto due = actions_.upper_bound(Time());
    const bool has_acted = due != actions_.begin();
    for (auto action = actions_.begin(); action != due; action = actions_.erase(action)) action->second();
    return has_acted;
  }

  void Obey() {
    const char command = static_cast<char>(receiver_.payload()[0]);
    heard_ += command;
    if (script_.is_mute) return;
    const std::uint8_t status = script_.refused.contains(command) ? script_.refused[command] : Done(command);
    if (script_.lost_answers[command]-- > 0) return;
    if (command == 'I') {
      SendFrame(info_);
    } else {
      SendFrame(pendulum_logger::Ack{receiver_.payload()[0], status});
    }
  }

  /// Executes a command and returns its status.
  std::uint8_t Done(char command) {
    pendulum_logger::SetRate rate{};
    pendulum_logger::StoreCalibration store{};
    if (command == 'S') return Start();
    if (command == 'X') return Stop();
    if (receiver_.Read(rate)) {
      info_.period = rate.period;
      info_.oversample = rate.oversample;
    } else if (receiver_.Read(store) && !script_.forgets_calibration) {
      info_.has_calibration = 1;
      info_.calibration = store.calibration;
    }
    return pendulum_logger::kDone;
  }

  std::uint8_t Start() {
    if (info_.is_running != 0) return pendulum_logger::kRunning;
    info_.is_running = 1;
    ++info_.run;
    frame_ = 0;
    next_frame_ = Time() + script_.frame_seconds;
    return pendulum_logger::kDone;
  }

  std::uint8_t Stop() {
    if (info_.is_running != 0 && script_.sends_end) SendFrame(EndOfRun());
    info_.is_running = 0;
    return pendulum_logger::kDone;
  }

  pendulum_logger::End EndOfRun() const {
    return {static_cast<std::uint32_t>(std::min(frame_, script_.frames) * kBlock), 0, 0};
  }

  void Run() {
    if (frame_ > script_.frames || Time() < next_frame_) return;
    if (frame_ == script_.frames) return Finish();
    next_frame_ += script_.frame_seconds;
    const std::uint32_t step = std::uint32_t{info_.period} * info_.oversample;
    pendulum_logger::Data data{};
    data.sequence = static_cast<std::uint16_t>(frame_);
    data.tick = 0xFFFFF000U + static_cast<std::uint32_t>(frame_ * kBlock) * step;  // wraps around soon
    for (data.count = 0; data.count < kBlock; ++data.count) {
      const double time = (frame_ * kBlock + data.count) * (step / 2e6);
      data.sums[data.count] = static_cast<std::uint16_t>(info_.oversample * script_.counts(time));
    }
    if (!script_.lost_frames.contains(frame_)) SendFrame(data);
    ++frame_;
  }

  /// Does what the script specifies instead of the rest of the run.
  void Finish() {
    ++frame_;
    info_.is_running = script_.then == LoggerScript::Then::kSilence ? 1 : 0;
    is_unplugged_ = script_.then == LoggerScript::Then::kUnplugged;
    if (script_.then == LoggerScript::Then::kEnd) SendFrame(EndOfRun());
    if (script_.then == LoggerScript::Then::kReset) SendFrame(info_);
  }

  template <class Message>
  void SendFrame(const Message& message) {
    std::vector<std::uint8_t> frame(pendulum_logger::kMaxEncoded + 1);
    frame.resize(pendulum_logger::MakeFrame(message, frame.data()));
    Send(frame);
  }

  void Send(const std::vector<std::uint8_t>& bytes) { sent_.insert(sent_.end(), bytes.begin(), bytes.end()); }

  LoggerScript script_;
  pendulum_logger::Info info_;
  std::string path_ = "/dev/scripted", heard_;
  std::int64_t milliseconds_ = 0;
  double next_frame_ = 0;
  pendulum_logger::Receiver receiver_;
  int frame_ = 0;
  bool is_unplugged_ = false;
  std::vector<std::uint8_t> sent_;  // not yet read
  std::multimap<double, std::function<void()>> actions_;
};

}  // namespace pendulum
