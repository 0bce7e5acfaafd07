// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/recording/calibration/adc.h"
#include "pendulum/request/calibration_flags.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of calibrate_sensor as they were given.
struct CalibrateSensorFlags : CalibrationFlags {
  std::string data;  ///< Path, "-" for stdin, or empty.
  std::string json;  ///< Path, "-" for stdout, or empty for none.
  std::string plot;  ///< As json.
  bool plan = false;
  std::string reference_voltage;  ///< "volts,...", or empty.
  double supply_voltage = 5;      ///< V
  double potentiometer_range_deg = 270;
  double divider = 1;
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// What calibrate_sensor is to do: plan sensors when there are any, else calibrate one.
struct CalibrateSensorOptions : CalibrationOptions {
  std::string data;  ///< As in the flags.
  std::string json;  ///< As in the flags.
  std::string plot;
  std::vector<AdcSensor> plan;

  /// The files to be written, with their flags.
  std::vector<NamedFile> Outputs() const;

  /// The files to be read, with their flags.
  std::vector<NamedFile> Inputs() const;
};

/// Checks the flags and turns them into what is to be done.
///
/// kInvalidArgument: neither a table nor a plan or both, a flag that belongs to the other of them, a number outside its
/// domain, something that belongs to no flag; the message names the flag.
Result<CalibrateSensorOptions> MakeCalibrateSensorOptions(const CalibrateSensorFlags& flags);

}  // namespace pendulum
