// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/acquisition/messages.h"
#include "pendulum/acquisition/received_run.h"
#include "pendulum/acquisition/serial_port.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// A message, and when the host had its last byte [s, HostTime].
struct TimedMessage {
  LoggerMessage message;
  double host_time;
};

/// This computer's monotonic clock [s].
double HostTime();

/// A logger at the other end of a port (firmware/pendulum_logger). Commands are repeated until they are answered.
class Logger {
 public:
  /// Once `stop` is true, what waits for the logger gives up with kTryAgain.
  Logger(SerialPort port, const std::atomic<bool>& stop) : port_(std::move(port)), stop_(stop) {}

  /// Stops whatever the board is doing and asks what it is. Opening the port resets most boards, whose boot loader
  /// then listens for a second or two, so this is patient.
  /// kDataLoss: nothing answers, something else does, or a logger of another protocol, clock or converter.
  Result<pendulum_logger::Info> Connect(double patience_seconds = 5);

  /// kDataLoss: it refuses, or does not answer.
  Result<void> SetRate(const SamplingRate& rate);

  /// Stores a calibration in its EEPROM and gives what it reads back. kDataLoss as above, or it reads back another.
  Result<pendulum_logger::Info> StoreCalibration(const pendulum_logger::StraightLine& line);

  /// From now on Receive gives Data. kDataLoss as above.
  Result<void> Start();

  /// Asks for the end of the run: Data that are on their way come, then End.
  Result<void> RequestStop();

  /// The next message within so many seconds; none when none came. kDataLoss: the port is gone.
  Result<std::optional<TimedMessage>> Receive(double seconds);

  /// Pieces of what came that were no frame, since Start.
  int RejectedFrames() const { return decoder_.rejected() - rejected_before_; }

 private:
  template <typename Pick>
  auto Exchange(const std::vector<std::uint8_t>& commands, int tries, const Pick& pick);
  Result<void> Ask(const std::vector<std::uint8_t>& command, std::uint8_t kind, const std::string& what);
  tl::unexpected<Status> Refused(const OtherProtocol& other) const;
  Result<pendulum_logger::Info> Checked(const pendulum_logger::Info& info) const;
  tl::unexpected<Status> NoAnswer(double seconds) const;
  tl::unexpected<Status> NoAnswerTo(std::uint8_t kind) const;

  SerialPort port_;
  const std::atomic<bool>& stop_;
  MessageDecoder decoder_;
  std::deque<TimedMessage> pending_;
  std::size_t bytes_ = 0;    // received
  int rejected_before_ = 0;  // before the run
};

}  // namespace pendulum
