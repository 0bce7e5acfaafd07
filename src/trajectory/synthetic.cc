// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/synthetic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/student_t_distribution.hpp>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/model/nesting.h"
#include "pendulum/trajectory/encoder.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

constexpr double kTraceError = 1e-12;  // rad
constexpr int kMaxSamples = 20'000'000;

tl::unexpected<Status> BadOption(std::string_view name, double value, std::string_view rule) {
  return Error(StatusCode::kInvalidArgument,
               std::string(name) + " is " + NumberText(value) + "; it must be " + std::string(rule));
}

/// One option and the domain of its value.
struct NumberRule {
  std::string_view name;
  double value;
  enum class Domain { kFinite, kZeroOrMore, kPositive } domain = Domain::kFinite;
};

Result<void> CheckNumber(const NumberRule& rule) {
  using Domain = NumberRule::Domain;
  if (!std::isfinite(rule.value)) return BadOption(rule.name, rule.value, "finite");
  if (rule.domain == Domain::kZeroOrMore && rule.value < 0) return BadOption(rule.name, rule.value, "0 or more");
  if (rule.domain == Domain::kPositive && rule.value <= 0) return BadOption(rule.name, rule.value, "positive");
  return {};
}

/// Checks the shape of the noise. CheckNumbers checks its size.
Result<void> CheckNoiseLaw(const SyntheticOptions& options) {
  const double correlation = options.noise_correlation;
  if (!(std::abs(correlation) < 1)) return BadOption("noise_correlation", correlation, "between -1 and 1");
  const double freedom = options.noise_freedom;
  if (freedom == 0 || (std::isfinite(freedom) && freedom > 2)) return {};
  return BadOption("noise_freedom", freedom, "0 or above 2");
}

Result<void> CheckNumbers(const SyntheticOptions& options) {
  using Domain = NumberRule::Domain;
  const std::array rules = {
      NumberRule{"release_angle", options.release_angle},
      NumberRule{"release_time", options.release_time},
      NumberRule{"initial_angle", options.initial_angle},
      NumberRule{"initial_rate", options.initial_rate},
      NumberRule{"start_time", options.start_time},
      NumberRule{"duration", options.duration, Domain::kPositive},
      NumberRule{"sample rate", options.sample_rate, Domain::kPositive},
      NumberRule{"jitter", options.jitter, Domain::kZeroOrMore},
      NumberRule{options.quantity == Quantity::kRate ? "rate_bias" : "zero_angle", options.zero},
      NumberRule{"noise", options.noise, Domain::kZeroOrMore},
      NumberRule{"resolution", options.resolution, Domain::kZeroOrMore},
  };
  for (const NumberRule& rule : rules) {
    RETURN_IF_ERROR(CheckNumber(rule));
  }
  return CheckNoiseLaw(options);
}

Result<void> CheckModel(const SyntheticOptions& options) {
  const std::string_view friction = options.model.friction;
  if (!FrictionModels::Visit(friction, []<typename F>() {})) {
    return Error(StatusCode::kInvalidArgument, "there is no friction law '" + std::string(friction) +
                                                   "'; the laws are " + NameList(FrictionModels::kNames));
  }
  const std::vector<ParameterInfo> infos = PhysicalParameters(options.model);
  if (options.parameters.size() != infos.size()) {
    return Error(StatusCode::kInvalidArgument, "model " + std::string(options.model.name) + " takes " +
                                                   std::to_string(infos.size()) + " parameters, not " +
                                                   std::to_string(options.parameters.size()));
  }
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const NumberRule rule = {infos[i].name, options.parameters[i]};
    RETURN_IF_ERROR(CheckNumber(rule));
    if (rule.value < infos[i].lower) return BadOption(rule.name, rule.value, "at least " + NumberText(infos[i].lower));
    if (rule.value > infos[i].upper) return BadOption(rule.name, rule.value, "at most " + NumberText(infos[i].upper));
  }
  if (const auto [larger, smaller] = FindOrderedPair(options.model); larger >= 0) {
    const double least = options.parameters[static_cast<std::size_t>(smaller)];
    const auto at = static_cast<std::size_t>(larger);
    if (options.parameters[at] < least) {
      return BadOption(
          infos[at].name, options.parameters[at],
          "at least " + std::string(infos[static_cast<std::size_t>(smaller)].name) + ", which is " + NumberText(least));
    }
  }
  return CheckNumber({infos[0].name, options.parameters[0], NumberRule::Domain::kPositive});
}

Result<void> CheckLostCounts(const SyntheticOptions& options) {
  for (const LostCounts& lost : options.lost_counts) {
    if (!std::isfinite(lost.time) || lost.time >= options.start_time + options.duration) {
      return BadOption("the time of lost counts", lost.time, "before the recording ends");
    }
  }
  if (options.lost_counts.empty() || options.resolution > 0) return {};
  return Error(StatusCode::kInvalidArgument, "only a sensor with discrete levels loses counts; give a resolution");
}

/// The amount by which counts lost before `time` raise the readings.
double LostOffsetBefore(const SyntheticOptions& options, double time) {
  double counts = 0;
  for (const LostCounts& lost : options.lost_counts) counts += time >= lost.time ? lost.counts : 0;
  return counts * options.resolution;
}

Result<void> CheckSensor(const SyntheticOptions& options) {
  const std::vector<ParameterInfo> infos = options.sensor.Parameters();
  if (options.sensor_parameters.size() != infos.size()) {
    return Error(StatusCode::kInvalidArgument, "the sensor takes " + std::to_string(infos.size()) +
                                                   " parameters, not " +
                                                   std::to_string(options.sensor_parameters.size()));
  }
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const NumberRule rule = {infos[i].name, options.sensor_parameters[i]};
    RETURN_IF_ERROR(CheckNumber(rule));
    if (rule.value < infos[i].lower) return BadOption(rule.name, rule.value, "at least " + NumberText(infos[i].lower));
  }
  if (!options.range) return {};
  const auto [low, high] = *options.range;
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
    return Error(StatusCode::kInvalidArgument, "the range is " + NumberText(low) + " to " + NumberText(high) +
                                                   "; it must be two finite increasing numbers");
  }
  if (options.resolution > high - low) return BadOption("resolution", options.resolution, "no wider than the range");
  return {};
}

/// Only an encoder that measures an angle has events.
Result<void> CheckEvents(const SyntheticOptions& options) {
  const bool even = options.rows == RowTiming::kEven;
  if (options.time_noise != 0 && options.rows != RowTiming::kEvents)
    return BadOption("time_noise", options.time_noise, "0 unless rows are events");
  if (even) return CheckNumber({"time_noise", options.time_noise, NumberRule::Domain::kZeroOrMore});
  const bool plain = options.quantity == Quantity::kAngle && !options.range && options.jitter == 0 &&
                     options.noise_correlation == 0 && options.noise_freedom == 0;
  if (!plain) {
    return Error(StatusCode::kInvalidArgument,
                 "rows of events come from an encoder: the sensor must measure an angle, without range or jitter, with "
                 "white normal noise");
  }
  if (!(options.resolution >= kFinestEvents))
    return BadOption("resolution", options.resolution, "at least 1e-05 rad where rows are events");
  if (options.noise > kMaxEventNoise * options.resolution)
    return BadOption("noise", options.noise, "at most a fifth of the resolution where rows are events");
  return CheckNumber({"time_noise", options.time_noise, NumberRule::Domain::kZeroOrMore});
}

/// Only a direct sensor at even intervals averages, because its noise is drawn for each reading.
Result<void> CheckAveraging(const SyntheticOptions& options) {
  const int n = options.oversample;
  if (n < 1 || n > kMostOversampling) return BadOption("oversample", n, "a whole number, 1 to 64");
  const double window = options.averaging_window;
  if (!(window >= 0) || window > 1 / options.sample_rate)
    return BadOption("the averaging window", window, "0 or more and no longer than a sampling interval");
  if (n == 1 && window == 0) return {};
  if (n == 1) return BadOption("the averaging window", window, "0 unless rows are means of several readings");
  if (options.rows == RowTiming::kEven && options.noise_correlation == 0 && options.noise_freedom == 0 &&
      options.sensor.kind != SensorKind::kArc && options.lost_counts.empty())
    return {};
  return Error(StatusCode::kInvalidArgument,
               "rows that are means of several readings need white normal noise, at equal intervals, without lost "
               "counts, and not both coordinates of a point");
}

Result<Eigen::Index> SampleCount(const SyntheticOptions& options) {
  const double count = std::round(options.duration * options.sample_rate);
  if (!(count <= kMaxSamples)) {
    return Error(StatusCode::kInvalidArgument,
                 NumberText(options.duration) + " s at " + NumberText(options.sample_rate) + " Hz are more than " +
                     std::to_string(kMaxSamples) + " samples; shorten it or sample more slowly");
  }
  if (count < kMinimumSamples) {
    return Error(StatusCode::kFailedPrecondition,
                 NumberText(options.duration) + " s at " + NumberText(options.sample_rate) + " Hz are " +
                     NumberText(count) + " samples; at least " + std::to_string(kMinimumSamples) + " are needed");
  }
  return static_cast<Eigen::Index>(count);
}

using NormalDraws = boost::random::normal_distribution<double>;

/// Jittered instants in order. An instant that jitter moves before the first sample is mirrored at the first sample.
Eigen::VectorXd SamplingInstants(const SyntheticOptions& options, Eigen::Index count, std::mt19937_64& generator) {
  const double first = options.start_time;
  Eigen::VectorXd time(count);
  for (Eigen::Index i = 0; i < count; ++i) time[i] = first + static_cast<double>(i) / options.sample_rate;
  if (options.jitter == 0) return time;
  NormalDraws draw(0, options.jitter);
  for (Eigen::Index i = 1; i < count; ++i) time[i] = first + std::abs(time[i] + draw(generator) - first);
  std::sort(time.begin(), time.end());
  for (Eigen::Index i = 1; i < count; ++i) {
    time[i] = std::max(time[i], std::nextafter(time[i - 1], std::numeric_limits<double>::infinity()));
  }
  return time;
}

/// Noise from mt19937_64 and Boost's distributions, which give the same values on every platform. Correlated noise is
/// e_0 = s x_0, e_i = r e_(i-1) + sqrt(1 - r²) s x_i with s = noise and independent x_i, normal or t. Its standard
/// deviation therefore equals that of s x_i from the first sample on.
Eigen::VectorXd NoiseSamples(const SyntheticOptions& options, Eigen::Index count, std::mt19937_64& generator) {
  Eigen::VectorXd noise(count);
  if (options.noise_freedom > 0) {
    boost::random::student_t_distribution<double> draw(options.noise_freedom);
    for (double& sample : noise) sample = options.noise * draw(generator);
  } else {
    NormalDraws draw;
    for (double& sample : noise) sample = options.noise * draw(generator);
  }
  const double correlation = options.noise_correlation;
  if (correlation == 0) return noise;
  const double rest = std::sqrt((1 - correlation) * (1 + correlation));
  for (Eigen::Index i = 1; i < count; ++i) noise[i] = correlation * noise[i - 1] + rest * noise[i];
  return noise;
}

/// The largest |θ| [rad] that an undamped pendulum reaches from this start, by (1 - cos A) = (1 - cos θ) + I ω² / 2.
double UndampedAmplitude(const SyntheticOptions& options) {
  if (options.start == StartKind::kRelease) return options.release_angle;
  const double kinetic = 0.5 * options.parameters.front() * options.initial_rate * options.initial_rate;
  const double half_sine = std::sin(0.5 * options.initial_angle);
  return 2 * std::asin(std::sqrt(std::min(half_sine * half_sine + 0.5 * kinetic, 1.0)));
}

Result<Trajectory> TraceStart(const SyntheticOptions& options, double end) {
  const bool released = options.start == StartKind::kRelease;
  if (released && options.release_time >= end) {
    return Error(StatusCode::kFailedPrecondition, "the release at " + NumberText(options.release_time) +
                                                      " s comes after the last sample, " + NumberText(end) +
                                                      " s: nothing moves");
  }
  const Start<double> start{options.start, released ? options.release_time : options.start_time,
                            released ? options.release_angle : options.initial_angle,
                            released ? 0.0 : options.initial_rate};
  TraceOptions trace;
  trace.begin = options.start_time;
  trace.end = end;
  trace.tolerance = TraceTolerance(kTraceError, UndampedAmplitude(options));
  return MakeTrajectory(options.model, options.parameters, start, trace);
}

}  // namespace

std::vector<double> TrueParameters(const SyntheticOptions& options) {
  const bool released = options.start == StartKind::kRelease;
  std::vector<double> parameters = options.parameters;
  parameters.push_back(released ? options.release_angle : options.initial_angle);
  parameters.push_back(released ? options.release_time : options.initial_rate);
  if (options.sensor.kind == SensorKind::kDirect) {
    parameters.push_back(options.zero);
  } else {
    parameters.insert(parameters.end(), options.sensor_parameters.begin(), options.sensor_parameters.end());
  }
  if (options.rows == RowTiming::kEvents) parameters.push_back(options.hysteresis);
  return parameters;
}

double SensorReading(double x, double resolution, const std::optional<SensorRange>& range) {
  const double low = range ? range->low : 0.0;
  if (resolution == 0) return range ? std::clamp(x, low, range->high) : x;
  double level = std::round((x - low) / resolution);
  if (range) {
    constexpr double kRounding = 1e-6;  // tolerates rounding if the range is a whole number of levels
    level = std::clamp(level, 0.0, std::floor((range->high - low) / resolution + kRounding));
  }
  return low + resolution * level;
}

namespace {

/// The reading without noise.
double TrueReading(const SyntheticOptions& options, const Trajectory& trajectory, double time) {
  if (options.sensor.kind != SensorKind::kDirect) {
    const std::array state = {trajectory.Angle(time), trajectory.Rate(time), trajectory.Acceleration(time)};
    return options.sensor.At(state, options.sensor_parameters.data()).reading;
  }
  return (options.quantity == Quantity::kRate ? trajectory.Rate(time) : trajectory.Angle(time)) + options.zero;
}

/// Unit of the readings. A simulated length is in metres.
std::string UnitOf(const SyntheticOptions& options) {
  switch (options.sensor.kind) {
    case SensorKind::kDirect: return options.quantity == Quantity::kRate ? "rad/s" : "rad";
    case SensorKind::kScaledRate: return "volts";
    case SensorKind::kAcceleration: return "m/s^2";
    case SensorKind::kCoordinate:
    case SensorKind::kArc: return "m";
  }
  return "rad";
}

Result<void> CheckAll(const SyntheticOptions& options) {
  for (const auto check : {CheckNumbers, CheckModel, CheckSensor, CheckLostCounts, CheckEvents, CheckAveraging}) {
    RETURN_IF_ERROR(check(options));
  }
  return {};
}

/// The simulated sensor does nothing to the readings but noise and levels.
SensorStatement IdealSensor() { return {.kind = "ideal", .std_devs = {}, .source = "simulated"}; }

/// Records the angles of a point about the circle on which it moves.
Result<Recording> RecordAngles(const SyntheticOptions& options) {
  ASSIGN_OR_RETURN(TrackedPoint point, SimulatePoint(options));
  ASSIGN_OR_RETURN(Arc arc, FitArc(point.x, point.y));
  Recording recording;
  recording.unit = UnitOf(options);
  recording.time = std::move(point.time);
  recording.value.resize(recording.time.size());
  for (Eigen::Index i = 0; i < recording.size(); ++i) recording.value[i] = arc.Angle(point.x[i], point.y[i]);
  recording.arc = std::move(arc);
  recording.stated_sensor = IdealSensor();
  return MakeRecording(std::move(recording));
}

/// The mean of the readings about one sampling instant.
double MeanReading(const SyntheticOptions& options, const Trajectory& trajectory, double time, NormalDraws& draw,
                   std::mt19937_64& generator) {
  const int n = options.oversample;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double instant = std::max(time + ((k + 0.5) / n - 0.5) * options.averaging_window, options.start_time);
    const double value = TrueReading(options, trajectory, instant) + options.noise * draw(generator);
    sum += SensorReading(value, options.resolution, options.range);
  }
  return sum / n;
}

/// Sets the samples of a recording whose rows are means.
void SetMeans(const SyntheticOptions& options, const Trajectory& trajectory, std::mt19937_64& generator,
              Recording& recording) {
  NormalDraws draw;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    recording.value[i] = MeanReading(options, trajectory, recording.time[i], draw, generator);
  }
  const double half = 0.5 * options.averaging_window;
  const double level = options.range ? options.range->low : 0;
  recording.oversampling = {options.oversample, AveragingWindow{-half, half}, options.resolution, level, true};
  recording.resolution = options.resolution / options.oversample;
}

}  // namespace

Result<TrackedPoint> SimulatePoint(const SyntheticOptions& options) {
  RETURN_IF_ERROR(CheckAll(options));
  ASSIGN_OR_RETURN(const Eigen::Index count, SampleCount(options));
  std::mt19937_64 generator(options.seed);
  TrackedPoint point;
  point.x = NoiseSamples(options, count, generator);
  point.time = SamplingInstants(options, count, generator);
  point.y = NoiseSamples(options, count, generator);
  ASSIGN_OR_RETURN(const Trajectory trajectory, TraceStart(options, point.time[count - 1]));
  const std::vector<double>& p = options.sensor_parameters;  // zero_angle, pivot_x, pivot_y, radius
  for (Eigen::Index i = 0; i < count; ++i) {
    const double angle = trajectory.Angle(point.time[i]) + p[0];
    const double x = p[1] + p[3] * std::sin(angle) + point.x[i];
    const double y = p[2] + options.sensor.down * p[3] * std::cos(angle) + point.y[i];
    point.x[i] = SensorReading(x, options.resolution, options.range);
    point.y[i] = SensorReading(y, options.resolution, options.range);
  }
  return point;
}

Result<Recording> SimulateRecording(const SyntheticOptions& options) {
  if (options.sensor.kind == SensorKind::kArc) return RecordAngles(options);
  RETURN_IF_ERROR(CheckAll(options));
  ASSIGN_OR_RETURN(const Eigen::Index count, SampleCount(options));

  std::mt19937_64 generator(options.seed);
  const Eigen::VectorXd noise = NoiseSamples(options, count, generator);
  Recording recording;
  recording.time = SamplingInstants(options, count, generator);
  const double end = recording.time[count - 1];
  ASSIGN_OR_RETURN(const Trajectory trajectory, TraceStart(options, end + 0.5 * options.averaging_window));

  recording.quantity = options.quantity;
  recording.stated_sensor = IdealSensor();
  recording.unit = UnitOf(options);
  recording.shows_gravity = options.quantity != Quantity::kAcceleration || options.sensor.gravity > 0;
  recording.resolution = options.resolution;
  recording.range = options.range;
  if (options.rows != RowTiming::kEven) {
    const Eigen::VectorXd instants = recording.time;
    ReadEncoder(trajectory, options, instants, recording);
    for (Eigen::Index i = 0; i < recording.size(); ++i)
      recording.value[i] += LostOffsetBefore(options, recording.time[i]);
    return MakeRecording(std::move(recording));
  }
  recording.value.resize(count);
  if (options.oversample > 1) SetMeans(options, trajectory, generator, recording);
  for (Eigen::Index i = 0; i < count && options.oversample == 1; ++i) {
    const double truth = TrueReading(options, trajectory, recording.time[i]);
    recording.value[i] = SensorReading(truth + noise[i], options.resolution, options.range);
    recording.value[i] += LostOffsetBefore(options, recording.time[i]);
  }
  if (!recording.value.allFinite()) {
    return Error(StatusCode::kFailedPrecondition,
                 "the motion cannot be computed with these parameters, because a number overflows");
  }
  return MakeRecording(std::move(recording));
}

}  // namespace pendulum
