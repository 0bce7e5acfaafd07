// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <utility>

#include "pendulum/acquisition/port.h"
#include "pendulum/acquisition/serial_port.h"
#include "pendulum/base/status.h"
#include "pendulum/base/try.h"
#include "tools/record_pendulum.h"

namespace pendulum {
namespace {

Result<std::unique_ptr<Port>> OpenSerialPort(const std::string& path, unsigned baud) {
  ASSIGN_OR_RETURN(auto port, SerialPort::Open(path, baud));
  return std::make_unique<SerialPort>(std::move(port));
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) { return pendulum::RecordPendulum(pendulum::OpenSerialPort, argc, argv); }
