// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <pendulum_logger/frame.h>

#include "pendulum/acquisition/device_clock.h"
#include "pendulum/acquisition/received_run.h"
#include "pendulum/base/status.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// What a recording says of itself above its rows.
struct RunDescription {
  pendulum_logger::Info logger{};
  int run = 0;                             ///< How often that logger had been started, this time included.
  std::string begun;                       ///< Date and time of the start, UTC.
  std::optional<Calibration> calibration;  ///< Of counts; none: the file holds counts alone.
  DeviceClock clock;
  std::optional<RunLosses> losses;  ///< None: the run goes on.
};

/// The lines above the rows: comments, the metadata that ReadRecording knows, and the names of the columns time_s and
/// adc_counts. A logger's clock is not applied to the times, as everywhere: # clock_scale says what it is.
std::string RunHead(const RunDescription& description, const SamplingRate& rate);

/// The row of a sample: seconds since the first on the logger's clock, and counts.
std::string RunRow(const ReceivedRun& run, std::size_t sample);

/// The calibration in a logger's EEPROM; none where there is none.
std::optional<Calibration> StoredCalibration(const pendulum_logger::Info& info);

/// A calibration as an EEPROM can keep it, in single precision. kInvalidArgument: of volts, or no straight line.
Result<pendulum_logger::StraightLine> StraightLineOf(const Calibration& calibration);

}  // namespace pendulum
