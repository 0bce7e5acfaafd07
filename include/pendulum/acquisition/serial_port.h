// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/acquisition/port.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// A serial port of this computer, as the user names it.
struct PortName {
  std::string path;         ///< /dev/ttyACM0
  std::string what;         ///< Manufacturer and product as the USB device reports them; may be empty.
  bool is_arduino = false;  ///< According to the USB vendor: Arduino, or a common USB bridge of clones.
};

/// The USB serial ports of this computer, sorted by name. `root` is the root of the file system.
std::vector<PortName> ListSerialPorts(const std::filesystem::path& root = "/");

/// A serial port opened exclusively by this process: 8 bits, no parity, no handshake, no translation of bytes. It may
/// be a pseudo terminal.
class SerialPort final : public Port {
 public:
  /// kNotFound: there is no such port. kTryAgain: another program uses it. kDataLoss: it cannot be opened, is not a
  /// serial port, or does not support the rate.
  static Result<SerialPort> Open(const std::string& path, unsigned baud);

  SerialPort(SerialPort&& other) noexcept;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  SerialPort& operator=(SerialPort&&) = delete;
  ~SerialPort() override;

  Result<std::vector<std::uint8_t>> Read(double seconds) override;

  /// As Port, within a second.
  Result<void> Write(std::span<const std::uint8_t> bytes) override;

  /// This computer's monotonic clock.
  double Time() const override;
  double ClockStdDev() const override;

  const std::string& path() const override { return path_; }

 private:
  SerialPort(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}

  Result<void> Configure(unsigned baud);

  int descriptor_;
  std::string path_;
};

}  // namespace pendulum
