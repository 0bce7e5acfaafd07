// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/serial_port.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include <asm/termbits.h>  // <termios.h> does not define termios2
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "pendulum/acquisition/device_clock.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

constexpr int kWriteMilliseconds = 1000;

/// The first line of a small file; empty if there is no such file.
std::string LineOf(const fs::path& path) {
  std::string line;
  std::ifstream file(path);
  std::getline(file, line);
  return line;
}

/// USB vendors of boards and of the bridges on clones: Arduino (two), WCH CH340, FTDI, Silicon Labs CP210x.
bool IsArduinoVendor(const std::string& vendor) {
  constexpr std::array<std::string_view, 5> kVendors = {"2341", "2a03", "1a86", "0403", "10c4"};
  return std::ranges::find(kVendors, vendor) != kVendors.end();
}

/// Searches upwards from the port's interface to its USB device, which has a vendor.
PortName Described(const fs::path& device, const std::string& path) {
  PortName port{path, "", false};
  std::error_code error;
  fs::path folder = fs::canonical(device, error);
  if (error) return port;
  for (int level = 0; level < 4 && !error && !fs::exists(folder / "idVendor", error); ++level) {
    folder = folder.parent_path();
  }
  const std::string maker = LineOf(folder / "manufacturer"), product = LineOf(folder / "product");
  port.what = maker + (maker.empty() || product.empty() ? "" : " ") + product;
  port.is_arduino = IsArduinoVendor(LineOf(folder / "idVendor"));
  return port;
}

tl::unexpected<Status> Lost(const std::string& path, const std::string& why) {
  return Error(StatusCode::kDataLoss, path + " was disconnected (" + why + "); check the cable");
}

}  // namespace

std::vector<PortName> ListSerialPorts(const fs::path& root) {
  std::vector<PortName> ports;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root / "sys/class/tty", error)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("ttyACM") && !name.starts_with("ttyUSB")) continue;
    ports.push_back(Described(entry.path() / "device", "/dev/" + name));
  }
  std::ranges::sort(ports, {}, &PortName::path);
  return ports;
}

Result<SerialPort> SerialPort::Open(const std::string& path, unsigned baud) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    if (error == ENOENT || error == ENODEV || error == ENXIO) {
      return Error(StatusCode::kNotFound, "there is no port " + path + "; record_pendulum --list shows the ports");
    }
    if (error == EBUSY) {
      return Error(StatusCode::kTryAgain, path + " is in use by another program; close the Serial Monitor");
    }
    const std::string remedy =
        error == EACCES ? "; ports belong to the group dialout: sudo adduser $USER dialout, and log in again" : "";
    return Error(StatusCode::kDataLoss, "cannot open " + path + ": " + SystemErrorText(error) + remedy);
  }
  SerialPort port(descriptor, path);
  RETURN_IF_ERROR(port.Configure(baud));
  return port;
}

SerialPort::SerialPort(SerialPort&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

SerialPort::~SerialPort() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> SerialPort::Configure(unsigned baud) {
  termios2 settings{};
  if (::ioctl(descriptor_, TCGETS2, &settings) != 0) {
    return Error(StatusCode::kDataLoss, path_ + " is not a serial port; record_pendulum --list shows the ports");
  }
  // TIOCEXCL prevents other programs from opening the port, except root's. The lock is for programs that check it.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    return Error(StatusCode::kTryAgain, path_ + " is in use by another record_pendulum");
  }
  ::ioctl(descriptor_, TIOCEXCL);
  settings.c_iflag = IGNBRK | IGNPAR;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;  // without HUPCL, so closing the port does not reset the board
  settings.c_ispeed = settings.c_ospeed = baud;
  settings.c_cc[VMIN] = 1;  // reading 0 bytes then means that the port is gone
  settings.c_cc[VTIME] = 0;
  if (::ioctl(descriptor_, TCSETS2, &settings) != 0) {
    return Error(StatusCode::kDataLoss,
                 path_ + " cannot be set to " + std::to_string(baud) + " baud: " + SystemErrorText(errno));
  }
  return {};
}

Result<std::vector<std::uint8_t>> SerialPort::Read(double seconds) {
  pollfd waiting{descriptor_, POLLIN, 0};
  const int ready = ::poll(&waiting, 1, static_cast<int>(std::ceil(1000 * std::max(0.0, seconds))));
  if (ready == 0 || (ready < 0 && errno == EINTR)) return std::vector<std::uint8_t>();
  constexpr std::size_t kRoom = 4096;
  std::vector<std::uint8_t> bytes(kRoom);
  const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return std::vector<std::uint8_t>();
  if (count < 0) return Lost(path_, SystemErrorText(errno));
  if (count == 0) return Lost(path_, "end of file");
  bytes.resize(static_cast<std::size_t>(count));
  return bytes;
}

Result<void> SerialPort::Write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    pollfd waiting{descriptor_, POLLOUT, 0};
    const int ready = ::poll(&waiting, 1, kWriteMilliseconds);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0)
      return Error(StatusCode::kDataLoss, path_ + " accepts no data; unplug the board and plug it in again");
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (count < 0) return Lost(path_, SystemErrorText(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

double SerialPort::Time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double SerialPort::ClockStdDev() const { return HostClockStdDev(); }

}  // namespace pendulum
