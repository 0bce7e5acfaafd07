// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// A port to a logger, and the clock of the host that reads it. The port of this computer is a SerialPort; tests have
/// ports on which waiting takes no time.
class Port {
 public:
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  Port& operator=(Port&&) = delete;
  virtual ~Port() = default;

  /// Waits at most `seconds` for bytes and returns those available. Returns none after a timeout or a signal.
  /// kDataLoss: the port is gone, for example because its cable was pulled.
  virtual Result<std::vector<std::uint8_t>> Read(double seconds) = 0;

  /// Writes all bytes. kDataLoss: the port is gone or accepts no bytes.
  virtual Result<void> Write(std::span<const std::uint8_t> bytes) = 0;

  /// The time on the host's clock, which is never set [s].
  virtual double Time() const = 0;

  /// Relative standard deviation of the rate of that clock.
  virtual double ClockStdDev() const = 0;

  virtual const std::string& path() const = 0;

 protected:
  Port() = default;
  Port(Port&&) = default;
};

}  // namespace pendulum
