// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/recording/recording.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// The kind of sensor that the unit and the values of a recording suggest: events, or the steps of an encoder: encoder;
/// counts or volts: potentiometer, of a rate: gyro; a rate: gyro; an acceleration: accelerometer; coordinates: camera;
/// otherwise angle sensor.
std::string SensorKindOf(const Recording& recording);

/// The plausible sizes of the sensor's effects on the readings of a swing, from `from` to `to` on the file's clock [s].
/// In this order, the later replacing the earlier: the defaults for the kind of sensor (MODEL.md section 14) and for
/// the source of the times; a calibration with a covariance, whose own error counts instead of the gain, and whose
/// residual limits the nonlinearity; a stated clock, whose own error counts; what `given` states or, without it, what
/// the file states. Sizes in an angle or a rate are 0 for readings in counts or volts.
SensorErrors SensorErrorsOf(const Recording& recording, double from, double to,
                            const std::optional<SensorStatement>& given);

}  // namespace pendulum
