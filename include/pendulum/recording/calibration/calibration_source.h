// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// A calibration from the text of a file, recognised by its content: JSON as for ParseCalibration, or a table as for
/// ParseCalibrationTable, through which a straight line is fitted (CalibrateSensor). Calibration::note then says so.
/// Errors as these functions.
Result<Calibration> CalibrationFromText(std::string_view text, const std::string& name);

/// The same from a file. kNotFound: no such file. kDataLoss: as above, or it is a directory or cannot be read.
Result<Calibration> CalibrationFromFile(const std::filesystem::path& path);

}  // namespace pendulum
