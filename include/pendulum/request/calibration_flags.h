// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/recording/calibration/calibration_table.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// The flags that say how a table of readings is to be calibrated, as they were given.
struct CalibrationFlags {
  int order = 1;            ///< Highest power of the reading.
  std::string input_range;  ///< "low,high" in the unit of the readings, or empty.
  int bits = 0;             ///< Of the converter; 0: not given.
};

/// How a table is to be calibrated.
struct CalibrationOptions {
  int order = 1;
  std::optional<SensorRange> input_range;  ///< In the unit of the readings.
  bool has_bits = false;                   ///< The range is that of a converter, whose readings are counts.
};

/// kInvalidArgument: the bits that --bits gives are none of a converter.
Result<void> CheckBits(int bits);

/// Checks the flags and turns them into what is to be done.
///
/// kInvalidArgument: an order or a range outside its domain, two ranges; the message names the flag.
Result<CalibrationOptions> MakeCalibrationOptions(const CalibrationFlags& flags);

/// CalibrateSensor as the options ask. kInvalidArgument: the table has volts, and the range is one of counts.
Result<CalibrationFit> CalibrateTable(const CalibrationTable& table, const CalibrationOptions& options);

}  // namespace pendulum
