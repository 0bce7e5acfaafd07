// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// Lost counts of an incremental encoder that missed edges: from `time` [s] on, readings are `counts` resolutions
/// higher.
struct LostCounts {
  double time = 0;
  int counts = 0;
};

/// Which instants have a row in the recording.
enum class RowTiming {
  kEven,             ///< At equal intervals.
  kEvents,           ///< At the start and whenever the count of an encoder changes.
  kEvenFromEncoder,  ///< Equally spaced readings of the encoder of kEvents, with the same edge errors.
};

/// Limits for event rows. Scattered edges must not pass each other. Each count produces a row, so the resolution is
/// limited.
inline constexpr double kMaxEventNoise = 0.2;  ///< Standard deviation of an edge, in counts.
inline constexpr double kFinestEvents = 1e-5;  ///< Resolution, rad.

/// Options for a simulated recording. They contain the true values that a fit of the recording should find.
struct SyntheticOptions {
  MotionModel model = {"coulomb", "coulomb", Gravity::kSine};
  /// The values of PhysicalParameters(model) over the restoring torque G, such as inertia / G [s^2], viscous / G [s].
  std::vector<double> parameters;

  StartKind start = StartKind::kRelease;
  /// For kRelease: θ before the release [rad], and the release time [s] on the recording's clock, before its last
  /// sample.
  double release_angle = 0, release_time = 0;
  double initial_angle = 0, initial_rate = 0;  ///< For kMoving: θ [rad] and θ' [rad/s] at the first sample.

  double start_time = 0;                    ///< Time stamp of the first sample [s].
  double duration = 20, sample_rate = 100;  ///< s, Hz; the recording has round(duration * sample_rate) samples.
  double jitter = 0;  ///< Standard deviation of a sampling instant from start_time + i / sample_rate [s].

  Quantity quantity = Quantity::kAngle;
  SensorModel sensor;                     ///< Computes readings from the motion.
  std::vector<double> sensor_parameters;  ///< S values, for a sensor that is not direct; `zero` is then unused.
  double zero = 0;                        ///< zero_angle [rad] or rate_bias [rad/s]: added to θ or θ'.
  double noise = 0;                       ///< Standard deviation of the noise [rad or rad/s], before quantization.
  double noise_correlation = 0;           ///< AR(1): correlation of successive samples' noise, in (-1, 1).
  double noise_freedom = 0;  ///< Degrees of freedom ν of Student's t noise, whose *scale* is `noise`; 0 is Gaussian.
  double resolution = 0;     ///< Spacing q of the levels that the sensor can show [rad or rad/s]; 0 means continuous
                             ///< readings.
  std::optional<SensorRange> range;  ///< rad or rad/s; std::nullopt means unlimited.
  /// Each sample is the mean of this many readings, each with its own noise and then rounded, at equal intervals within
  /// the averaging window about the sampling instant. Then `noise` is that of one reading.
  int oversample = 1;
  double averaging_window = 0;  ///< Length of the window [s], less than the sampling interval; 0: at one instant.
  std::vector<LostCounts> lost_counts;  ///< Only for a sensor with levels; `range` applies before counts are lost.
  RowTiming rows = RowTiming::kEven;    ///< With events, `noise` is the error of each crossing of an edge.
  double hysteresis = 0;                ///< For events: how far behind its edge the count changes [rad].
  double time_noise = 0;                ///< Standard deviation of the error of an event's time stamp [s].

  std::uint64_t seed = 1;  ///< Determines noise and jitter.
};

/// The true parameters of the recording in the order of a fit: those of the model (units of the restoring torque G), of
/// the start and of the sensor, and the hysteresis for events.
std::vector<double> TrueParameters(const SyntheticOptions& options);

/// The reading of the sensor for a value x: y = q round(x / q). With a range y = low + q round((x - low) / q), limited
/// to the levels in [low, high], like an ADC with a linear calibration. Without a resolution x is clipped to the range.
double SensorReading(double x, double resolution, const std::optional<SensorRange>& range);

/// Simulates the recording of a free swing. The error is below 1e-12 rad over 46 periods up to 120 deg (1e-10 rad at
/// 177 deg). With jitter each sample is taken exactly at its time stamp. Time stamps increase; the first is start_time.
/// A seed gives the same result on every platform. The noise does not depend on the jitter, nor on whether events are
/// sampled evenly. It is stationary with standard deviation `noise` or, for Student's t with ν > 2,
/// noise · sqrt(ν / (ν - 2)). kInvalidArgument: an option is outside its domain; the message names it.
/// kFailedPrecondition: friction holds the pendulum, the release comes after the last sample, there are too few
/// samples, or the motion cannot be traced.
Result<Recording> SimulateRecording(const SyntheticOptions& options);

/// Both coordinates of a point, N samples each, from which the angles of a sensor of kind kArc are computed.
struct TrackedPoint {
  Eigen::VectorXd time, x, y;
};

/// The point from which SimulateRecording computes the angles about its circle. Errors as for SimulateRecording.
Result<TrackedPoint> SimulatePoint(const SyntheticOptions& options);

}  // namespace pendulum
