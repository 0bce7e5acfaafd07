// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace pendulum {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Values by parameter name.
using ParameterValues = std::map<std::string, double, std::less<>>;

struct ParameterRange {
  double lower = -kUnbounded;
  double upper = kUnbounded;
};

/// Prior knowledge of a parameter, independent of the recording.
struct ParameterPrior {
  double mean = 0;
  double std_dev = 0;  ///< Positive.
};

/// Indices of two parameters of a friction law. The first is never below the second.
struct OrderedPair {
  int larger = -1, smaller = -1;
};

using ParameterRanges = std::map<std::string, ParameterRange, std::less<>>;
using ParameterPriors = std::map<std::string, ParameterPrior, std::less<>>;

/// All facts about a parameter in one place. Flags, bounds, tables, JSON and documentation are derived from it.
/// Internally torques are in units of the gravity torque G (G = 1); only the report converts them. A torque or an
/// inertia therefore has two units: `unit` if a rig gives G, and `relative_unit`, the unit of parameter / G, if not.
struct ParameterInfo {
  std::string_view name;           ///< As in --fix, --set and JSON.
  std::string_view symbol;         ///< As in MODEL.md.
  std::string_view unit;           ///< SI.
  std::string_view relative_unit;  ///< SI, of parameter / G; equal to `unit` for a parameter that is not scaled by G.
  double lower, upper;             ///< The smallest and the largest admissible value.
  std::string_view description;
  std::string_view words = {};  ///< What a page calls it; empty: its name.

  /// True if the value in SI units is G times the value in units of the restoring torque G.
  constexpr bool scales_with_gravity() const { return unit != relative_unit; }
};

inline constexpr ParameterInfo kInertia{
    "inertia", "I_O", "kg m^2", "s^2", 0.0, kUnbounded, "moment of inertia about the pivot", "moment of inertia"};
inline constexpr ParameterInfo kReleaseAngle{"release_angle",
                                             "θ_r",
                                             "rad",
                                             "rad",
                                             -kUnbounded,
                                             kUnbounded,
                                             "angle at which the pendulum is held before the release",
                                             "release angle"};
inline constexpr ParameterInfo kReleaseTime{
    "release_time", "t_r", "s", "s", -kUnbounded, kUnbounded, "time of the release on the file's clock",
    "release time"};
inline constexpr ParameterInfo kInitialAngle{
    "initial_angle", "θ_0", "rad", "rad", -kUnbounded, kUnbounded, "angle at the first used sample", "initial angle"};
inline constexpr ParameterInfo kInitialRate{
    "initial_rate", "ω_0", "rad/s", "rad/s", -kUnbounded, kUnbounded, "rate at the first used sample", "initial rate"};
inline constexpr ParameterInfo kZeroAngle{
    "zero_angle",        "z", "rad", "rad", -kUnbounded, kUnbounded, "reading at which gravity's torque vanishes",
    "zero of the sensor"};
inline constexpr ParameterInfo kRateBias{
    "rate_bias", "z", "rad/s", "rad/s", -kUnbounded, kUnbounded, "reading of the gyro at rest", "bias of the sensor"};
inline constexpr ParameterInfo kRateScale{
    "rate_scale",       "k", "rad s/rad", "rad s/rad", -kUnbounded, kUnbounded, "reading of the gyro per unit of rate",
    "scale of the gyro"};
inline constexpr ParameterInfo kAccelerationBias{"acceleration_bias",
                                                 "c",
                                                 "m/s^2",
                                                 "m/s^2",
                                                 -kUnbounded,
                                                 kUnbounded,
                                                 "reading of the accelerometer in free fall",
                                                 "bias of the accelerometer"};
inline constexpr ParameterInfo kAccelerationScale{"acceleration_scale",
                                                  "k",
                                                  "1",
                                                  "1",
                                                  0.0,
                                                  kUnbounded,
                                                  "reading of the accelerometer per unit of acceleration",
                                                  "scale of the accelerometer"};
inline constexpr ParameterInfo kAxis{"axis",
                                     "ψ",
                                     "rad",
                                     "rad",
                                     -kUnbounded,
                                     kUnbounded,
                                     "direction the accelerometer measures: 0 along the motion, π/2 towards the pivot",
                                     "axis of the accelerometer"};
inline constexpr ParameterInfo kRadius{"radius",
                                       "r",
                                       "m",
                                       "m",
                                       0.0,
                                       kUnbounded,
                                       "distance of the accelerometer, or the tracked point, from the pivot",
                                       "distance from the pivot"};
inline constexpr ParameterInfo kPivotX{
    "pivot_x", "x_P", "m", "m", -kUnbounded, kUnbounded, "horizontal coordinate of the pivot", "pivot, horizontally"};
inline constexpr ParameterInfo kPivotY{
    "pivot_y", "y_P", "m", "m", -kUnbounded, kUnbounded, "vertical coordinate of the pivot", "pivot, vertically"};
inline constexpr ParameterInfo kZeroDrift{"zero_drift",
                                          "z'",
                                          "rad/s",
                                          "rad/s",
                                          -kUnbounded,
                                          kUnbounded,
                                          "rate of change of zero_angle, whose value is that at the first used sample",
                                          "drift of the zero"};
inline constexpr ParameterInfo kBiasDrift{"bias_drift",
                                          "z'",
                                          "rad/s^2",
                                          "rad/s^2",
                                          -kUnbounded,
                                          kUnbounded,
                                          "rate of change of rate_bias, whose value is that at the first used sample",
                                          "drift of the bias"};
inline constexpr ParameterInfo kHysteresis{"hysteresis",
                                           "h",
                                           "rad",
                                           "rad",
                                           -kUnbounded,
                                           kUnbounded,
                                           "angle past an edge at which an encoder changes its count",
                                           "hysteresis of the encoder"};

/// The parameters of how a recording begins, and of the sensor. All others are of the pendulum.
inline constexpr std::array kParametersOfRecordings = {
    kReleaseAngle, kReleaseTime,      kInitialAngle,      kInitialRate, kZeroAngle, kRateBias, kZeroDrift, kBiasDrift,
    kRateScale,    kAccelerationBias, kAccelerationScale, kAxis,        kRadius,    kPivotX,   kPivotY,    kHysteresis};

/// Names of parameters before schema version 2, each with its present name. Input may still use the former names.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 1> kFormerNames = {
    {{"edge_lag", kHysteresis.name}}};

/// The present name of a parameter that is given by its present or a former name.
constexpr std::string_view CurrentName(std::string_view name) {
  for (const auto& [former, current] : kFormerNames) {
    if (name == former) return current;
  }
  return name;
}

}  // namespace pendulum
