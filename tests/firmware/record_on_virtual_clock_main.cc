// SPDX-License-Identifier: Apache-2.0
// record_pendulum at the port of simulated_logger --virtual_clock. Everything else is the tool's own code.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/acquisition/port.h"
#include "pendulum/base/status.h"
#include "tests/firmware/virtual_line.h"
#include "tools/record_pendulum.h"

namespace pendulum {
namespace {

/// A port to the simulated board, with its virtual clock.
class VirtualPort final : public Port {
 public:
  static Result<std::unique_ptr<Port>> Open(const std::string& path, unsigned) {
    auto line = VirtualLine::Connect(path);
    if (!line) return Error(StatusCode::kNotFound, "no simulated_logger --virtual_clock listens at " + path);
    auto port = std::make_unique<VirtualPort>(*std::move(line), path);
    if (auto asked = port->Exchange(0, {}); !asked) return tl::unexpected(asked.error());
    return port;
  }

  VirtualPort(VirtualLine line, std::string path) : line_(std::move(line)), path_(std::move(path)) {}

  Result<std::vector<std::uint8_t>> Read(double seconds) override {
    if (unread_.empty()) {
      if (auto waited = Exchange(seconds, {}); !waited) return tl::unexpected(waited.error());
    }
    return std::exchange(unread_, {});
  }

  Result<void> Write(std::span<const std::uint8_t> bytes) override { return Exchange(0, bytes); }

  double Time() const override { return time_; }
  double ClockStdDev() const override { return 30e-6; }  // of a quartz
  const std::string& path() const override { return path_; }

 private:
  /// Sends bytes to the board and waits for bytes from it.
  Result<void> Exchange(double seconds, std::span<const std::uint8_t> bytes) {
    const auto answer = line_.Send(seconds, bytes) ? line_.Receive() : std::nullopt;
    if (!answer) return Error(StatusCode::kDataLoss, "simulated_logger closed " + path_);
    time_ = answer->seconds;
    unread_.insert(unread_.end(), answer->bytes.begin(), answer->bytes.end());
    return {};
  }

  VirtualLine line_;
  std::string path_;
  double time_ = 0;
  std::vector<std::uint8_t> unread_;
};

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) { return pendulum::RecordPendulum(pendulum::VirtualPort::Open, argc, argv); }
