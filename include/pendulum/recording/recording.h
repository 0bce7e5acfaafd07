// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"

namespace pendulum {

/// What the sensor measures: the angle θ plus a constant [rad], or the rate θ' plus a constant [rad/s].
enum class Quantity { kAngle, kRate };

/// The fewest samples that can be called a recording.
inline constexpr int kMinimumSamples = 8;

/// The interval a sensor can show, rad or rad/s; what lies beyond is shown as the nearest end.
struct SensorRange {
  double low;
  double high;
};

/// One recording as the sensor saw it.
///
/// Invariant, established by MakeRecording: N >= kMinimumSamples, every number finite, time strictly increasing.
struct Recording {
  std::string path;    ///< Where it came from, as the user named it; may be empty.
  std::string sha256;  ///< Of the bytes it was read from, lower-case hexadecimal; empty when it was not read.
  Quantity quantity = Quantity::kAngle;
  std::string unit = "rad";  ///< Of the file's value column: rad, deg, rad/s or deg/s. `value` is SI all the same.
  Eigen::VectorXd time;      ///< N x 1, s, on the file's own clock.
  Eigen::VectorXd value;     ///< N x 1, rad or rad/s.
  double resolution = 0;     ///< Spacing of the values the sensor can give, rad or rad/s; 0 when unknown or none.
  std::optional<SensorRange> range;  ///< What the sensor can show, rad or rad/s; none when unknown or unlimited.
  std::vector<Warning> warnings;     ///< What was repaired or noticed while reading.

  Eigen::Index size() const { return time.size(); }
};

/// Checks the invariant of Recording.
///
/// kFailedPrecondition: fewer than kMinimumSamples samples. kDataLoss: lengths differ, a number is not finite, time
/// does not increase, or the resolution is negative; the message begins with the path if there is one, and names the
/// first offending sample (0-based).
Result<Recording> MakeRecording(Recording recording);

}  // namespace pendulum
