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

/// From a time [s] on a sensor's readings stand so many resolutions higher: an incremental encoder missed edges.
struct LostCounts {
  double time = 0;
  int counts = 0;
};

/// When a recording has a row.
enum class RowTiming {
  kEven,          ///< At even times.
  kEvents,        ///< When the count of an encoder changes, and at the start.
  kEvenOfEvents,  ///< At even times, of the same encoder with the same errors of its edges.
};

/// Of rows of events: an edge does not stray as far as the next one, and a row stands for each count.
inline constexpr double kMostEventNoise = 0.2;  ///< Standard deviation of an edge, in counts.
inline constexpr double kFinestEvents = 1e-5;   ///< Resolution, rad.

/// A recording to be made, and with it the truth a fit of that recording should find.
struct SyntheticOptions {
  MotionModel model = {"coulomb", "coulomb", Gravity::kSine};
  /// Of PhysicalParameters(model), in units of G: inertia / G [s^2], viscous / G [s], ...
  std::vector<double> parameters;

  StartKind start = StartKind::kRelease;
  /// Of kRelease: θ before the release [rad]; when, on the recording's clock before its last sample [s].
  double release_angle = 0, release_time = 0;
  double initial_angle = 0, initial_rate = 0;  ///< θ [rad] and θ' [rad/s] at the first sample; kMoving.

  double start_time = 0;                    ///< Clock at the first sample [s].
  double duration = 20, sample_rate = 100;  ///< s, Hz; the recording has round(duration * sample_rate) samples.
  double jitter = 0;  ///< Standard deviation of a sampling instant about start_time + i / sample_rate [s].

  Quantity quantity = Quantity::kAngle;
  SensorModel sensor;                     ///< Between the motion and the reading.
  std::vector<double> sensor_parameters;  ///< S, of a sensor that is not direct; `zero` is then not used.
  double zero = 0;                        ///< zero_angle [rad] or rate_bias [rad/s]: added to θ or θ'.
  double noise = 0;                       ///< Standard deviation of the noise [rad or rad/s], before quantization.
  double noise_correlation = 0;           ///< AR(1): of each sample's noise with that of the sample before, in (-1, 1).
  double noise_freedom = 0;  ///< Degrees of freedom ν of Student's t noise, whose *scale* is `noise`; 0 is Gaussian.
  double resolution = 0;     ///< Spacing q of the levels the sensor can show [rad or rad/s]; 0 is none.
  std::optional<SensorRange> range;     ///< rad or rad/s; none is unlimited.
  std::vector<LostCounts> lost_counts;  ///< Of a sensor with levels; range is that of the levels before.
  RowTiming rows = RowTiming::kEven;    ///< Of events `noise` is the error of each crossing of an edge.
  double edge_lag = 0;                  ///< Of events: how far behind its edge the count changes [rad].
  double time_noise = 0;                ///< Standard deviation of the error of an event's stamp [s].

  std::uint64_t seed = 1;  ///< Of noise and jitter.
};

/// Parameters the recording is made with, in the order of a fit: of the model (units of G), of the start, of the
/// sensor, and edge_lag of events.
std::vector<double> TrueParameters(const SyntheticOptions& options);

/// What the sensor shows of a value x: y = q round(x / q), with a range y = low + q round((x - low) / q) within the
/// levels of [low, high], as an ADC seen through a linear calibration. Without a resolution x clipped to the range.
double SensorReading(double x, double resolution, const std::optional<SensorRange>& range);

/// Simulates the recording of a free swing, within 1e-12 rad over 46 periods up to 120 deg (1e-10 rad at 177 deg). A
/// jittered sample is taken at the instant its stamp says; stamps increase, the first is start_time. A seed gives the
/// same everywhere, and the same noise whatever the jitter, and whether events are sampled evenly; the noise is
/// stationary, of standard deviation `noise` or, for Student's t with ν > 2, noise · sqrt(ν / (ν - 2)).
/// kInvalidArgument: an option outside its domain, which the message names. kFailedPrecondition: friction holds the
/// pendulum, the release comes after the last sample, too few samples, or the motion cannot be traced.
Result<Recording> SimulateRecording(const SyntheticOptions& options);

/// Both coordinates of a point, N samples each, as a sensor of kind kArc sees it before the angles are made of them.
struct TrackedPoint {
  Eigen::VectorXd time, x, y;
};

/// The point of which SimulateRecording makes angles about the circle it moves on. Errors as SimulateRecording.
Result<TrackedPoint> SimulatePoint(const SyntheticOptions& options);

}  // namespace pendulum
