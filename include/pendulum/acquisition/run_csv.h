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

/// The description of a recording in the head of its file.
struct RunDescription {
  pendulum_logger::Info logger{};
  int run = 0;                             ///< How often this logger has been started, including this run.
  std::string begun;                       ///< Date and time of the start, UTC.
  std::optional<Calibration> calibration;  ///< Calibration of the counts; std::nullopt: the file contains only counts.
  DeviceClock clock;
  std::optional<RunLosses> losses;  ///< std::nullopt while the run continues.
};

/// The lines above the rows: comments, the metadata that ReadRecording understands, and the column names time_s and
/// adc_counts. Times are those of the logger's clock, uncorrected as in all files; # clock_scale gives its rate.
std::string RunHead(const RunDescription& description, const SamplingRate& rate);

/// The row of a sample: seconds since the first sample on the logger's clock, and counts.
std::string RunRow(const ReceivedRun& run, std::size_t sample);

/// The calibration stored in a logger's EEPROM; std::nullopt if there is none.
std::optional<Calibration> StoredCalibration(const pendulum_logger::Info& info);

/// A calibration in single precision, as an EEPROM stores it. kInvalidArgument: a calibration of volts, or not a
/// straight line.
Result<pendulum_logger::StraightLine> StraightLineOf(const Calibration& calibration);

}  // namespace pendulum
