// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <pendulum_logger/frame.h>

#include "pendulum/acquisition/serial_port.h"
#include "pendulum/base/warning.h"
#include "tools/record_run.h"

namespace pendulum {

/// A summary of the recording as text: logger, samples and losses, readings, clock, reason of the end, and warnings.
std::string RecordText(const RecordedRun& recorded, const std::string& path);

/// Warnings about lost samples, a missing end frame, saturated readings, an unusable clock, a failed copy on the disk.
std::vector<Warning> RecordWarnings(const RecordedRun& recorded);

/// True unless samples are missing or the recording is shorter than requested.
bool IsComplete(const RecordedRun& recorded);

/// The logger's information about itself.
std::string LoggerText(const pendulum_logger::Info& info, const std::string& port);

/// The available ports, one per line.
std::string PortsText(const std::vector<PortName>& ports);

}  // namespace pendulum
