// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/acquisition/messages.h"
#include "pendulum/acquisition/port.h"
#include "pendulum/acquisition/received_run.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// A message, and when the host received its last byte [s, Port::Time].
struct TimedMessage {
  LoggerMessage message;
  double host_time;
};

/// A logger connected to a port (firmware/pendulum_logger). Commands are repeated until they are answered.
class Logger {
 public:
  /// Once `stop` is true, functions that wait for the logger return kTryAgain.
  Logger(Port& port, const std::atomic<bool>& stop) : port_(port), stop_(stop) {}

  /// Stops a running measurement and asks the board for its Info. Opening the port resets most boards, and their boot
  /// loader then listens for a second or two; `timeout_seconds` must cover that. kDataLoss: no answer, not a logger,
  /// or a logger with another protocol, clock or converter.
  Result<pendulum_logger::Info> Connect(double timeout_seconds = 5);

  /// Sets the sampling rate. kDataLoss: the logger refuses or does not answer.
  Result<void> SetRate(const SamplingRate& rate);

  /// Stores a calibration in the EEPROM and returns the Info read back. kDataLoss: as above, or the calibration read
  /// back differs.
  Result<pendulum_logger::Info> StoreCalibration(const pendulum_logger::StraightLine& line);

  /// Starts a run; Receive then returns Data. kDataLoss as above.
  Result<void> Start();

  /// Asks the logger to end the run. Data already sent still arrive, then End.
  Result<void> RequestStop();

  /// The next message within `seconds`; std::nullopt if none arrives. kDataLoss: the port is gone.
  Result<std::optional<TimedMessage>> Receive(double seconds);

  const Port& port() const { return port_; }

  /// Number of invalid pieces of data received since Start.
  int RejectedFrames() const { return decoder_.rejected() - rejected_before_; }

 private:
  template <typename Pick>
  auto Exchange(const std::vector<std::uint8_t>& commands, int tries, const Pick& pick);
  Result<void> Ask(const std::vector<std::uint8_t>& command, std::uint8_t kind, const std::string& what);
  tl::unexpected<Status> OtherProtocolError(const OtherProtocol& other) const;
  Result<pendulum_logger::Info> CheckInfo(const pendulum_logger::Info& info) const;
  tl::unexpected<Status> NoAnswer(double seconds) const;
  tl::unexpected<Status> NoAnswerTo(std::uint8_t kind) const;

  Port& port_;
  const std::atomic<bool>& stop_;
  MessageDecoder decoder_;
  std::deque<TimedMessage> pending_;
  std::size_t bytes_ = 0;    // received so far
  int rejected_before_ = 0;  // rejected before the run
};

}  // namespace pendulum
