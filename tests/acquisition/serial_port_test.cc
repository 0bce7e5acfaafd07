// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/serial_port.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include "pendulum/acquisition/device_clock.h"

namespace pendulum::serial_port_test {
namespace {

namespace fs = std::filesystem;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr unsigned kBaud = 115200;

/// A timeout that no test waits for, s. A call that ends within half of it ended for another reason.
constexpr double kNever = 600;

double SecondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A pseudo terminal: bytes written to its board can be read from its port. Initially all translations of a terminal
/// are enabled.
class Cable {
 public:
  Cable() {
    std::array<char, 256> name{};
    EXPECT_EQ(::openpty(&board_, &terminal_, name.data(), nullptr, nullptr), 0);
    path_ = name.data();
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;
  ~Cable() {
    Pull();
    ::close(terminal_);
  }

  void Pull() {
    if (board_ >= 0) ::close(std::exchange(board_, -1));
  }

  void Send(const Bytes& bytes) const {
    EXPECT_EQ(::write(board_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  /// Waits for `count` bytes or the end.
  Bytes Received(std::size_t count) const {
    Bytes bytes(count);
    std::size_t received = 0;
    while (received < count) {
      const ssize_t got = ::read(board_, bytes.data() + received, count - received);
      if (got <= 0) break;
      received += static_cast<std::size_t>(got);
    }
    bytes.resize(received);
    return bytes;
  }

  const std::string& path() const { return path_; }

 private:
  int board_ = -1, terminal_ = -1;
  std::string path_;
};

SerialPort Opened(const Cable& cable) {
  auto port = SerialPort::Open(cable.path(), kBaud);
  EXPECT_TRUE(port) << port.error().message();
  return *std::move(port);
}

/// Reads until `count` bytes have arrived.
Bytes ReadAll(SerialPort& port, std::size_t count) {
  Bytes all;
  while (all.size() < count) {
    const auto bytes = port.Read(kNever);
    EXPECT_TRUE(bytes) << bytes.error().message();
    if (!bytes || bytes->empty()) break;
    all.insert(all.end(), bytes->begin(), bytes->end());
  }
  return all;
}

/// 0 to 255, including Ctrl-C, carriage return, XON and XOFF, Ctrl-D and DEL, which terminals translate.
Bytes EveryByte() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

// ---- Read and write ----------------------------------------------------------------------------------------------

TEST(SerialPort, ReadsAvailableBytes) {
  const Cable cable;
  SerialPort port = Opened(cable);
  EXPECT_EQ(port.path(), cable.path());
  cable.Send({1, 2, 3});
  EXPECT_EQ(ReadAll(port, 3), Bytes({1, 2, 3}));
}

TEST(SerialPort, ReadsWithoutALineEnd) {
  const Cable cable;
  SerialPort port = Opened(cable);
  cable.Send({0x41});
  const auto begin = Clock::now();
  const auto bytes = port.Read(kNever);
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_EQ(*bytes, Bytes({0x41}));
  EXPECT_LT(SecondsSince(begin), kNever / 2);  // does not wait for more
}

TEST(SerialPort, ReadsBytesUntranslated) {
  const Cable cable;
  SerialPort port = Opened(cable);
  cable.Send(EveryByte());
  EXPECT_EQ(ReadAll(port, 256), EveryByte());
}

TEST(SerialPort, WritesBytesUntranslated) {
  const Cable cable;
  SerialPort port = Opened(cable);
  ASSERT_TRUE(port.Write(EveryByte()));
  EXPECT_EQ(cable.Received(256), EveryByte());
}

TEST(SerialPort, EchoesNothing) {
  const Cable cable;
  SerialPort port = Opened(cable);
  cable.Send({'a', '\r', 'b'});
  EXPECT_EQ(ReadAll(port, 3), Bytes({'a', '\r', 'b'}));
  ASSERT_TRUE(port.Write(Bytes({'z'})));
  EXPECT_EQ(cable.Received(1), Bytes({'z'}));
}

TEST(SerialPort, ReadsMoreThanOneBuffer) {
  const Cable cable;
  SerialPort port = Opened(cable);
  Bytes many;
  for (int i = 0; i < 200; ++i) {
    const Bytes every = EveryByte();
    many.insert(many.end(), every.begin(), every.end());
  }
  std::thread board([&] { cable.Send(many); });
  EXPECT_TRUE(ReadAll(port, many.size()) == many);
  board.join();
}

TEST(SerialPort, WritesMoreThanOneBuffer) {
  const Cable cable;
  SerialPort port = Opened(cable);
  const Bytes many(100000, 0x55);
  Bytes received;
  std::thread board([&] { received = cable.Received(many.size()); });
  const auto written = port.Write(many);
  board.join();
  EXPECT_TRUE(written) << written.error().message();
  EXPECT_TRUE(received == many);
}

TEST(SerialPort, RespectsTheTimeout) {
  const Cable cable;
  SerialPort port = Opened(cable);
  const auto begin = Clock::now();
  const auto bytes = port.Read(0.2);
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_THAT(*bytes, IsEmpty());
  EXPECT_GE(SecondsSince(begin), 0.19);
  EXPECT_LT(SecondsSince(begin), 100);  // on a busy machine; the unit is not the minute or the millisecond
  ASSERT_TRUE(port.Read(0));
  ASSERT_TRUE(port.Read(-1));  // the time has already passed
}

TEST(SerialPort, HasTheClockOfThisComputer) {
  const Cable cable;
  SerialPort port = Opened(cable);
  const auto before = Clock::now();
  const double begin = port.Time();
  ASSERT_TRUE(port.Read(0.05));
  const double needed = port.Time() - begin;
  EXPECT_GE(needed, 0.049);
  EXPECT_LE(needed, SecondsSince(before));
  EXPECT_EQ(port.ClockStdDev(), HostClockStdDev());
}

TEST(SerialPort, IsMovable) {
  const Cable cable;
  SerialPort first = Opened(cable);
  SerialPort port(std::move(first));
  cable.Send({7});
  EXPECT_EQ(ReadAll(port, 1), Bytes({7}));
}

// ---- Errors ------------------------------------------------------------------------------------------------------

TEST(SerialPort, ReportsAPulledCable) {
  Cable cable;
  SerialPort port = Opened(cable);
  cable.Pull();
  const auto bytes = port.Read(kNever);
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(bytes.error().message(), HasSubstr(cable.path() + " was disconnected"));
  const auto written = port.Write(Bytes({1}));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, StatusCode::kDataLoss);
}

TEST(SerialPort, ReportsACablePulledWhileWaiting) {
  Cable cable;
  SerialPort port = Opened(cable);
  std::thread board([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cable.Pull();
  });
  const auto begin = Clock::now();
  const auto bytes = port.Read(kNever);
  board.join();
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, StatusCode::kDataLoss);
  EXPECT_LT(SecondsSince(begin), kNever / 2);
}

TEST(SerialPort, TimesOutIfNobodyReads) {
  const Cable cable;
  SerialPort port = Opened(cable);
  const auto written = port.Write(Bytes(1000000, 0x55));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(written.error().message(), HasSubstr("accepts no data"));
}

Status OpenError(const std::string& path) {
  const auto port = SerialPort::Open(path, kBaud);
  EXPECT_FALSE(port) << path;
  return port ? Status{StatusCode::kInternal, ""} : port.error();
}

TEST(SerialPort, IsExclusive) {
  const Cable cable;
  const SerialPort port = Opened(cable);
  const Status error = OpenError(cable.path());
  EXPECT_EQ(error.code, StatusCode::kTryAgain);
  EXPECT_THAT(error.message(), HasSubstr(cable.path() + " is in use by another"));
}

TEST(SerialPort, ReportsAMissingPort) {
  const Status error = OpenError("/dev/no_such_port");
  EXPECT_EQ(error.code, StatusCode::kNotFound);
  EXPECT_THAT(error.message(), HasSubstr("/dev/no_such_port"));
}

TEST(SerialPort, RejectsAFileThatIsNotAPort) {
  const Status error = OpenError("/dev/null");
  EXPECT_EQ(error.code, StatusCode::kDataLoss);
  EXPECT_THAT(error.message(), HasSubstr("/dev/null is not a serial port"));
  EXPECT_EQ(OpenError(fs::temp_directory_path()).code, StatusCode::kDataLoss);
}

// ---- Available ports ---------------------------------------------------------------------------------------------

/// The root of a file system with the parts that ListSerialPorts reads.
class FileSystem {
 public:
  FileSystem() {
    std::string name = (fs::temp_directory_path() / "pendulum_test_XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) root_ = name;
    fs::create_directories(root_ / "sys/class/tty");
  }
  FileSystem(const FileSystem&) = delete;
  FileSystem& operator=(const FileSystem&) = delete;
  ~FileSystem() {
    std::error_code error;
    if (!root_.empty()) fs::remove_all(root_, error);
  }

  void Create(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << "\n";
  }

  /// Adds a port whose `device` links to a folder below sys/devices, as the kernel does.
  void AddPort(const std::string& name, const std::string& device) const {
    const fs::path folder = root_ / "sys/devices" / device, tty = folder / "tty" / name;
    fs::create_directories(tty);
    fs::create_directory_symlink(folder, tty / "device");
    fs::create_directory_symlink(tty, root_ / "sys/class/tty" / name);
  }

  const fs::path& root() const { return root_; }

 private:
  fs::path root_;
};

std::vector<std::string> PathsOf(const std::vector<PortName>& ports) {
  std::vector<std::string> paths;
  for (const PortName& port : ports) paths.push_back(port.path);
  return paths;
}

// A board with its own USB: the port belongs to interface 1-2:1.0 of device 1-2, which has the names.
TEST(ListSerialPorts, DescribesAnUno) {
  const FileSystem files;
  files.AddPort("ttyACM0", "pci0/usb1/1-2/1-2:1.0");
  files.Create("sys/devices/pci0/usb1/1-2/idVendor", "2341");
  files.Create("sys/devices/pci0/usb1/1-2/manufacturer", "Arduino (www.arduino.cc)");
  files.Create("sys/devices/pci0/usb1/1-2/product", "Arduino Uno");
  files.Create("sys/devices/pci0/usb1/idVendor", "1d6b");  // the hub's vendor
  const auto ports = ListSerialPorts(files.root());
  ASSERT_EQ(ports.size(), 1);
  EXPECT_EQ(ports[0].path, "/dev/ttyACM0");
  EXPECT_EQ(ports[0].what, "Arduino (www.arduino.cc) Arduino Uno");
  EXPECT_TRUE(ports[0].is_arduino);
}

// With a bridge, usb-serial adds a level of its own: 1-3:1.0/ttyUSB0. A CH340 reports no manufacturer.
TEST(ListSerialPorts, DescribesACloneByItsBridge) {
  const FileSystem files;
  files.AddPort("ttyUSB0", "pci0/usb1/1-3/1-3:1.0/ttyUSB0");
  files.Create("sys/devices/pci0/usb1/1-3/idVendor", "1a86");
  files.Create("sys/devices/pci0/usb1/1-3/product", "USB Serial");
  const auto ports = ListSerialPorts(files.root());
  ASSERT_EQ(ports.size(), 1);
  EXPECT_EQ(ports[0].path, "/dev/ttyUSB0");
  EXPECT_EQ(ports[0].what, "USB Serial");
  EXPECT_TRUE(ports[0].is_arduino);
}

TEST(ListSerialPorts, DistinguishesBoardsFromOtherDevices) {
  const FileSystem files;
  files.AddPort("ttyACM0", "usb1/1-4/1-4:1.0");
  files.Create("sys/devices/usb1/1-4/idVendor", "12d1");
  files.Create("sys/devices/usb1/1-4/manufacturer", "A modem's");
  const auto ports = ListSerialPorts(files.root());
  ASSERT_EQ(ports.size(), 1);
  EXPECT_EQ(ports[0].what, "A modem's");
  EXPECT_FALSE(ports[0].is_arduino);
}

TEST(ListSerialPorts, ListsOnlyUsbPortsInOrder) {
  const FileSystem files;
  for (const char* name : {"ttyUSB1", "ttyS0", "tty1", "ttyACM1", "console", "ttyUSB0", "ttyACM0", "ptmx"}) {
    files.AddPort(name, std::string("usb1/") + name + "/interface");
  }
  EXPECT_THAT(PathsOf(ListSerialPorts(files.root())),
              ElementsAre("/dev/ttyACM0", "/dev/ttyACM1", "/dev/ttyUSB0", "/dev/ttyUSB1"));
}

TEST(ListSerialPorts, ListsAPortWithoutAnyDescription) {
  const FileSystem files;
  fs::create_directories(files.root() / "sys/class/tty/ttyACM3");  // just unplugged: there is no device
  const auto ports = ListSerialPorts(files.root());
  ASSERT_EQ(ports.size(), 1);
  EXPECT_EQ(ports[0].path, "/dev/ttyACM3");
  EXPECT_EQ(ports[0].what, "");
  EXPECT_FALSE(ports[0].is_arduino);
}

TEST(ListSerialPorts, IsEmptyWithoutPorts) {
  const FileSystem files;
  EXPECT_THAT(ListSerialPorts(files.root()), IsEmpty());
  EXPECT_THAT(ListSerialPorts(files.root() / "elsewhere"), IsEmpty());
}

}  // namespace
}  // namespace pendulum::serial_port_test
