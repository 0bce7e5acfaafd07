// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "pendulum/acquisition/port.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// Opens a port at a rate [baud].
using OpenPort = std::function<Result<std::unique_ptr<Port>>(const std::string& path, unsigned baud)>;

/// Records a run of pendulum_logger into a CSV file, and fits it when asked to: flags, signals, files and exit codes of
/// the tool record_pendulum. The tests of the firmware open the port of a simulated board.
int RecordPendulum(const OpenPort& open, int argc, char** argv);

}  // namespace pendulum
