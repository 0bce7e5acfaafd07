// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/recording/arc.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// The measured quantity: the angle θ plus a constant [rad], the rate θ' plus a constant [rad/s], an acceleration of a
/// point of the pendulum [m/s^2], or one coordinate of such a point [m or px].
enum class Quantity { kAngle, kRate, kAcceleration, kPosition };

inline constexpr int kMinimumSamples = 8;

/// Begin and end of an averaging window, relative to the time stamp of its row [s].
struct AveragingWindow {
  double from = 0;
  double to = 0;

  double length() const { return to - from; }
  double middle() const { return 0.5 * (from + to); }
};

inline constexpr int kMostOversampling = 64;          ///< Readings in a mean.
inline constexpr double kLongestAveragingWindow = 1;  ///< s; both ends lie within this of the time stamp.

/// How each row is the mean of several readings of a converter, which shows whole counts.
struct Oversampling {
  int readings = 1;  ///< n, at equal intervals over the window; 1: rows are no means.
  std::optional<AveragingWindow> window = std::nullopt;  ///< std::nullopt: unknown.
  /// Spacing of the levels of one reading, in the unit of Recording::value, whose resolution is this / n. 0: unknown,
  /// or the rows do not lie on such a grid.
  double count = 0;
  double level = 0;             ///< One of the levels, same unit.
  bool is_level_known = false;  ///< If false, `level` is one of the n levels of the means that come into question.
};

/// The readings of a sensor. Invariant (MakeRecording): N >= kMinimumSamples, finite, time strictly increasing.
struct Recording {
  /// The source, as the user named it; SHA-256 of the bytes read, lower-case hexadecimal. Either may be empty.
  std::string path, sha256;
  Quantity quantity = Quantity::kAngle;
  std::string unit = "rad";      ///< Of the file's value column: rad, deg, rad/s, deg/s, counts, volts, m/s^2, m or px.
  bool is_unit_assumed = false;  ///< The file does not give the unit; it was guessed from the values.
  Eigen::VectorXd time;          ///< N x 1, s, on the file's own clock.
  Eigen::VectorXd value;         ///< N x 1, rad or rad/s regardless of `unit`; in `unit` if not is_calibrated().
  double resolution = 0;         ///< Spacing of the values the sensor can give, in the unit of value; 0 if unknown or
                                 ///< continuous.
  std::string resolution_source;  ///< Its origin: "given" by the user, from the "file", or "found" in the values.
  /// For events (ConvertToEdges): one of the edges between counts, in the unit of value. A reading at a whole number of
  /// resolutions from this edge is an edge that was crossed at the reading's time. A reading halfway between two edges
  /// means that the value lies between them.
  std::optional<double> edge;
  std::optional<SensorRange> range;  ///< The sensor's range, in the unit of value; std::nullopt if unlimited.
  double clock_scale = 1, clock_scale_std_dev = 0;  ///< True seconds per second of `time`, which is uncorrected.
  std::optional<Calibration> calibration;           ///< The calibration that converted counts or volts to `value`.
  std::optional<Arc> arc;     ///< The circle about which coordinates, in `unit`, were converted to angles.
  bool shows_gravity = true;  ///< For an acceleration: false if it is 0 at rest, because g was removed.
  std::string rig_json;       ///< The rig described in the file itself, as JSON; empty if none.
  TimeSource time_source = TimeSource::kUnknown;
  std::optional<SensorStatement> stated_sensor;  ///< What the file itself states about the sensor (`# sensor`).
  /// What the sensor may do to the readings. The kind is empty and all sizes are 0 until SensorErrorsOf decides.
  SensorErrors sensor_errors;
  std::vector<Warning> warnings;
  Oversampling oversampling;  ///< Of each row.

  /// False if `value` is not in the unit of an angle or a rate: counts or volts without a calibration, an acceleration,
  /// a coordinate.
  bool is_calibrated() const {
    const bool is_si = unit == "rad" || unit == "deg" || unit == "rad/s" || unit == "deg/s";
    return is_si || calibration.has_value() || arc.has_value();
  }

  /// The unit of `value`: rad, rad/s, or `unit`.
  std::string value_unit() const { return !is_calibrated() ? unit : quantity == Quantity::kAngle ? "rad" : "rad/s"; }

  Eigen::Index size() const { return time.size(); }
};

/// Checks the invariant. kFailedPrecondition: too few samples. kDataLoss: lengths differ, a number is not finite, time
/// does not increase, or the resolution is negative. The message names the path and the sample (0-based).
Result<Recording> MakeRecording(Recording recording);

}  // namespace pendulum
