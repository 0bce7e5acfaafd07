// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// A serial port of this computer, as a user may name it.
struct PortName {
  std::string path;         ///< /dev/ttyACM0
  std::string what;         ///< Maker and product as the USB device gives them; empty for none.
  bool is_arduino = false;  ///< By its USB vendor, or one of the usual USB bridges of clones.
};

/// The USB serial ports there are, in the order of their names. `root` is the top of the file system.
std::vector<PortName> ListSerialPorts(const std::filesystem::path& root = "/");

/// A serial port that is open for this process alone, 8 bits, no parity, no handshake, nothing translated. A pseudo
/// terminal will do.
class SerialPort {
 public:
  /// kNotFound: there is no such port. kTryAgain: another program has it. kDataLoss: it may not be opened, is no serial
  /// port, or cannot go at that rate.
  static Result<SerialPort> Open(const std::string& path, unsigned baud);

  SerialPort(SerialPort&& other) noexcept;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  SerialPort& operator=(SerialPort&&) = delete;
  ~SerialPort();

  /// Waits at most so long [s] for bytes and gives those that are there: none when none came, or a signal did.
  /// kDataLoss: the port is gone, as when its cable is pulled.
  Result<std::vector<std::uint8_t>> Read(double seconds);

  /// Writes all bytes, within a second. kDataLoss: the port is gone, or takes none.
  Result<void> Write(std::span<const std::uint8_t> bytes);

  const std::string& path() const { return path_; }

 private:
  SerialPort(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}

  Result<void> Configure(unsigned baud);

  int descriptor_;
  std::string path_;
};

}  // namespace pendulum
