// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <pendulum_logger/frame.h>

#include "pendulum/acquisition/serial_port.h"
#include "pendulum/base/status.h"
#include "tools/record_run.h"

namespace pendulum {

/// What was recorded, for people: logger, samples and losses, readings, clock, why it ended, and warnings.
std::string RecordText(const RecordedRun& recorded, const std::string& path);

/// What there is to worry about in it: lost samples, an end that did not arrive, saturated readings, a clock that is
/// none, a copy that could not be kept.
std::vector<Warning> RecordWarnings(const RecordedRun& recorded);

/// True unless samples are missing, or the recording is shorter than was asked for.
bool IsComplete(const RecordedRun& recorded);

/// What a logger says of itself.
std::string LoggerText(const pendulum_logger::Info& info, const std::string& port);

/// The ports there are, one a line.
std::string PortsText(const std::vector<PortName>& ports);

}  // namespace pendulum
