// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/recording/calibration/adc.h"
#include "pendulum/request/calibration_flags.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of calibrate_sensor as given.
struct CalibrateSensorFlags : CalibrationFlags {
  std::string data;      ///< Path, "-" for stdin; empty: none.
  std::string json;      ///< Path, "-" for stdout; empty: none.
  std::string plot;      ///< Path as for json.
  bool details = false;  ///< Prints points and residuals, too.
  bool plan = false;
  std::string reference_voltage;  ///< "volts,..."; empty: none.
  double supply_voltage = 5;      ///< V
  double potentiometer_range_deg = 270;
  double divider = 1;
  std::vector<std::string> positional;  ///< Arguments that belong to no flag: the table, instead of `data`.
};

/// The task of calibrate_sensor: a plan if `plan` has sensors, otherwise a calibration.
struct CalibrateSensorOptions : CalibrationOptions {
  std::string data;  ///< As in the flags.
  std::string json;  ///< As in the flags.
  std::string plot;
  bool details = false;
  std::vector<AdcSensor> plan;

  /// The output files, with their flags.
  std::vector<NamedFile> Outputs() const;

  /// The input files, with their flags.
  std::vector<NamedFile> Inputs() const;
};

/// Checks the flags and converts them to options.
///
/// kInvalidArgument: neither a table nor a plan, or both of them; a flag of the other task; a number outside its
/// domain; an argument without a flag. The message names the flag.
Result<CalibrateSensorOptions> MakeCalibrateSensorOptions(const CalibrateSensorFlags& flags);

}  // namespace pendulum
