// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/fitting/start/start_values.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

// Tolerances of an accelerometer and of a camera as built and mounted, before calibration (MODEL.md section 14). Each
// is a standard deviation about the nominal value: 0 for bias and level, 1 for the scale, the intended axis for the
// axis.
inline constexpr double kAccelerometerBiasStdDev = 0.3;    ///< m/s^2
inline constexpr double kAccelerometerScaleStdDev = 0.02;  ///< Relative.
inline constexpr double kAccelerometerAxisStdDev = 0.05;   ///< rad
inline constexpr double kCameraLevelStdDev = 0.02;         ///< rad

/// The sensor that made a recording. If gravity is linear, every measured quantity follows the same equation. A
/// coordinate, an acceleration across the rod and a gyro's volts are then fitted directly, in their own unit.
SensorModel SensorOf(const Recording& recording, Gravity gravity);

/// Prior knowledge of a sensor before the fit: bias, scale and axis of an accelerometer as built and mounted, the
/// camera's level, the circle of an arc (MODEL.md section 14). Parameters that the options fix, or for which they give
/// a prior, are left out.
ParameterPriors SensorPriors(const Recording& recording, const SensorModel& sensor, const FitOptions& options);

/// Checks that the sensor responds to the motion with the scale and radius that the options give as initial value,
/// fixed value or prior. kInvalidArgument: a value of 0 would show no motion; the message names the parameter.
Result<void> CheckSensorOptions(const SensorModel& sensor, const FitOptions& options);

/// One interpretation of the readings as an angle or a rate.
struct SensorStart {
  std::vector<double> parameters;  ///< S
  Recording view;                  ///< The readings converted with these parameters: rad or rad/s.
};

/// The motion that a view of the readings shows (TurningPointView), in the unit of the view.
struct Oscillation {
  double zero = 0;
  double amplitude = 0;  ///< The largest one.
  double frequency = 0;  ///< rad/s, as if the swings of the recording were small.
};

/// Start points of the search for a sensor that is not direct. If the scale is unknown, there is one for each amplitude
/// that the readings may represent. kFailedPrecondition: as FindTurningPoints and NaturalFrequency.
Result<std::vector<SensorStart>> SensorStarts(const Recording& recording, const SensorModel& sensor,
                                              const FitOptions& options);

/// The same start points if the oscillation is known from elsewhere, because the turning points cannot be seen.
std::vector<SensorStart> SensorStarts(const Recording& recording, const SensorModel& sensor, const FitOptions& options,
                                      const Oscillation& oscillation);

/// Replaces the zero at the end of start values, which were estimated from start.view, by the sensor's parameters.
void AppendSensorParameters(const SensorModel& sensor, const SensorStart& start, StartValues& values);

}  // namespace pendulum
