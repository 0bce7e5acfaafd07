// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

// What an accelerometer and a camera are like as built and mounted, before anybody has calibrated them (MODEL.md
// section 14): standard deviations about 0, 1, the axis it was meant to have, and 0.
inline constexpr double kAccelerometerBiasStdDev = 0.3;    ///< m/s^2
inline constexpr double kAccelerometerScaleStdDev = 0.02;  ///< Of 1.
inline constexpr double kAccelerometerAxisStdDev = 0.05;   ///< rad
inline constexpr double kCameraLevelStdDev = 0.02;         ///< rad

/// The sensor that a recording was made with. Where gravity is linear everything that is measured follows the same
/// equation, so that a coordinate, an acceleration across the rod and a gyro's volts are angles in an unknown unit.
SensorModel SensorOf(const Recording& recording, Gravity gravity);

/// What is known of a sensor before the fit, unless the options hold a parameter or know it themselves (MODEL.md
/// section 14): bias, scale and axis of an accelerometer as built and mounted, the camera's level, the circle of an
/// arc.
ParameterPriors SensorPriors(const Recording& recording, const SensorModel& sensor, const FitOptions& options);

/// Whether a sensor shows anything where the options begin, fix or expect its scale and its radius. kInvalidArgument:
/// with 0 it would not, and the message names which.
Result<void> CheckSensorOptions(const SensorModel& sensor, const FitOptions& options);

/// One way to see the readings as an angle or a rate.
struct SensorStart {
  std::vector<double> parameters;  ///< S
  Recording view;                  ///< The readings through them: rad or rad/s.
};

/// Where the search may begin: one way for each amplitude that the readings may stand for where nobody knows the scale.
/// Not of a direct sensor. kFailedPrecondition: as TabulateHalfSwings.
Result<std::vector<SensorStart>> SensorStarts(const Recording& recording, const SensorModel& sensor,
                                              const FitOptions& options);

}  // namespace pendulum
