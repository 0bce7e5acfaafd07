// SPDX-License-Identifier: Apache-2.0
// A simulated logger: the firmware in simavr, and a pendulum on the potentiometer. In real time, its serial port is a
// pseudo terminal, for users without an Arduino. With --virtual_clock, time passes only while the record_pendulum of
// the tests waits (VirtualLine), so what it records is always the same.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gflags/gflags.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <termios.h>
#include <unistd.h>

#include "pendulum/model/rig.h"
#include "pendulum/request/flag_values.h"
#include "pendulum/trajectory/trajectory.h"
#include "tests/firmware/potentiometer.h"
#include "tests/firmware/simulated_board.h"
#include "tests/firmware/virtual_line.h"
#include "tools/run_tool.h"
#include "tools/simulate_pendulum_options.h"

DEFINE_string(firmware, "", "ELF file of pendulum_logger.");
DEFINE_string(board, "uno", "uno or mega; default uno.");
DEFINE_string(link, "", "Path at which a link to the serial port is created.");
DEFINE_bool(virtual_clock, false,
            "Lets time pass only while the record_pendulum of the tests waits; --link is its socket. Default off.");
DEFINE_string(eeprom, "", "File that keeps the EEPROM from one power-on to the next; default none.");
DEFINE_string(truth, "", "File for the true values of the run (JSON); default none.");
DEFINE_string(rig, "", "Rig file; default none.");
DEFINE_string(model, "coulomb", "Model of the motion; default coulomb.");
DEFINE_string(set, "", "Parameters, name=value,...; release_time is counted from the first sample.");
DEFINE_string(hold_deg, "", "Angles on the sensor's scale at which the pendulum is held in the first runs, deg,...");
DEFINE_string(release_angles, "",
              "Release angles of the later runs, rad,...; further runs use the last one; default: from --set.");
DEFINE_double(reference_voltage, 5, "Reference of the converter, V; default 5.");
DEFINE_double(supply_voltage, 5, "Supply across the potentiometer, V; default 5.");
DEFINE_double(potentiometer_range_deg, 270, "Electrical travel of the potentiometer, deg; default 270.");
DEFINE_double(noise, 0, "Standard deviation of the noise before rounding, counts; default 0.");
DEFINE_double(nonlinearity, 0, "Bow of the converter at half scale, counts; default 0.");
DEFINE_double(supply_ripple, 0, "Relative ripple of the supply, which is also the reference; default 0.");
DEFINE_double(clock_ppm, 0, "How much too fast the board's resonator is, ppm; default 0.");
DEFINE_double(flip, 0, "Probability that a byte on its way to the host has one wrong bit; default 0.");
DEFINE_double(drop, 0, "Probability that a byte on its way to the host is lost; default 0.");
DEFINE_double(unplug_after, 0,
              "Seconds after the start of a run when the cable is pulled, in real time; default never.");
DEFINE_double(boot_seconds, 0, "Seconds during which a boot loader sends bytes before the firmware runs; default 0.");
DEFINE_uint64(seed, 1, "Seed of the noise and of the line errors; default 1.");

namespace pendulum {
namespace {

std::sig_atomic_t volatile is_stopped = 0;

std::vector<double> Numbers(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& each : Split(text, ',')) numbers.push_back(std::stod(each));
  return numbers;
}

/// The pendulum on the board's potentiometer, and the hand that holds it. The hand releases it a given time after the
/// logger starts to sample.
class Swing {
 public:
  Swing(const SimulateOptions& options, const PotentiometerOptions& potentiometer)
      : synthetic_(options.synthetic), potentiometer_(potentiometer) {
    Release(synthetic_.release_angle);
  }

  /// Called when the next run begins.
  void BeginAt(double time) {
    begin_ = time;
    const std::vector<double> holds = Numbers(FLAGS_hold_deg), releases = Numbers(FLAGS_release_angles);
    const std::size_t run = runs_++;
    potentiometer_.Reseed(FLAGS_seed + run);  // so a run does not depend on the length of earlier runs
    held_.reset();
    if (run < holds.size()) {
      held_ = holds[run] * kRadFromDeg;
    } else if (!releases.empty()) {
      Release(releases[std::min(run - holds.size(), releases.size() - 1)]);
    }
  }

  int Counts(double time) {
    const double since = begin_ ? std::clamp(time - *begin_, 0.0, kSeconds) : 0;
    const double angle = held_ ? *held_ : trajectory_.Angle(since) + synthetic_.zero;
    return potentiometer_.Counts(angle, time);
  }

 private:
  static constexpr double kSeconds = 3600;

  void Release(double angle) {
    const Start<double> start{synthetic_.start, synthetic_.release_time, angle, 0.0};
    auto trajectory = MakeTrajectory(synthetic_.model, synthetic_.parameters, start, {.begin = 0, .end = kSeconds});
    if (!trajectory) throw std::runtime_error(trajectory.error().message());
    trajectory_ = *std::move(trajectory);
  }

  SyntheticOptions synthetic_;
  Potentiometer potentiometer_;
  Trajectory trajectory_;
  std::size_t runs_ = 0;
  std::optional<double> begin_, held_;
};

/// A pseudo terminal whose other end has a file name.
class PseudoTerminal {
 public:
  explicit PseudoTerminal(std::string link) : link_(std::move(link)) {
    std::vector<char> name(256);
    if (::openpty(&host_side_, &board_side_, name.data(), nullptr, nullptr) != 0) throw std::runtime_error("no pty");
    termios settings{};
    ::tcgetattr(board_side_, &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(board_side_, TCSANOW, &settings);
    ::fcntl(host_side_, F_SETFL, O_NONBLOCK);
    std::filesystem::remove(link_);
    std::filesystem::create_symlink(name.data(), link_);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() { Close(); }

  /// Bytes for which there is no room now are written with the next bytes, because a machine that was suspended reads
  /// many at once. Bytes that nobody reads are lost.
  void Write(const std::vector<std::uint8_t>& bytes) {
    constexpr std::size_t kMaxUnread = std::size_t{1} << 16;
    unread_.insert(unread_.end(), bytes.begin(), bytes.end());
    const ssize_t count = unread_.empty() ? 0 : ::write(host_side_, unread_.data(), unread_.size());
    if (count > 0) unread_.erase(unread_.begin(), unread_.begin() + count);
    if (unread_.size() > kMaxUnread) unread_.clear();
  }

  std::vector<std::uint8_t> Read() {
    std::vector<std::uint8_t> bytes(256);
    const ssize_t count = ::read(host_side_, bytes.data(), bytes.size());
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

  /// Closes the terminal after all written bytes are read, or if this program is to end. Bytes not yet read are lost
  /// with the terminal. A reader may wait long for its disk, and the kernel delays the bytes, so the terminal must be
  /// quiet for some time first.
  void Unplug() {
    if (host_side_ < 0) return;
    constexpr int kQuietLooks = 1000;
    for (int quiet = 0; quiet < kQuietLooks && is_stopped == 0;) {
      Write({});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      int queued = 0;
      if (::ioctl(board_side_, FIONREAD, &queued) != 0) break;
      quiet = queued > 0 || !unread_.empty() ? 0 : quiet + 1;
    }
    Close();
  }

  void Close() {
    if (host_side_ < 0) return;
    ::close(host_side_);
    ::close(board_side_);
    std::filesystem::remove(link_);
    host_side_ = board_side_ = -1;
  }

 private:
  std::string link_;
  std::vector<std::uint8_t> unread_;
  int host_side_ = -1, board_side_ = -1;
};

/// A serial line that damages bytes.
class Line {
 public:
  std::vector<std::uint8_t> Carry(const std::vector<LineByte>& bytes) {
    std::vector<std::uint8_t> carried;
    for (const LineByte& each : bytes) {
      if (uniform_(random_) < FLAGS_drop) continue;
      const bool is_flipped = uniform_(random_) < FLAGS_flip;
      carried.push_back(is_flipped ? static_cast<std::uint8_t>(each.byte ^ 1 << random_() % 8) : each.byte);
    }
    return carried;
  }

 private:
  std::mt19937_64 random_{FLAGS_seed + 1000};
  std::uniform_real_distribution<double> uniform_;
};

std::vector<std::uint8_t> BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteBytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void WriteTruth(const SimulateOptions& options, const PotentiometerOptions& potentiometer) {
  nlohmann::ordered_json truth;
  for (const auto& [name, value] : options.truth) truth[name] = value;
  const double rad_per_count = potentiometer.sensor.DegPerCount() * kRadFromDeg;
  truth["sigma_rad"] = potentiometer.noise * rad_per_count;
  truth["resolution_rad"] = rad_per_count;
  truth["clock_scale"] = 1 / (1 + FLAGS_clock_ppm * 1e-6);
  truth["seed"] = FLAGS_seed;
  std::ofstream(FLAGS_truth) << truth.dump(2) << '\n';
}

Result<SimulateOptions> OptionsOfFlags() {
  std::optional<Rig> rig;
  if (!FLAGS_rig.empty()) {
    auto read = ReadRig(FLAGS_rig);
    if (!read) return tl::unexpected(read.error());
    rig = *std::move(read);
  }
  SimulateFlags flags;
  flags.model = FLAGS_model;
  flags.set = FLAGS_set;
  flags.rig = FLAGS_rig;
  flags.out = "-";
  return MakeSimulateOptions(flags, rig);
}

PotentiometerOptions PotentiometerOfFlags() {
  PotentiometerOptions options;
  options.sensor.reference_voltage = FLAGS_reference_voltage;
  options.sensor.supply_voltage = FLAGS_supply_voltage;
  options.sensor.travel_deg = FLAGS_potentiometer_range_deg;
  options.noise = FLAGS_noise;
  options.nonlinearity = FLAGS_nonlinearity;
  options.supply_ripple = FLAGS_supply_ripple;
  options.seed = FLAGS_seed;
  return options;
}

/// The board with its boot loader and its line. Times are in seconds since it was plugged in.
class PluggedBoard {
 public:
  explicit PluggedBoard(SimulatedBoard& board) : board_(board) {}

  /// The boot loader ignores what is sent to it.
  void Send(const std::vector<std::uint8_t>& bytes) {
    if (!IsBooting()) board_.Send(bytes);
  }

  /// Runs until that time and returns the bytes that the line has carried to the host.
  std::vector<std::uint8_t> RunUntil(double time) {
    constexpr double kBetweenBytes = 0.05;
    time_ = time;
    if (!IsBooting()) {
      board_.RunUntil(time - FLAGS_boot_seconds);
      return line_.Carry(board_.TakeBytes());
    }
    if (time < next_boot_bytes_) return {};
    next_boot_bytes_ = time + kBetweenBytes;
    return {0x30, 0x14, 0x00, 0x10};
  }

  bool IsCablePulled() const {
    return FLAGS_unplug_after > 0 && board_.start() && board_.time() - *board_.start() > FLAGS_unplug_after;
  }

 private:
  bool IsBooting() const { return time_ < FLAGS_boot_seconds; }

  SimulatedBoard& board_;
  Line line_;
  double time_ = 0, next_boot_bytes_ = 0;
};

void RunInRealTime(PluggedBoard& board) {
  using Clock = std::chrono::steady_clock;
  PseudoTerminal terminal(FLAGS_link);
  const Clock::time_point begin = Clock::now();
  while (is_stopped == 0) {
    board.Send(terminal.Read());
    terminal.Write(board.RunUntil(std::chrono::duration<double>(Clock::now() - begin).count()));
    if (board.IsCablePulled()) terminal.Unplug();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// Waits until a socket can be read; returns false if this program is to end.
bool IsReadable(int socket) {
  constexpr int kMilliseconds = 100;  // a signal may arrive just before the wait
  pollfd waiting{socket, POLLIN, 0};
  while (is_stopped == 0) {
    if (::poll(&waiting, 1, kMilliseconds) > 0) return true;
  }
  return false;
}

/// Serves one recorder after the other. As from a USB bridge, bytes come together at a whole millisecond, when the line
/// has been silent for one. A message for each frame is enough then, so a busy computer switches programs less often.
void RunOnVirtualClock(PluggedBoard& board) {
  const VirtualLineListener listener(FLAGS_link);
  std::int64_t milliseconds = 0;
  const auto now = [&] { return static_cast<double>(milliseconds) / 1000; };
  while (IsReadable(listener.socket())) {
    const VirtualLine line = listener.Accept();
    while (IsReadable(line.socket())) {
      const auto asked = line.Receive();
      if (!asked) break;
      board.Send(asked->bytes);
      std::vector<std::uint8_t> bytes;
      const std::int64_t end =
          milliseconds + static_cast<std::int64_t>(std::ceil(1000 * std::max(0.0, asked->seconds)));
      for (bool is_silent = false; milliseconds < end && (bytes.empty() || !is_silent);) {
        ++milliseconds;
        const std::vector<std::uint8_t> more = board.RunUntil(now());
        is_silent = more.empty();
        bytes.insert(bytes.end(), more.begin(), more.end());
      }
      if (!line.Send(now(), bytes)) break;
    }
  }
}

Result<int> Work(const std::vector<std::string>&) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { is_stopped = 1; });
  const auto options = OptionsOfFlags();
  if (!options) return tl::unexpected(options.error());
  const PotentiometerOptions potentiometer = PotentiometerOfFlags();
  Swing swing(*options, potentiometer);
  if (!FLAGS_truth.empty()) WriteTruth(*options, potentiometer);
  BoardOptions made;
  made.mcu = FLAGS_board == "mega" ? "atmega2560" : "atmega328p";
  made.firmware = FLAGS_firmware;
  made.clock_error = FLAGS_clock_ppm * 1e-6;
  made.counts = [&swing](double time) { return swing.Counts(time); };
  made.on_start = [&swing](double time) { swing.BeginAt(time); };
  made.keeps_log = false;
  if (!FLAGS_eeprom.empty()) made.eeprom = BytesOf(FLAGS_eeprom);
  SimulatedBoard board(made);
  PluggedBoard plugged(board);
  if (FLAGS_virtual_clock) {
    RunOnVirtualClock(plugged);
  } else {
    RunInRealTime(plugged);
  }
  if (!FLAGS_eeprom.empty()) WriteBytes(FLAGS_eeprom, board.Eeprom());
  const BoardFaults& faults = board.faults();
  std::cout << nlohmann::json{{"sleeps_with_converter_on", faults.sleeps_with_converter_on},
                              {"swallowed_triggers", faults.swallowed_triggers},
                              {"overrun_bytes", faults.overrun_bytes}}
            << '\n';
  return faults.sleeps_with_converter_on + faults.swallowed_triggers + faults.overrun_bytes == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(
      {"simulated_logger", __FILE__, "Runs pendulum_logger in simavr behind a pseudo terminal until it is stopped.\n\n",
       pendulum::Work},
      argc, argv);
}
