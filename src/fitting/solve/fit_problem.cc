// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/fit_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/low_band.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/start/sensor_start.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/model/nesting.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// Index, among all parameters, of the first friction parameter that can hold the pendulum at rest; -1: none.
int HoldingParameter(const MotionModel& model) {
  int holding = -1;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    for (int k = kFrictionParameters<F> - 1; k >= 0 && !FrictionWithState<F>; --k) {
      std::array<double, kFrictionParameters<F>> unit{};
      unit[k] = 1;
      if (F::Torque(0.0, 1.0, unit.data()) > 0) holding = 1 + k;
    }
  });
  return holding;
}

/// s², in units of the restoring torque G; a smaller inertia would give a frequency ω0 = 1/sqrt(I) too high to compute.
constexpr double kSmallestInertia = 1e-30;

/// The permitted range of a parameter as text for a message, in reported units.
std::string Range(const FitProblem& problem, std::size_t i) {
  const auto reported = [&](double internal) { return NumberText(problem.Reported(i, internal)); };
  if (problem.infos[i].name == kInertia.name) return "greater than " + reported(kSmallestInertia);
  const std::string from = "at least " + reported(problem.solve.lower[i]);
  return std::isfinite(problem.solve.upper[i]) ? from + " and at most " + reported(problem.solve.upper[i]) : from;
}

/// Index of the parameter that an option names. `what` is the action of the option, for the message.
Result<std::size_t> FindParameter(const FitProblem& problem, const std::string& name, const std::string& what) {
  if (const std::optional<std::size_t> found = problem.Find(name)) return *found;
  return Error(StatusCode::kInvalidArgument, "model " + std::string(problem.model.name) + " has no parameter '" + name +
                                                 "' to " + what + " with this start; it has " +
                                                 NameList(problem.infos));
}

/// Sets the start value of parameter i. Returns an error if the value is not permitted.
Result<void> SetStartValue(double value, std::size_t i, const std::string& what, FitProblem& problem) {
  const double internal = problem.Internal(i, value);
  const bool too_small = problem.infos[i].name == kInertia.name && !(internal > kSmallestInertia);
  const bool outside = internal < problem.solve.lower[i] || internal > problem.solve.upper[i];
  if (!std::isfinite(internal) || outside || too_small) {
    return Error(StatusCode::kInvalidArgument, std::string(problem.infos[i].name) + " cannot be " + what + " " +
                                                   NumberText(value) + "; it must be " + Range(problem, i));
  }
  problem.first_guess[i] = internal;
  return {};
}

Result<void> ApplyBounds(const ParameterRanges& bounds, FitProblem& problem) {
  for (const auto& [name, range] : bounds) {
    ASSIGN_OR_RETURN(const std::size_t i, FindParameter(problem, name, "bound"));
    double& lower = problem.solve.lower[i];
    double& upper = problem.solve.upper[i];
    const double new_lower = std::max(problem.Internal(i, range.lower), lower);
    const double new_upper = std::min(problem.Internal(i, range.upper), upper);
    const bool too_small = name == kInertia.name && !(new_upper > kSmallestInertia);
    if (!(new_lower < new_upper) || too_small) {
      return Error(StatusCode::kInvalidArgument, "the bounds of " + name + " allow no value; it must be " +
                                                     Range(problem, i) + ", and may be fixed with --fix");
    }
    lower = new_lower;
    upper = new_upper;
    problem.first_guess[i] = std::clamp(problem.first_guess[i], lower, upper);
  }
  return {};
}

Result<void> ApplyPriors(const ParameterPriors& priors, FitProblem& problem) {
  for (const auto& [name, prior] : priors) {
    ASSIGN_OR_RETURN(const std::size_t i, FindParameter(problem, name, "give a prior"));
    const double scale = problem.si_per_internal[i];
    problem.priors.push_back({static_cast<int>(i), problem.Internal(i, prior.mean), scale / prior.std_dev});
  }
  return {};
}

/// Applies the user's bounds, start values, fixed values and priors, and the prior knowledge of the sensor.
Result<void> ApplyOptions(const FitOptions& options, const ParameterPriors& sensor_priors, FitProblem& problem) {
  RETURN_IF_ERROR(ApplyBounds(options.bounds, problem));
  for (const auto& [name, value] : options.initial) {
    ASSIGN_OR_RETURN(const std::size_t i, FindParameter(problem, name, "give an initial value"));
    RETURN_IF_ERROR(SetStartValue(value, i, "started at", problem));
  }
  for (const auto& [name, value] : options.fixed) {
    ASSIGN_OR_RETURN(const std::size_t i, FindParameter(problem, name, "fix"));
    RETURN_IF_ERROR(SetStartValue(value, i, "fixed at", problem));
    problem.solve.fixed[i] = true;
  }
  RETURN_IF_ERROR(ApplyPriors(options.priors, problem));
  return ApplyPriors(sensor_priors, problem);
}

/// Sets the bounds in the units of the problem: the parameters' own bounds and, for the release, the end of the hold.
void SetBounds(FitProblem& problem) {
  for (const ParameterInfo& info : problem.infos) {
    const bool is_release = info.name == kReleaseTime.name;
    problem.solve.lower.push_back(is_release ? 0.0 : info.name == kInertia.name ? -kUnbounded : info.lower);
    problem.solve.upper.push_back(is_release ? problem.start.latest_release : info.upper);
  }
}

TrajectoryData MakeData(const Recording& recording, const SensorModel& sensor, const StartValues& start) {
  TrajectoryData data;
  data.quantity = recording.quantity;
  data.sensor = sensor;
  data.time.resize(static_cast<std::size_t>(recording.size()));
  std::transform(recording.time.begin(), recording.time.end(), data.time.begin(),
                 [&](double time) { return time - recording.time[0]; });
  data.value.assign(recording.value.begin(), recording.value.end());
  data.natural_frequency = start.natural_frequency;
  data.latest_release = start.latest_release;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  data.scale = std::max({SuccessiveDifferenceNoise(recording), 0.3 * recording.resolution, 1e-6 * range});
  return data;
}

/// Marks readings at an end of the sensor's range as censored. If readings have levels, these are the readings in the
/// outermost level within the range. The tolerance allows for rounded readings and rounded ends of the range in files.
void SetCensoring(const Recording& recording, FitProblem& problem) {
  problem.noise.sigma = problem.data.scale;
  problem.resolution = recording.resolution;
  problem.noise.edge = recording.edge;
  if (recording.edge) problem.noise.resolution = recording.resolution;
  if (!recording.range) return;
  constexpr double kRounding = 1e-6;
  const auto [low, high] = *recording.range;
  const double q = recording.resolution;
  const double levels = q > 0 ? std::floor((high - low) / q + kRounding) : 0;
  const double half = q > 0 ? 0.5 * q : kRounding * (high - low);
  NoiseModel noise = problem.noise;
  noise.low = low + half;
  noise.high = (q > 0 ? low + q * levels : high) - half;
  problem.censored =
      std::ranges::count_if(problem.data.value, [&](double reading) { return noise.IsCensored(reading); });
  if (problem.censored > 0) problem.noise = noise;
}

/// Sets how the samples are means of rounded readings, if their levels are known.
void SetAveraging(const Recording& recording, FitProblem& problem) {
  const Oversampling& oversampling = recording.oversampling;
  if (oversampling.readings <= 1 || !(oversampling.count > 0)) return;
  problem.oversampling = oversampling;
  if (auto& window = problem.oversampling.window) {
    window->from *= recording.clock_scale;
    window->to *= recording.clock_scale;
  }
  problem.noise.averaging = {oversampling.readings, oversampling.count, oversampling.level, nullptr, {}};
}

/// Replaces each value by the median of the five values around it, so that single outliers do not look like the start
/// of the motion.
Recording WithoutOutliers(Recording recording) {
  const Eigen::VectorXd value = recording.value;
  for (Eigen::Index i = 2; i + 2 < value.size(); ++i) {
    std::array<double, 5> five{};
    std::copy_n(value.begin() + i - 2, five.size(), five.begin());
    std::nth_element(five.begin(), five.begin() + 2, five.end());
    recording.value[i] = five[2];
  }
  return recording;
}

tl::unexpected<Status> NeedsCalibration(const Recording& recording, const MotionModel& model) {
  return WithTry(
      Fault(recording.path, "the readings are in " + recording.unit + ", but model " + std::string(model.name) +
                                " needs an angle: give readings at known angles with --calibration "
                                "(a table such as counts,angle_deg), or fit --model linear, whose "
                                "period and damping need no angle"),
      {"--model linear"});
}

ZeroMotion ZeroMotionOf(const Recording& recording, const SensorModel& sensor, const FitOptions& options) {
  if (sensor.kind != SensorKind::kDirect) return ZeroMotion::kNone;
  const auto names = [](const auto& map) { return map.contains(kZeroDrift.name) || map.contains(kBiasDrift.name); };
  const bool drifts = names(options.fixed) || names(options.initial) || names(options.bounds) || names(options.priors);
  const bool lags = recording.edge && !IsRobust(options.noise);
  return drifts ? ZeroMotion::kDrifts : lags ? ZeroMotion::kLags : ZeroMotion::kNone;
}

}  // namespace

std::optional<std::size_t> FitProblem::Find(std::string_view name) const {
  const auto found = std::ranges::find(infos, name, &ParameterInfo::name);
  if (found == infos.end()) return std::nullopt;
  return static_cast<std::size_t>(found - infos.begin());
}

double FitProblem::RmsResidual(const Eigen::VectorXd& readings) const {
  double sum = 0;
  double count = 0;
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    const double value = data.values()[i];
    if (noise.IsCensored(value) || noise.IsSilence(value)) continue;
    sum += (value - readings[i]) * (value - readings[i]);
    ++count;
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

double FitProblem::UnexplainedShare(const Eigen::VectorXd& readings) const {
  const auto values = data.values();
  double left = 0;
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    const bool beyond =
        (values[i] >= noise.high && readings[i] >= noise.high) || (values[i] <= noise.low && readings[i] <= noise.low);
    if (!beyond) left += (values[i] - readings[i]) * (values[i] - readings[i]);
  }
  return left / (values.array() - values.mean()).matrix().squaredNorm();
}

namespace {

Result<void> CheckNoise(const Recording& recording, const FitOptions& options) {
  const bool has_means = recording.oversampling.readings > 1 && recording.oversampling.count > 0;
  if (options.noise == NoiseFamily::kAveraged && !has_means) {
    return Error(StatusCode::kInvalidArgument,
                 "--noise averaged needs rows that are means of 2 to 64 readings in whole counts; give --oversample, "
                 "and --resolution, the spacing of the means, if their levels are not found");
  }
  const bool edges = options.noise == NoiseFamily::kEdges;
  if (!edges && options.noise != NoiseFamily::kQuantized) return {};
  if (edges && recording.edge) return {};
  if (edges) {
    return Error(StatusCode::kInvalidArgument,
                 "--noise edges needs rows that exist only where the count changes, mostly by one count and at "
                 "unequal intervals; this recording has other rows");
  }
  if (recording.resolution > 0) return {};
  return Error(StatusCode::kInvalidArgument,
               "--noise quantized needs the resolution of the readings, but the readings show no discrete levels; give "
               "--resolution");
}

Result<void> CheckSensor(const Recording& recording, const MotionModel& model, const SensorModel& sensor,
                         const FitOptions& options) {
  const bool is_raw_angle = recording.quantity == Quantity::kAngle && !recording.is_calibrated();
  if (is_raw_angle && !model.gravity.is_linear()) return NeedsCalibration(recording, model);
  RETURN_IF_ERROR(CheckSensorOptions(sensor, options));
  if (recording.quantity != Quantity::kAcceleration) return {};
  if (sensor.kind == SensorKind::kDirect && IsAlongRod(recording)) {
    return Fault(recording.path,
                 "an acceleration along the rod swings twice as fast as the pendulum, which --model linear cannot "
                 "describe; choose the axis across the rod, or another model");
  }
  if (options.start == StartKind::kRelease) {
    return ErrorAt(
        StatusCode::kFailedPrecondition, recording.path,
        "an acceleration jumps at the release, and no sample shows when; --start moving fits the motion after it");
  }
  return {};
}

/// Start values from the readings, converted by the sensor to an angle or a rate.
Result<StartValues> FindStart(const Recording& timed, const MotionModel& model, const SensorModel& sensor,
                              const FitOptions& options, std::size_t& sensor_starts) {
  const auto estimate = [&](const Recording& view) {
    const auto choice = timed.quantity == Quantity::kAcceleration ? StartKind::kMoving : options.start;
    Recording quiet = IsRobust(options.noise) ? WithoutOutliers(view) : view;
    if (options.search.vibration_period > 0) quiet = LowBand(quiet, options.search.vibration_period);
    return EstimateStartValues(quiet, model, choice);
  };
  if (sensor.kind == SensorKind::kDirect)
    return HasTurningPointView(timed) ? estimate(TurningPointView(timed)) : estimate(timed);
  ASSIGN_OR_RETURN(const std::vector<SensorStart> starts, SensorStarts(timed, sensor, options));
  if (starts.empty())
    return Error(StatusCode::kFailedPrecondition, "these readings do not match the swing of any pendulum");
  sensor_starts = starts.size();
  const SensorStart& start = starts[std::min(options.search.sensor_start, starts.size() - 1)];
  Result<StartValues> values = estimate(start.view);
  if (values) AppendSensorParameters(sensor, start, *values);
  return values;
}

}  // namespace

Result<void> CheckReadings(const Recording& recording, const FitOptions& options) {
  RETURN_IF_ERROR(CheckNoise(recording, options));
  ASSIGN_OR_RETURN(const MotionModel model, ModelOf(options));
  return CheckSensor(recording, model, SensorOf(recording, model.gravity), options);
}

Result<FitProblem> MakeFitProblem(const Recording& recording, const FitOptions& options) {
  RETURN_IF_ERROR(CheckReadings(recording, options));
  const Result<MotionModel> model = ModelOf(options);
  if (!model) return tl::unexpected(model.error());
  const SensorModel sensor = SensorOf(recording, model->gravity);
  std::optional<Recording> scaled;
  if (recording.clock_scale != 1) scaled = InTrueSeconds(recording);
  const Recording& timed = scaled ? *scaled : recording;
  FitProblem problem;
  const Result<StartValues> start = options.search.start_values
                                        ? Result<StartValues>(*options.search.start_values)
                                        : FindStart(timed, *model, sensor, options, problem.sensor_starts);
  if (!start) return Within(recording.path, start.error());

  problem.model = *model;
  problem.start = *start;
  problem.zero_motion = ZeroMotionOf(recording, sensor, options);
  problem.infos = FitParameters(*model, start->start, recording.quantity, problem.zero_motion, sensor);
  const bool has_zero_motion = problem.zero_motion != ZeroMotion::kNone;
  if (has_zero_motion && problem.start.parameters.size() < problem.infos.size()) problem.start.parameters.push_back(0);
  if (problem.start.parameters.size() != problem.infos.size()) {
    return Error(StatusCode::kInvalidArgument,
                 "the start values belong to a model other than " + std::string(model->name));
  }
  problem.first_guess = problem.start.parameters;
  problem.data = MakeData(timed, sensor, *start);
  problem.data.zero_motion_factors = ZeroMotionFactors(recording, problem.data.times(), problem.zero_motion);
  problem.data.stop = options.stop;
  SetCensoring(recording, problem);
  SetAveraging(recording, problem);
  const double gravity_torque = options.rig ? options.rig->gravity_torque.value : 1.0;
  for (const ParameterInfo& info : problem.infos) {
    const bool is_release = info.name == kReleaseTime.name;
    problem.si_per_internal.push_back(is_release                   ? 1 / recording.clock_scale
                                      : info.scales_with_gravity() ? gravity_torque
                                                                   : 1.0);
    problem.offset.push_back(is_release ? recording.time[0] : 0.0);
  }
  SetBounds(problem);
  problem.solve.fixed.assign(problem.infos.size(), false);
  problem.solve.holding_parameter = HoldingParameter(*model);
  problem.solve.last_friction = static_cast<int>(PhysicalParameters(*model).size()) - 1;
  if (const OrderedPair order = FindOrderedPair(*model); order.larger >= 0) {
    problem.solve.small_swing_parameters = {order.larger, problem.solve.last_friction};
  }
  if (start->start == StartKind::kRelease) problem.solve.release_time = problem.solve.last_friction + 2;
  problem.restricted = !options.fixed.empty() || !options.bounds.empty() || !options.priors.empty();
  problem.solve.max_iterations = options.search.max_iterations;
  problem.solve.max_traces = options.search.max_traces;
  const ParameterPriors sensor_priors = SensorPriors(recording, sensor, options);
  RETURN_IF_ERROR(ApplyOptions(options, sensor_priors, problem));
  return problem;
}

std::vector<double> FirstGuess(const FitProblem& problem, const std::vector<bool>& fixed) {
  if (fixed == problem.solve.fixed) return problem.first_guess;
  const auto first = fixed.begin() + 1;
  const std::vector<bool> left_out(first, first + problem.solve.last_friction);
  const std::vector<double> friction = FrictionFrom(problem.start.energy_balance, left_out);
  std::vector<double> guess = problem.first_guess;
  for (std::size_t i = 1; i <= friction.size(); ++i) {
    if (!problem.solve.fixed[i]) guess[i] = fixed[i] ? problem.solve.lower[i] : friction[i - 1];
  }
  return guess;
}

}  // namespace pendulum
