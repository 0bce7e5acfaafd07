// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pendulum_logger/frame.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

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
  double frame_seconds = 0.004;  ///< Between frames of 8 samples; shorter than real time, for quick tests.
  int frames = 1000000;          ///< After so many frames, `then` happens.
  Then then = Then::kSilence;
  std::set<int> lost_frames;  ///< Lost on the line; numbered from 0.
  bool sends_end = true;
};

/// A logger connected through a pseudo terminal, in its own thread.
class ScriptedLogger {
 public:
  explicit ScriptedLogger(LoggerScript script) : script_(std::move(script)), info_(script_.info) {
    std::array<char, 256> name{};
    EXPECT_EQ(::openpty(&board_, &terminal_, name.data(), nullptr, nullptr), 0);
    path_ = name.data();
    ::fcntl(board_, F_SETFL, O_NONBLOCK);
    info_.is_running = script_.begins_running ? 1 : 0;
    thread_ = std::thread([this] { Work(); });
  }
  ScriptedLogger(const ScriptedLogger&) = delete;
  ScriptedLogger& operator=(const ScriptedLogger&) = delete;
  ~ScriptedLogger() {
    SwitchOff();
    if (board_ >= 0) ::close(board_);
    ::close(terminal_);
  }

  const std::string& path() const { return path_; }

  /// Stops the logger and returns the first byte of each command received, in order.
  std::string Heard() {
    SwitchOff();
    return heard_;
  }

 private:
  /// Waits until everything written has been read, because unread data are lost with the terminal.
  void Unplug() {
    constexpr int kMaxWaits = 2000;
    for (int waits = 0, unread = 1; unread > 0 && waits < kMaxWaits; ++waits) {
      if (::ioctl(terminal_, FIONREAD, &unread) != 0) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::close(std::exchange(board_, -1));
  }

  using Clock = std::chrono::steady_clock;
  static constexpr int kBlock = 8;  // samples in a frame

  void SwitchOff() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }

  void Work() {
    Write(script_.greeting);
    while (!is_over_ && board_ >= 0) {
      Listen();
      Write(script_.chatter);
      if (info_.is_running != 0) Run();
    }
  }

  void Listen() {
    pollfd waiting{board_, POLLIN, 0};
    ::poll(&waiting, 1, script_.chatter.empty() ? 1 : 20);
    std::array<std::uint8_t, 256> bytes{};
    const ssize_t count = ::read(board_, bytes.data(), bytes.size());
    if (Clock::now() - begin_ < std::chrono::duration<double>(script_.deaf_seconds)) return;
    for (ssize_t i = 0; i < count; ++i) {
      if (receiver_.Take(bytes.at(static_cast<std::size_t>(i))) == pendulum_logger::Receiver::kFrame) Obey();
    }
  }

  void Obey() {
    const char command = static_cast<char>(receiver_.payload()[0]);
    heard_ += command;
    if (script_.is_mute) return;
    const std::uint8_t status = script_.refused.contains(command) ? script_.refused[command] : Done(command);
    if (script_.lost_answers[command]-- > 0) return;
    if (command == 'I') {
      Send(info_);
    } else {
      Send(pendulum_logger::Ack{receiver_.payload()[0], status});
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
    next_frame_ = Clock::now() + std::chrono::milliseconds(20);  // after the answer
    return pendulum_logger::kDone;
  }

  std::uint8_t Stop() {
    if (info_.is_running != 0 && script_.sends_end) Send(EndOfRun());
    info_.is_running = 0;
    return pendulum_logger::kDone;
  }

  pendulum_logger::End EndOfRun() const {
    return {static_cast<std::uint32_t>(std::min(frame_, script_.frames) * kBlock), 0, 0};
  }

  void Run() {
    if (frame_ == script_.frames) return Finish();
    if (frame_ > script_.frames || Clock::now() < next_frame_) return;
    next_frame_ += std::chrono::microseconds(static_cast<int>(1e6 * script_.frame_seconds));
    const std::uint32_t step = std::uint32_t{info_.period} * info_.oversample;
    pendulum_logger::Data data{};
    data.sequence = static_cast<std::uint16_t>(frame_);
    data.tick = 0xFFFFF000U + static_cast<std::uint32_t>(frame_ * kBlock) * step;  // wraps around soon
    for (data.count = 0; data.count < kBlock; ++data.count) {
      const double time = (frame_ * kBlock + data.count) * (step / 2e6);
      data.sums[data.count] = static_cast<std::uint16_t>(info_.oversample * script_.counts(time));
    }
    if (!script_.lost_frames.contains(frame_)) Send(data);
    ++frame_;
  }

  /// Does what the script specifies instead of the rest of the run.
  void Finish() {
    std::this_thread::sleep_for(std::chrono::milliseconds(150));  // lets the host read the data sent so far
    ++frame_;
    info_.is_running = script_.then == LoggerScript::Then::kSilence ? 1 : 0;
    if (script_.then == LoggerScript::Then::kUnplugged) Unplug();
    if (script_.then == LoggerScript::Then::kEnd) Send(EndOfRun());
    if (script_.then == LoggerScript::Then::kReset) Send(info_);
  }

  template <class Message>
  void Send(const Message& message) {
    std::vector<std::uint8_t> frame(pendulum_logger::kMaxEncoded + 1);
    frame.resize(pendulum_logger::MakeFrame(message, frame.data()));
    Write(frame);
  }

  void Write(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t at = 0; at < bytes.size() && !is_over_;) {
      const ssize_t count = ::write(board_, bytes.data() + at, bytes.size() - at);
      if (count > 0) at += static_cast<std::size_t>(count);
      if (count <= 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  LoggerScript script_;
  pendulum_logger::Info info_;
  int board_ = -1, terminal_ = -1;
  std::string path_, heard_;
  Clock::time_point begin_ = Clock::now(), next_frame_ = begin_;
  pendulum_logger::Receiver receiver_;
  int frame_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace pendulum
