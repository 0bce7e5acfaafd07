// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/sensor_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

/// Assumed largest amplitudes [rad] for readings in an unknown unit.
constexpr std::array kAmplitudes = {0.15, 0.4, 0.8, 1.3};

/// Larger angles in a view are clipped to this [rad].
constexpr double kLargestView = 1.5;

/// The value that the options give for a parameter: fixed, initial, or the mean of a prior.
std::optional<double> KnownValue(const FitOptions& options, const ParameterInfo& info) {
  if (const auto found = options.fixed.find(info.name); found != options.fixed.end()) return found->second;
  if (const auto found = options.initial.find(info.name); found != options.initial.end()) return found->second;
  if (const auto found = options.priors.find(info.name); found != options.priors.end()) return found->second.mean;
  return std::nullopt;
}

/// Nominal direction of an accelerometer's axis: across the rod, or along it.
double AxisOf(const Recording& recording) { return IsAlongRod(recording) ? 0.5 * kPi * RadialSide(recording) : 0.0; }

/// The readings' view and its oscillation.
struct Turns : Oscillation {
  Recording view;

  /// ω0, if the largest amplitude is `angle`.
  double NaturalFrequency(double angle) const { return frequency * SineGravity::PeriodRatio(angle); }
};

Result<Turns> FindTurnsOf(const Recording& recording) {
  Recording view = TurningPointView(recording);
  ASSIGN_OR_RETURN(const TurningPointTable table, FindTurningPoints(view));
  ASSIGN_OR_RETURN(const double frequency, NaturalFrequency(view, table, Gravity::kLinear));
  return Turns{{table.zero.value, table.LargestAmplitude(), frequency}, std::move(view)};
}

/// The amplitudes to try; only `known` if the scale is known.
std::vector<double> AmplitudesOf(std::optional<double> known) {
  if (known) return {std::clamp(*known, 0.01, kLargestView)};
  return {kAmplitudes.begin(), kAmplitudes.end()};
}

/// Interprets (reading - zero) / unit as the sine of an angle.
Recording AsSine(Recording view, double zero, double unit) {
  const double most = std::sin(kLargestView);
  for (double& value : view.value) value = std::asin(std::clamp((value - zero) / unit, -most, most));
  view.unit = "rad";
  view.quantity = Quantity::kAngle;
  view.resolution /= std::abs(unit);
  return view;
}

std::vector<SensorStart> StartsOfCoordinate(const Turns& turns, const FitOptions& options) {
  const std::optional<double> radius = KnownValue(options, kRadius);
  std::optional<double> amplitude;
  if (radius) amplitude = std::asin(std::min(turns.amplitude / *radius, std::sin(kLargestView)));
  std::vector<SensorStart> starts;
  for (const double angle : AmplitudesOf(amplitude)) {
    const double length = radius.value_or(turns.amplitude / std::sin(angle));
    const double pivot = KnownValue(options, kPivotX).value_or(turns.zero);
    const double zero = KnownValue(options, kZeroAngle).value_or(0);
    starts.push_back({{zero, pivot, length}, AsSine(turns.view, turns.zero, length)});
  }
  return starts;
}

std::vector<SensorStart> StartsOfRate(const Recording& recording, const Turns& turns, const FitOptions& options) {
  const std::optional<double> known = KnownValue(options, kRateScale);
  std::vector<SensorStart> starts;
  for (const double angle : known ? std::vector{0.0} : AmplitudesOf({})) {
    const double peak = 2 * turns.NaturalFrequency(angle) * std::sin(0.5 * angle);
    const double scale = known.value_or(turns.amplitude / std::max(peak, 1e-9));
    SensorStart start{{turns.zero, scale}, recording};
    start.view.value = (recording.value.array() - turns.zero) / scale;
    start.view.resolution /= std::abs(scale);
    start.view.unit = "rad/s";
    starts.push_back(std::move(start));
  }
  return starts;
}

/// Across the rod: k ((g - r ω0²) sin θ - r friction), where friction is neglected.
std::vector<SensorStart> StartsAcross(const SensorModel& sensor, const Turns& turns, const FitOptions& options) {
  const std::optional<double> known = KnownValue(options, kRadius);
  const double scale = KnownValue(options, kAccelerationScale).value_or(1);
  const double axis = KnownValue(options, kAxis).value_or(0);
  std::vector<SensorStart> starts;
  const auto add = [&](double unit, double radius) {
    starts.push_back(
        {{turns.zero - sensor.gravity * std::sin(axis), scale, axis, radius}, AsSine(turns.view, turns.zero, unit)});
  };
  for (const double angle : AmplitudesOf({})) {
    const double square = std::pow(turns.NaturalFrequency(angle), 2);
    if (known) {
      add(scale * (sensor.gravity - *known * square), *known);
      continue;
    }
    for (const double side : {1.0, -1.0}) {
      const double unit = side * turns.amplitude / std::sin(angle);
      const double radius = (sensor.gravity - unit / scale) / square;
      if (radius > 0) add(unit, radius);
    }
  }
  if (known) starts.resize(1);
  return starts;
}

/// Along the rod, unfolded: |view| = sqrt(2 k (g + 2 r ω0²)) sin(θ/2).
std::vector<SensorStart> StartsAlong(const SensorModel& sensor, const Turns& turns, double upright,
                                     const FitOptions& options) {
  const std::optional<double> known = KnownValue(options, kRadius);
  const double scale = KnownValue(options, kAccelerationScale).value_or(1);
  const double axis = KnownValue(options, kAxis).value_or(upright);
  std::vector<SensorStart> starts;
  for (const double angle : AmplitudesOf({})) {
    const double square = std::pow(turns.NaturalFrequency(angle), 2);
    const double root = turns.amplitude / std::sin(0.5 * angle);
    const double radius = known.value_or((root * root / (2 * scale) - sensor.gravity) / (2 * square));
    if (!(radius > 0)) continue;
    const double unit = std::sqrt(2 * scale * (sensor.gravity + 2 * radius * square));
    SensorStart start{{0, scale, axis, radius}, turns.view};
    for (double& value : start.view.value) value = 2 * std::asin(std::clamp((value - turns.zero) / unit, -0.9, 0.9));
    start.view.unit = "rad";
    starts.push_back(std::move(start));
    if (known) break;
  }
  return starts;
}

std::vector<SensorStart> StartsOf(const Recording& recording, const SensorModel& sensor, const FitOptions& options,
                                  const Turns& turns) {
  if (sensor.kind == SensorKind::kCoordinate) return StartsOfCoordinate(turns, options);
  if (sensor.kind == SensorKind::kScaledRate) return StartsOfRate(recording, turns, options);
  return IsAlongRod(recording) ? StartsAlong(sensor, turns, AxisOf(recording), options)
                               : StartsAcross(sensor, turns, options);
}

SensorStart StartOfArc(const Recording& recording) {
  const Arc& arc = *recording.arc;
  return {{0, arc.x, arc.y, arc.radius}, recording};
}

}  // namespace

SensorModel SensorOf(const Recording& recording, Gravity gravity) {
  SensorModel sensor;
  if (recording.arc) {
    sensor.kind = SensorKind::kArc;
    sensor.pivot_x = recording.arc->x;
    sensor.pivot_y = recording.arc->y;
    sensor.down = recording.arc->down;
    return sensor;
  }
  if (gravity.is_linear()) return sensor;
  if (recording.quantity == Quantity::kRate && !recording.is_calibrated()) sensor.kind = SensorKind::kScaledRate;
  if (recording.quantity == Quantity::kPosition) sensor.kind = SensorKind::kCoordinate;
  if (recording.quantity == Quantity::kAcceleration) {
    sensor.kind = SensorKind::kAcceleration;
    sensor.gravity = recording.shows_gravity ? kStandardGravity : 0;
  }
  return sensor;
}

ParameterPriors SensorPriors(const Recording& recording, const SensorModel& sensor, const FitOptions& options) {
  ParameterPriors priors;
  const auto add = [&](const ParameterInfo& info, double mean, double std_dev) {
    if (!options.fixed.contains(info.name) && !options.priors.contains(info.name) && std_dev > 0)
      priors.insert_or_assign(std::string(info.name), ParameterPrior{mean, std_dev});
  };
  if (sensor.kind == SensorKind::kAcceleration) {
    add(kAccelerationBias, 0, kAccelerometerBiasStdDev);
    add(kAccelerationScale, 1, kAccelerometerScaleStdDev);
    add(kAxis, AxisOf(recording), kAccelerometerAxisStdDev);
  }
  if (sensor.kind == SensorKind::kCoordinate) add(kZeroAngle, 0, kCameraLevelStdDev);
  if (sensor.kind == SensorKind::kArc) {
    const Eigen::Vector3d std_dev = recording.arc->covariance.diagonal().cwiseSqrt();
    add(kPivotX, recording.arc->x, std_dev[0]);
    add(kPivotY, recording.arc->y, std_dev[1]);
    add(kRadius, recording.arc->radius, std_dev[2]);
  }
  return priors;
}

Result<void> CheckSensorOptions(const SensorModel& sensor, const FitOptions& options) {
  for (const ParameterInfo& info : sensor.Parameters()) {
    const bool is_size =
        info.name == kRadius.name || info.name == kRateScale.name || info.name == kAccelerationScale.name;
    const std::optional<double> value = KnownValue(options, info);
    if (!is_size || !value) continue;
    const bool shows_at_0 = info.name == kRadius.name && sensor.gravity > 0;  // gravity is measured at the pivot too
    if (*value == 0 ? shows_at_0 : *value >= info.lower) continue;
    return Error(StatusCode::kInvalidArgument, std::string(info.name) + " cannot be " + NumberText(*value) +
                                                   ", because the sensor would then show no motion; it must be " +
                                                   (shows_at_0        ? "at least 0"
                                                    : info.lower == 0 ? "greater than 0"
                                                                      : "other than 0"));
  }
  return {};
}

Result<std::vector<SensorStart>> SensorStarts(const Recording& recording, const SensorModel& sensor,
                                              const FitOptions& options) {
  if (sensor.kind == SensorKind::kArc) return std::vector<SensorStart>{StartOfArc(recording)};
  ASSIGN_OR_RETURN(const Turns turns, FindTurnsOf(recording));
  return StartsOf(recording, sensor, options, turns);
}

std::vector<SensorStart> SensorStarts(const Recording& recording, const SensorModel& sensor, const FitOptions& options,
                                      const Oscillation& oscillation) {
  if (sensor.kind == SensorKind::kArc) return {StartOfArc(recording)};
  return StartsOf(recording, sensor, options, {oscillation, TurningPointView(recording)});
}

void AppendSensorParameters(const SensorModel& sensor, const SensorStart& start, StartValues& values) {
  const double zero = values.parameters.back();
  values.parameters.pop_back();
  values.parameters.insert(values.parameters.end(), start.parameters.begin(), start.parameters.end());
  if (sensor.kind == SensorKind::kArc) values.parameters[values.parameters.size() - start.parameters.size()] = zero;
}

}  // namespace pendulum
