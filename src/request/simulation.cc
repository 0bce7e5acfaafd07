// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/nesting.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

constexpr std::array kUnits = {
    OutputUnit{"deg", "angle_deg", Quantity::kAngle, kRadFromDeg, "rad"},
    OutputUnit{"rad", "angle_rad", Quantity::kAngle, 1.0, "rad"},
    OutputUnit{"deg_s", "gyro_deg_s", Quantity::kRate, kRadFromDeg, "rad_s"},
    OutputUnit{"rad_s", "gyro_rad_s", Quantity::kRate, 1.0, "rad_s"},
    OutputUnit{"volts", "gyro_volts", Quantity::kRate, 1.0, "volts", SensorKind::kScaledRate},
    OutputUnit{"m_s2", "acceleration_m_s2", Quantity::kAcceleration, 1.0, "m_s2", SensorKind::kAcceleration},
    OutputUnit{"px", "x_px,y_px", Quantity::kPosition, 1.0, "px", SensorKind::kArc},
    OutputUnit{"m", "x_m,y_m", Quantity::kPosition, 1.0, "m", SensorKind::kArc},
};

Result<OutputUnit> FindUnit(const std::string& name) {
  for (const OutputUnit& unit : kUnits) {
    if (unit.name == name) return unit;
  }
  return BadFlag("--unit is '" + name + "'; it must be one of " + NameList(kUnits));
}

Result<MotionModel> ChooseModel(const SimulationFlags& flags) {
  Result<MotionModel> model = FindMotionModel(flags.model);
  if (!model) return Within("--model", model.error());
  if (flags.gravity.empty()) return model;
  const std::optional<Gravity> gravity = Gravity::Named(flags.gravity);
  if (!gravity)
    return BadFlag("--gravity is '" + flags.gravity + "'; it must be one of " + NameList(GravityModels::kNames));
  if (model->gravity != Gravity() && gravity != model->gravity) {
    return BadFlag("--gravity " + flags.gravity + " contradicts --model " + flags.model +
                   "; its friction law is --model " + std::string(model->friction));
  }
  if (const auto named = WithGravity(*model, *gravity)) return *named;
  model->gravity = *gravity;  // a fit cannot determine the law of gravity, but it can be simulated
  return model;
}

/// Every parameter that --set accepts, in the order of the truth file.
std::vector<ParameterInfo> SettableParameters(const SyntheticOptions& synthetic) {
  std::vector<ParameterInfo> infos = PhysicalParameters(synthetic.model);
  infos.insert(infos.end(), {kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate});
  const std::vector<ParameterInfo> sensor = synthetic.sensor.Parameters();
  infos.insert(infos.end(), sensor.begin(), sensor.end());
  if (sensor.empty()) infos.push_back(synthetic.quantity == Quantity::kRate ? kRateBias : kZeroAngle);
  return infos;
}

Result<StartKind> ChooseStart(const ParameterValues& values) {
  const auto given = [&](const ParameterInfo& info) { return values.contains(info.name); };
  const bool release = given(kReleaseAngle) || given(kReleaseTime);
  const bool moving = given(kInitialAngle) || given(kInitialRate);
  if (release && moving) {
    return BadFlag(
        "--set gives two starts; keep either release_angle and release_time, or initial_angle and initial_rate");
  }
  if (given(kReleaseAngle) && given(kReleaseTime)) return StartKind::kRelease;
  if (given(kInitialAngle) && given(kInitialRate)) return StartKind::kMoving;
  return BadFlag("--set lacks the start: give release_angle and release_time, or initial_angle and initial_rate");
}

double ValueOr0(const ParameterValues& values, const ParameterInfo& info) {
  const auto found = values.find(info.name);
  return found == values.end() ? 0.0 : found->second;
}

/// Adds the defaults of values missing in --set: inertia from the rig, no friction, no offset.
Result<void> Complete(const std::vector<ParameterInfo>& infos, const std::optional<Rig>& rig, StartKind start,
                      ParameterValues& values) {
  const std::string inertia(kInertia.name);
  if (rig && rig->inertia) values.try_emplace(inertia, rig->inertia->value);
  if (!values.contains(inertia)) return BadFlag("--set lacks inertia, and there is no rig with an inertia");
  if (values[inertia] <= 0) {
    return BadFlag("--set: inertia is " + NumberText(values[inertia]) + "; it must be positive");
  }
  for (const ParameterInfo& info : infos) {
    const bool is_scale = info.name == kRadius.name || info.name == kRateScale.name;
    if (is_scale && ValueOr0(values, info) == 0) {
      return BadFlag("--set lacks " + std::string(info.name) + ": " + std::string(info.description));
    }
    if (info.name == kAccelerationScale.name) values.try_emplace(std::string(info.name), 1.0);
  }
  const std::array<std::string_view, 2> other_start = start == StartKind::kRelease
                                                          ? std::array{kInitialAngle.name, kInitialRate.name}
                                                          : std::array{kReleaseAngle.name, kReleaseTime.name};
  for (const ParameterInfo& info : infos) {
    if (std::ranges::find(other_start, info.name) == other_start.end()) values.try_emplace(std::string(info.name), 0.0);
  }
  return {};
}

void SetMotion(const ParameterValues& values, double gravity_torque, SyntheticOptions& synthetic) {
  synthetic.parameters.clear();
  for (const ParameterInfo& info : PhysicalParameters(synthetic.model)) {
    const double unit = info.scales_with_gravity() ? gravity_torque : 1.0;
    synthetic.parameters.push_back(ValueOr0(values, info) / unit);
  }
  synthetic.release_angle = ValueOr0(values, kReleaseAngle);
  synthetic.release_time = ValueOr0(values, kReleaseTime);
  synthetic.initial_angle = ValueOr0(values, kInitialAngle);
  synthetic.initial_rate = ValueOr0(values, kInitialRate);
  synthetic.zero = ValueOr0(values, synthetic.quantity == Quantity::kRate ? kRateBias : kZeroAngle);
  synthetic.sensor_parameters.clear();
  for (const ParameterInfo& info : synthetic.sensor.Parameters()) {
    synthetic.sensor_parameters.push_back(ValueOr0(values, info));
  }
}

/// Applies --spread; `infos` are the parameters of --set, `values` are complete.
Result<void> ChooseSpread(const std::string& spread, std::vector<ParameterInfo> infos, const ParameterValues& values,
                          Simulation& simulation) {
  if (spread.empty()) return {};
  const std::vector<ParameterInfo> bounded = infos;
  for (ParameterInfo& info : infos) info.lower = 0, info.upper = kUnbounded;  // bounds of a standard deviation
  ASSIGN_OR_RETURN(const ParameterValues std_devs,
                   ParseSettings("--spread", spread, simulation.synthetic.model.name, infos));
  for (const auto& [name, std_dev] : std_devs) {
    if (values.contains(name)) continue;
    return BadFlag("--spread: " + name + " belongs to a start other than that of --set; leave it out");
  }
  for (const ParameterInfo& info : bounded) {
    if (!values.contains(info.name)) continue;
    simulation.scattered.push_back({info, ValueOr0(values, info), ValueOr0(std_devs, info)});
  }
  return {};
}

/// A simulation needs the torque that pulls the pendulum back, with the law of the rig.
Result<void> CheckRig(const std::optional<Rig>& rig, const MotionModel& model) {
  if (rig && !rig->gives_torque) {
    return BadFlag(
        "the rig gives no restoring torque, which a simulation needs; add the masses, or leave --rig out and "
        "give --set in units of the gravity torque");
  }
  if (rig && rig->is_spring && !model.gravity.is_linear())
    return BadFlag("the rig gives the stiffness of a spring; add --gravity linear");
  return {};
}

/// Applies --set to the chosen model: start and parameters, in `simulation` and in its true values.
Result<void> ChooseMotion(const SimulationFlags& flags, const std::optional<Rig>& rig, Simulation& simulation) {
  SyntheticOptions& synthetic = simulation.synthetic;
  RETURN_IF_ERROR(CheckRig(rig, synthetic.model));
  const std::vector<ParameterInfo> infos = SettableParameters(synthetic);
  ASSIGN_OR_RETURN(ParameterValues values, ParseSettings("--set", flags.set, synthetic.model.name, infos));
  ASSIGN_OR_RETURN(const StartKind start, ChooseStart(values));
  synthetic.start = start;
  RETURN_IF_ERROR(Complete(infos, rig, start, values));
  if (const double angle = ValueOr0(values, kReleaseAngle);
      !synthetic.model.gravity.is_linear() && std::abs(angle) > 2 * kPi) {
    return BadFlag("--set: release_angle is " + NumberText(angle) + " rad, more than a turn; if you mean " +
                   NumberText(angle) + " deg, give " + NumberText(angle * kRadFromDeg, 4));
  }
  simulation.gravity_torque = rig ? rig->gravity_torque.value : 1.0;
  SetMotion(values, simulation.gravity_torque, synthetic);
  for (const ParameterInfo& info : infos) {
    if (const auto found = values.find(info.name); found != values.end()) simulation.truth.emplace_back(*found);
  }
  return ChooseSpread(flags.spread, infos, values, simulation);
}

Result<std::optional<SensorRange>> ParseRange(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return BadFlag("--range is '" + text + "'; it must be low,high");
  const Result<double> low = ParseNumber("--range", text.substr(0, comma), "two numbers: low,high");
  const Result<double> high = ParseNumber("--range", text.substr(comma + 1), "two numbers: low,high");
  if (!low) return tl::unexpected(low.error());
  if (!high) return tl::unexpected(high.error());
  if (*low >= *high) return BadFlag("--range is '" + text + "'; low must be less than high");
  return SensorRange{*low, *high};
}

/// A number flag with its minimum.
struct NumberFlag {
  std::string_view name;
  double value;
  bool allows_zero;
};

Result<void> CheckNoiseLaw(const SimulationFlags& flags) {
  const double correlation = flags.noise_correlation;
  if (!(std::abs(correlation) < 1)) {
    return BadFlag("--noise_correlation is " + NumberText(correlation) + "; it must be between -1 and 1");
  }
  const double freedom = flags.noise_freedom;
  if (freedom == 0 || (std::isfinite(freedom) && freedom > 2)) return {};
  return BadFlag("--noise_freedom is " + NumberText(freedom) + "; it must be 0 or above 2");
}

Result<void> CheckNumbers(const SimulationFlags& flags) {
  const std::array numbers = {
      NumberFlag{"--duration", flags.duration, false},    NumberFlag{"--rate", flags.rate, false},
      NumberFlag{"--jitter", flags.jitter, true},         NumberFlag{"--noise", flags.noise, true},
      NumberFlag{"--resolution", flags.resolution, true}, NumberFlag{"--time_noise", flags.time_noise, true},
  };
  for (const NumberFlag& number : numbers) {
    if (std::isfinite(number.value) && (number.value > 0 || (number.allows_zero && number.value == 0))) continue;
    return BadFlag(std::string(number.name) + " is " + NumberText(number.value) + "; it must be " +
                   (number.allows_zero ? "0 or more" : "positive"));
  }
  return CheckNoiseLaw(flags);
}

/// Checks the flags of events by the rules of SimulateRecording.
Result<void> CheckEvents(const SimulationFlags& flags) {
  if (!flags.event_driven && flags.time_noise != 0) return BadFlag("--time_noise needs --event_driven");
  if (!flags.event_driven) return {};
  const bool plain = (flags.unit == "deg" || flags.unit == "rad") && flags.range.empty() && flags.jitter == 0 &&
                     flags.noise_correlation == 0 && flags.noise_freedom == 0;
  if (!plain) {
    return BadFlag(
        "--event_driven simulates an encoder, which measures an angle; leave out --range, --jitter, "
        "--noise_correlation and --noise_freedom");
  }
  if (!(flags.resolution > 0)) return BadFlag("--event_driven needs --resolution");
  if (flags.resolution * (flags.unit == "deg" ? kRadFromDeg : 1) < kFinestEvents) {
    return BadFlag("--resolution is " + NumberText(flags.resolution) + " " + flags.unit +
                   "; with --event_driven it must be at least 1e-05 rad");
  }
  if (flags.noise <= kMaxEventNoise * flags.resolution) return {};
  return BadFlag("--noise is " + NumberText(flags.noise) +
                 "; with --event_driven it must be at most a fifth of --resolution");
}

/// Checks the flags of means by the rules of SimulateRecording.
Result<void> CheckAveraging(const SimulationFlags& flags) {
  if (flags.oversample < 1 || flags.oversample > kMostOversampling) {
    return BadFlag("--oversample is " + std::to_string(flags.oversample) + "; it must be a whole number, 1 to " +
                   std::to_string(kMostOversampling));
  }
  if (flags.oversample == 1 && flags.window_s == 0) return {};
  if (flags.oversample == 1) return BadFlag("--window_s needs --oversample");
  if (!(flags.window_s >= 0) || flags.window_s > 1 / flags.rate) {
    return BadFlag("--window_s is " + NumberText(flags.window_s) +
                   "; it must be 0 or more and no longer than a sampling interval, " + NumberText(1 / flags.rate) +
                   " s");
  }
  const bool plain = !flags.event_driven && flags.lose.empty() && flags.noise_correlation == 0 &&
                     flags.noise_freedom == 0 && flags.unit != "px" && flags.unit != "m";
  if (plain) return {};
  return BadFlag(
      "--oversample simulates the means of a converter's readings; leave out --event_driven, --lose, "
      "--noise_correlation, --noise_freedom and the units px and m");
}

/// Sets sensor and sampling; converts noise, resolution and range to SI.
Result<void> ChooseSensor(const SimulationFlags& flags, Simulation& simulation) {
  const Result<std::optional<SensorRange>> range = ParseRange(flags.range);
  if (!range) return tl::unexpected(range.error());
  simulation.range = *range;
  simulation.resolution = flags.resolution;
  if (simulation.range && flags.resolution > simulation.range->high - simulation.range->low) {
    return BadFlag("--resolution is " + NumberText(flags.resolution) + "; it must be no wider than --range");
  }
  const double si = simulation.unit.si;
  SyntheticOptions& synthetic = simulation.synthetic;
  synthetic.noise = flags.noise * si;
  synthetic.noise_correlation = flags.noise_correlation;
  synthetic.noise_freedom = flags.noise_freedom;
  synthetic.resolution = flags.resolution * si;
  if (simulation.range) synthetic.range = SensorRange{simulation.range->low * si, simulation.range->high * si};
  synthetic.start_time = flags.start_time;
  synthetic.duration = flags.duration;
  synthetic.sample_rate = flags.rate;
  synthetic.jitter = flags.jitter;
  synthetic.rows = flags.event_driven ? RowTiming::kEvents : RowTiming::kEven;
  synthetic.time_noise = flags.time_noise;
  synthetic.oversample = static_cast<int>(flags.oversample);
  synthetic.averaging_window = flags.window_s;
  synthetic.seed = flags.seed;
  return {};
}

/// Parses --lose.
Result<std::vector<LostCounts>> ParseLostCounts(const SimulationFlags& flags) {
  constexpr double kMaxCounts = 1e6;
  std::vector<LostCounts> lost;
  for (const std::string& part : Split(flags.lose, ',')) {
    const std::vector<std::string> words = Split(part, ':');
    if (words.size() != 2) return BadFlag("--lose: '" + part + "' must be time:counts");
    const Result<double> time = ParseNumber("--lose", words[0], "a time in s");
    const Result<double> counts = ParseNumber("--lose", words[1], "a whole number of counts");
    if (!time) return tl::unexpected(time.error());
    if (!counts) return tl::unexpected(counts.error());
    if (*counts != std::round(*counts) || std::abs(*counts) > kMaxCounts) {
      return BadFlag("--lose: " + NumberText(*counts) +
                     " counts; it must be a whole number of them, at most a million");
    }
    lost.push_back({*time, static_cast<int>(*counts)});
  }
  if (!lost.empty() && flags.resolution == 0) return BadFlag("--lose needs the size of a count; give --resolution");
  if (const Result<OutputUnit> unit = FindUnit(flags.unit); !lost.empty() && unit && unit->sensor == SensorKind::kArc) {
    return BadFlag("--lose simulates lost counts of an encoder, but with --unit " + flags.unit +
                   " the readings are coordinates of a point; leave one of them out");
  }
  return lost;
}

}  // namespace

Result<Simulation> MakeSimulation(const SimulationFlags& flags, const std::optional<Rig>& rig) {
  RETURN_IF_ERROR(CheckNumbers(flags));
  RETURN_IF_ERROR(CheckEvents(flags));
  RETURN_IF_ERROR(CheckAveraging(flags));
  ASSIGN_OR_RETURN(const OutputUnit unit, FindUnit(flags.unit));
  ASSIGN_OR_RETURN(const MotionModel model, ChooseModel(flags));
  Simulation simulation;
  simulation.unit = unit;
  simulation.synthetic.quantity = unit.quantity;
  simulation.synthetic.sensor.kind = unit.sensor;
  if (unit.sensor == SensorKind::kAcceleration) simulation.synthetic.sensor.gravity = kStandardGravity;
  simulation.synthetic.model = model;
  RETURN_IF_ERROR(ChooseSensor(flags, simulation));
  ASSIGN_OR_RETURN(const std::vector<LostCounts> lost, ParseLostCounts(flags));
  simulation.synthetic.lost_counts = lost;
  RETURN_IF_ERROR(ChooseMotion(flags, rig, simulation));
  RETURN_IF_ERROR(SimulationOfRecording(simulation, 0));
  return simulation;
}

Result<Simulation> SimulationOfRecording(const Simulation& all, int index) {
  Simulation simulation = all;
  SyntheticOptions& synthetic = simulation.synthetic;
  synthetic.seed += static_cast<std::uint64_t>(index);
  if (simulation.scattered.empty()) return simulation;
  // The true values begin with the model's parameters, in order.
  const auto values = ScatterParameters(simulation.scattered, FindOrderedPair(synthetic.model), synthetic.seed);
  if (!values) return Within("--spread", values.error());
  for (std::size_t i = 0; i < values->size(); ++i) simulation.truth[i].second = (*values)[i];
  SetMotion({simulation.truth.begin(), simulation.truth.end()}, simulation.gravity_torque, synthetic);
  return simulation;
}

}  // namespace pendulum
