// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/recording/calibration/calibration_table.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// The flags for the calibration of a table of readings, as given.
struct CalibrationFlags {
  int order = 1;            ///< Highest power of the reading.
  std::string input_range;  ///< "low,high" in the unit of the readings; empty: none.
  int bits = 0;             ///< Bits of the converter; 0: not given.
};

/// The options for the calibration of a table.
struct CalibrationOptions {
  int order = 1;
  std::optional<SensorRange> input_range;  ///< Range in the unit of the readings.
  bool has_bits = false;                   ///< The range is that of a converter, so the readings are counts.
};

/// kInvalidArgument: no converter has this many bits.
Result<void> CheckBits(int bits);

/// Checks the flags and converts them to options.
///
/// kInvalidArgument: an order or a range outside its domain, two ranges; the message names the flag.
Result<CalibrationOptions> MakeCalibrationOptions(const CalibrationFlags& flags);

/// CalibrateSensor with these options. kInvalidArgument: the table is in volts, but the range is in counts.
Result<CalibrationFit> CalibrateTable(const CalibrationTable& table, const CalibrationOptions& options);

}  // namespace pendulum
