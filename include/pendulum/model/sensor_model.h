// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "pendulum/model/parameter.h"

namespace pendulum {

/// How a reading follows from the motion (MODEL.md section 14).
enum class SensorKind {
  kDirect,        ///< The angle, or the rate, plus a constant.
  kScaledRate,    ///< The rate times a constant, plus another: a gyro in volts or counts.
  kAcceleration,  ///< What an accelerometer at a radius shows along one axis.
  kCoordinate,    ///< One coordinate of a point at a radius, across the direction in which it hangs.
  kArc,           ///< The angle under which a point is seen from near the pivot: both its coordinates.
};

/// Between a motion and its readings. All constants are known; what is not is among the S = size() parameters.
struct SensorModel {
  static constexpr int kMostParameters = 4;
  static constexpr int kStates = 3;  ///< Angle, rate, acceleration of the angle.

  SensorKind kind = SensorKind::kDirect;
  double gravity = 0;               ///< m/s^2, as far as an accelerometer shows it; 0: taken out of its readings.
  double pivot_x = 0, pivot_y = 0;  ///< kArc: the point the angles were taken about, in the unit of the coordinates.
  double down = 1;                  ///< kArc: the sign of y's direction downwards, 1 or -1.

  /// A reading and its derivatives by angle, rate and acceleration, and by the sensor's parameters (S).
  struct Response {
    double reading = 0;
    std::array<double, kStates> by_state{};
    std::array<double, kMostParameters> by_parameter{};
  };

  /// Of an angle [rad] with its derivatives [rad/s, rad/s^2] seen by a sensor of these parameters (S); not of kDirect.
  Response At(const std::array<double, kStates>& state, const double* parameters) const;

  int size() const;

  /// Of kDirect none: its zero is zero_angle or rate_bias.
  std::vector<ParameterInfo> Parameters() const;
};

/// Whether a parameter is one of a sensor, its zero apart.
bool IsSensorParameter(std::string_view name);

}  // namespace pendulum
