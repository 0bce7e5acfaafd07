// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/recording/arc.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// What the sensor measures: the angle θ plus a constant [rad], the rate θ' plus a constant [rad/s], an acceleration of
/// a point of the pendulum [m/s^2], or one coordinate of such a point [m or px].
enum class Quantity { kAngle, kRate, kAcceleration, kPosition };

inline constexpr int kMinimumSamples = 8;

/// A recording as the sensor saw it. Invariant (MakeRecording): N >= kMinimumSamples, finite, time strictly increasing.
struct Recording {
  /// Where it came from, as the user named it; SHA-256 of the bytes read, lower-case hexadecimal; either may be empty.
  std::string path, sha256;
  Quantity quantity = Quantity::kAngle;
  std::string unit = "rad";  ///< Of the file's value column: rad, deg, rad/s, deg/s, counts, volts, m/s^2, m or px.
  Eigen::VectorXd time;      ///< N x 1, s, on the file's own clock.
  Eigen::VectorXd value;     ///< N x 1, rad or rad/s whatever the unit; in `unit` unless is_calibrated().
  double resolution = 0;  ///< Spacing of the values the sensor can give, in the unit of value; 0 when unknown or none.
  std::string resolution_source;  ///< Who says so: "given" by the user, the "file", or "found" in the values.
  /// Of events (TakeEdges): one of the edges between counts, in the unit of value. A reading whole resolutions from it
  /// is the edge that was crossed at its time; one halfway between two says only that the value lies between them.
  std::optional<double> edge;
  std::optional<SensorRange> range;  ///< What the sensor can show, in the unit of value; none when unlimited.
  double clock_scale = 1, clock_scale_std_dev = 0;  ///< True seconds in one of the file's clock; not applied to `time`.
  std::optional<Calibration> calibration;           ///< What turned counts or volts into `value`.
  std::optional<Arc> arc;     ///< The circle that turned both coordinates of a point, in `unit`, into angles about it.
  bool shows_gravity = true;  ///< Of an acceleration: at rest it shows g, as an accelerometer does; false: taken out.
  std::string rig_json;       ///< The rig that the file itself describes, as JSON; empty for none.
  std::vector<Warning> warnings;

  /// False when `value` is in another unit than an angle's or a rate's: counts or volts without a calibration, an
  /// acceleration, a coordinate.
  bool is_calibrated() const {
    const bool is_si = unit == "rad" || unit == "deg" || unit == "rad/s" || unit == "deg/s";
    return is_si || calibration.has_value() || arc.has_value();
  }

  /// The unit of `value`: rad, rad/s, or `unit`.
  std::string value_unit() const { return !is_calibrated() ? unit : quantity == Quantity::kAngle ? "rad" : "rad/s"; }

  Eigen::Index size() const { return time.size(); }
};

/// Checks the invariant. kFailedPrecondition: too few samples. kDataLoss: lengths differ, a number is not finite, time
/// does not increase, or the resolution is negative; the message names path and sample (0-based).
Result<Recording> MakeRecording(Recording recording);

}  // namespace pendulum
