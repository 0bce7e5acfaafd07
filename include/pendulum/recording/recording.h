// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// What the sensor measures: the angle θ plus a constant [rad], or the rate θ' plus a constant [rad/s].
enum class Quantity { kAngle, kRate };

inline constexpr int kMinimumSamples = 8;

/// One recording as the sensor saw it. Invariant (MakeRecording): N >= kMinimumSamples, finite, time strictly
/// increasing.
struct Recording {
  std::string path;    ///< Where it came from, as the user named it; may be empty.
  std::string sha256;  ///< Of the bytes it was read from, lower-case hexadecimal; empty when it was not read.
  Quantity quantity = Quantity::kAngle;
  std::string unit = "rad";  ///< Of the file's value column: rad, deg, rad/s, deg/s, counts or volts.
  Eigen::VectorXd time;      ///< N x 1, s, on the file's own clock.
  Eigen::VectorXd value;     ///< N x 1, rad or rad/s whatever the unit; counts or volts unless is_calibrated().
  double resolution = 0;  ///< Spacing of the values the sensor can give, in the unit of value; 0 when unknown or none.
  std::string resolution_source;     ///< Who says so: "given" by the user, the "file", or "found" in the values.
  std::optional<SensorRange> range;  ///< What the sensor can show, in the unit of value; none when unlimited.
  double clock_scale = 1, clock_scale_std_dev = 0;  ///< True seconds in one of the file's clock; not applied to `time`.
  std::optional<Calibration> calibration;           ///< What turned counts or volts into `value`.
  std::string rig_json;           ///< The rig that the file itself describes, as JSON; empty for none.
  std::vector<Warning> warnings;  ///< What was repaired or noticed while reading.

  /// False when `value` is in counts or volts for want of a calibration: an angle in an unknown unit.
  bool is_calibrated() const { return calibration.has_value() || (unit != "counts" && unit != "volts"); }

  /// The unit of `value`: rad, rad/s, counts or volts.
  std::string value_unit() const { return !is_calibrated() ? unit : quantity == Quantity::kAngle ? "rad" : "rad/s"; }

  Eigen::Index size() const { return time.size(); }
};

/// Checks the invariant of Recording.
/// kFailedPrecondition: fewer than kMinimumSamples samples. kDataLoss: lengths differ, a number is not finite, time
/// does not increase, or the resolution is negative; the message begins with the path, if any, and names the sample
/// (0-based).
Result<Recording> MakeRecording(Recording recording);

}  // namespace pendulum
