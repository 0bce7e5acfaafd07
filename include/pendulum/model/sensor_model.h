// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "pendulum/model/parameter.h"

namespace pendulum {

/// How a reading depends on the motion (MODEL.md section 14).
enum class SensorKind {
  kDirect,        ///< The angle, or the rate, plus a constant.
  kScaledRate,    ///< The rate times a constant, plus another constant: a gyro in volts or counts.
  kAcceleration,  ///< The reading of an accelerometer at a radius along one axis.
  kCoordinate,    ///< One coordinate of a point at a radius, perpendicular to the rod at rest.
  kArc,           ///< The angle of a point seen from near the pivot; both its coordinates are needed.
};

/// Computes readings from a motion. The members are known constants; the S = size() parameters are not known.
struct SensorModel {
  static constexpr int kMaxParameters = 4;
  static constexpr int kStates = 3;  ///< Angle, rate and angular acceleration.

  SensorKind kind = SensorKind::kDirect;
  double gravity = 0;               ///< m/s^2, as the accelerometer's readings contain it; 0 if it was removed.
  double pivot_x = 0, pivot_y = 0;  ///< kArc: the reference point of the angles, in the coordinates' unit.
  double down = 1;                  ///< kArc: the sign of the y coordinate downwards, 1 or -1.

  /// A reading and its derivatives with respect to angle, rate, acceleration and the S sensor parameters.
  struct Response {
    double reading = 0;
    std::array<double, kStates> by_state{};
    std::array<double, kMaxParameters> by_parameter{};
  };

  /// The reading for an angle [rad] and its derivatives [rad/s, rad/s^2]; `parameters` has S values. Not for kDirect.
  Response At(const std::array<double, kStates>& state, const double* parameters) const;

  int size() const;

  /// The parameters of the sensor. kDirect has none here: its zero is the parameter zero_angle or rate_bias.
  std::vector<ParameterInfo> Parameters() const;
};

/// Whether the name belongs to a sensor parameter other than the zero.
bool IsSensorParameter(std::string_view name);

}  // namespace pendulum
