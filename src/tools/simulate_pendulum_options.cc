// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/nesting.h"
#include "tools/command_line.h"

namespace pendulum {
namespace {

constexpr std::array kUnits = {
    OutputUnit{"deg", "angle_deg", Quantity::kAngle, kRadFromDeg},
    OutputUnit{"rad", "angle_rad", Quantity::kAngle, 1.0},
    OutputUnit{"deg_s", "gyro_deg_s", Quantity::kRate, kRadFromDeg},
    OutputUnit{"rad_s", "gyro_rad_s", Quantity::kRate, 1.0},
};

Result<OutputUnit> FindUnit(const std::string& name) {
  for (const OutputUnit& unit : kUnits) {
    if (unit.name == name) return unit;
  }
  return BadFlag("--unit is '" + name + "'; it must be deg, rad, deg_s or rad_s");
}

Result<MotionModel> ChooseModel(const SimulateFlags& flags) {
  Result<MotionModel> model = FindMotionModel(flags.model);
  if (!model) return BadFlag("--model: " + model.error().message);
  if (flags.gravity.empty()) return model;
  if (flags.gravity != "sin" && flags.gravity != "linear") {
    return BadFlag("--gravity is '" + flags.gravity + "'; it must be sin or linear");
  }
  const Gravity gravity = flags.gravity == "sin" ? Gravity::kSine : Gravity::kLinear;
  if (model->name == "linear" && gravity == Gravity::kSine) {
    return BadFlag("--gravity sin contradicts --model linear; its friction with sine gravity is --model viscous");
  }
  model->gravity = gravity;
  return model;
}

/// Every parameter that --set may give, in the order of the truth file.
std::vector<ParameterInfo> SettableParameters(const MotionModel& model, Quantity quantity) {
  std::vector<ParameterInfo> infos = PhysicalParameters(model);
  infos.insert(infos.end(), {kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate});
  infos.push_back(quantity == Quantity::kAngle ? kZeroAngle : kRateBias);
  return infos;
}

Result<StartKind> ChooseStart(const ParameterValues& values) {
  const auto given = [&](const ParameterInfo& info) { return values.contains(info.name); };
  const bool release = given(kReleaseAngle) || given(kReleaseTime);
  const bool moving = given(kInitialAngle) || given(kInitialRate);
  if (release && moving) {
    return BadFlag("--set gives two starts; keep release_angle and release_time, or initial_angle and initial_rate");
  }
  if (given(kReleaseAngle) && given(kReleaseTime)) return StartKind::kRelease;
  if (given(kInitialAngle) && given(kInitialRate)) return StartKind::kMoving;
  return BadFlag("--set lacks the start: give release_angle and release_time, or initial_angle and initial_rate");
}

/// Fills in what --set may leave out: inertia from the rig, no friction, no offset.
Result<void> Complete(const std::vector<ParameterInfo>& infos, const std::optional<Rig>& rig, StartKind start,
                      ParameterValues& values) {
  const std::string inertia(kInertia.name);
  if (rig && rig->inertia) values.try_emplace(inertia, rig->inertia->value);
  if (!values.contains(inertia)) return BadFlag("--set lacks inertia, and no rig gives one");
  if (values[inertia] <= 0) {
    return BadFlag("--set: inertia is " + NumberText(values[inertia]) + "; it must be positive");
  }
  const std::array<std::string_view, 2> other_start = start == StartKind::kRelease
                                                          ? std::array{kInitialAngle.name, kInitialRate.name}
                                                          : std::array{kReleaseAngle.name, kReleaseTime.name};
  for (const ParameterInfo& info : infos) {
    if (std::ranges::find(other_start, info.name) == other_start.end()) values.try_emplace(std::string(info.name), 0.0);
  }
  return {};
}

double ValueOr0(const ParameterValues& values, const ParameterInfo& info) {
  const auto found = values.find(info.name);
  return found == values.end() ? 0.0 : found->second;
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
  synthetic.zero = ValueOr0(values, synthetic.quantity == Quantity::kAngle ? kZeroAngle : kRateBias);
}

/// What --spread asks for; `infos` are those that --set may name, `values` are complete.
Result<void> ChooseSpread(const std::string& spread, std::vector<ParameterInfo> infos, const ParameterValues& values,
                          SimulateOptions& options) {
  if (spread.empty()) return {};
  const std::vector<ParameterInfo> bounded = infos;
  for (ParameterInfo& info : infos) info.lower = 0, info.upper = kUnbounded;  // a standard deviation's own
  const Result<ParameterValues> std_devs = ParseSettings("--spread", spread, options.synthetic.model.name, infos);
  if (!std_devs) return tl::unexpected(std_devs.error());
  for (const auto& [name, std_dev] : *std_devs) {
    if (values.contains(name)) continue;
    return BadFlag("--spread: " + name + " belongs to a start other than that of --set; leave it out");
  }
  for (const ParameterInfo& info : bounded) {
    if (!values.contains(info.name)) continue;
    options.scattered.push_back({info, ValueOr0(values, info), ValueOr0(*std_devs, info)});
  }
  return {};
}

/// The motion that --set asks of the model already chosen: start and parameters, in `options` and in its truth.
Result<void> ChooseMotion(const SimulateFlags& flags, const std::optional<Rig>& rig, SimulateOptions& options) {
  SyntheticOptions& synthetic = options.synthetic;
  const std::vector<ParameterInfo> infos = SettableParameters(synthetic.model, synthetic.quantity);
  Result<ParameterValues> values = ParseSettings("--set", flags.set, synthetic.model.name, infos);
  if (!values) return tl::unexpected(values.error());
  const Result<StartKind> start = ChooseStart(*values);
  if (!start) return tl::unexpected(start.error());
  synthetic.start = *start;
  if (Result<void> complete = Complete(infos, rig, *start, *values); !complete) return complete;
  options.gravity_torque = rig ? rig->gravity_torque.value : 1.0;
  SetMotion(*values, options.gravity_torque, synthetic);
  for (const ParameterInfo& info : infos) {
    if (const auto found = values->find(info.name); found != values->end()) options.truth.emplace_back(*found);
  }
  return ChooseSpread(flags.spread, infos, *values, options);
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

/// A number that a flag gives, and the least it may be.
struct NumberFlag {
  std::string_view name;
  double value;
  bool may_be_0;
};

Result<void> CheckNoiseLaw(const SimulateFlags& flags) {
  const double correlation = flags.noise_correlation;
  if (!(std::abs(correlation) < 1)) {
    return BadFlag("--noise_correlation is " + NumberText(correlation) + "; it must be between -1 and 1");
  }
  const double freedom = flags.noise_freedom;
  if (freedom == 0 || (std::isfinite(freedom) && freedom > 2)) return {};
  return BadFlag("--noise_freedom is " + NumberText(freedom) + "; it must be 0 or above 2");
}

Result<void> CheckNumbers(const SimulateFlags& flags) {
  const std::array numbers = {
      NumberFlag{"--duration", flags.duration, false},    NumberFlag{"--rate", flags.rate, false},
      NumberFlag{"--jitter", flags.jitter, true},         NumberFlag{"--noise", flags.noise, true},
      NumberFlag{"--resolution", flags.resolution, true},
  };
  for (const NumberFlag& number : numbers) {
    if (std::isfinite(number.value) && (number.value > 0 || (number.may_be_0 && number.value == 0))) continue;
    return BadFlag(std::string(number.name) + " is " + NumberText(number.value) + "; it must be " +
                   (number.may_be_0 ? "0 or more" : "positive"));
  }
  return CheckNoiseLaw(flags);
}

/// A plan goes to standard output and is of one recording, which is not made.
Result<void> CheckPlan(const SimulateFlags& flags) {
  const std::string makes_none = " contradicts --plan, which makes no recording; leave out one of them";
  if (!flags.out.empty()) return BadFlag("--out" + makes_none);
  if (!flags.truth.empty()) return BadFlag("--truth" + makes_none);
  if (flags.count != 1) return BadFlag("--count" + makes_none);
  if (!flags.spread.empty()) return BadFlag("--spread" + makes_none);
  if (!flags.manifest.empty()) return BadFlag("--manifest" + makes_none);
  if (flags.noise != 0 || flags.resolution != 0) return {};
  return BadFlag("--plan needs --noise or --resolution: without either nothing limits what a recording tells");
}

Result<void> CheckFiles(const SimulateFlags& flags) {
  if (!flags.positional.empty()) return BadFlag("'" + flags.positional.front() + "' belongs to no flag");
  if (flags.plan) return CheckPlan(flags);
  if (flags.out.empty()) return BadFlag("--out is missing: the file for the recording, or - for standard output");
  if (flags.count < 1) return BadFlag("--count is " + std::to_string(flags.count) + "; it must be at least 1");
  if (flags.count > 1 && (IsStandardOutput(flags.out) || IsStandardOutput(flags.truth))) {
    return BadFlag("--count " + std::to_string(flags.count) + " needs files; standard output takes one recording");
  }
  if (!flags.manifest.empty() && IsStandardOutput(flags.out)) {
    return BadFlag("--manifest lists files; give --out a file instead of " + flags.out);
  }
  return {};
}

Result<void> CheckThreads(const SimulateFlags& flags) {
  constexpr int kMost = 1024;
  if (flags.threads >= 0 && flags.threads <= kMost) return {};
  return BadFlag("--threads is " + std::to_string(flags.threads) + "; it must be 0 to " + std::to_string(kMost));
}

void CopyFiles(const SimulateFlags& flags, SimulateOptions& options) {
  options.plan = flags.plan;
  options.count = flags.count;
  options.threads = flags.threads;
  options.rig_path = flags.rig;
  options.out = flags.out;
  options.truth_out = flags.truth;
  options.manifest_out = flags.manifest;
}

/// Sensor and sampling; noise, resolution and range become SI.
Result<void> ChooseSensor(const SimulateFlags& flags, SimulateOptions& options) {
  const Result<std::optional<SensorRange>> range = ParseRange(flags.range);
  if (!range) return tl::unexpected(range.error());
  options.range = *range;
  options.resolution = flags.resolution;
  if (options.range && flags.resolution > options.range->high - options.range->low) {
    return BadFlag("--resolution is " + NumberText(flags.resolution) + "; it must be no wider than --range");
  }
  const double si = options.unit.si;
  SyntheticOptions& synthetic = options.synthetic;
  synthetic.noise = flags.noise * si;
  synthetic.noise_correlation = flags.noise_correlation;
  synthetic.noise_freedom = flags.noise_freedom;
  synthetic.resolution = flags.resolution * si;
  if (options.range) synthetic.range = SensorRange{options.range->low * si, options.range->high * si};
  synthetic.start_time = flags.start_time;
  synthetic.duration = flags.duration;
  synthetic.sample_rate = flags.rate;
  synthetic.jitter = flags.jitter;
  synthetic.seed = flags.seed;
  return {};
}

}  // namespace

Result<SimulateOptions> MakeSimulateOptions(const SimulateFlags& flags, const std::optional<Rig>& rig) {
  for (const auto check : {CheckFiles, CheckThreads, CheckNumbers}) {
    if (Result<void> checked = check(flags); !checked) return tl::unexpected(checked.error());
  }
  const Result<OutputUnit> unit = FindUnit(flags.unit);
  if (!unit) return tl::unexpected(unit.error());
  const Result<MotionModel> model = ChooseModel(flags);
  if (!model) return tl::unexpected(model.error());
  SimulateOptions options;
  options.unit = *unit;
  options.synthetic.quantity = unit->quantity;
  options.synthetic.model = *model;
  CopyFiles(flags, options);
  if (Result<void> chosen = ChooseSensor(flags, options); !chosen) return tl::unexpected(chosen.error());
  if (Result<void> chosen = ChooseMotion(flags, rig, options); !chosen) return tl::unexpected(chosen.error());
  if (const auto first = OptionsOfRecording(options, 0); !first) return tl::unexpected(first.error());
  return options;
}

Result<SimulateOptions> OptionsOfRecording(SimulateOptions options, int index) {
  SyntheticOptions& synthetic = options.synthetic;
  synthetic.seed += static_cast<std::uint64_t>(index);
  if (options.scattered.empty()) return options;
  // The truth begins with the model's parameters, in their order.
  const auto values = ScatterParameters(options.scattered, OrderOf(synthetic.model), synthetic.seed);
  if (!values) return BadFlag("--spread: " + values.error().message);
  for (std::size_t i = 0; i < values->size(); ++i) options.truth[i].second = (*values)[i];
  SetMotion({options.truth.begin(), options.truth.end()}, options.gravity_torque, synthetic);
  return options;
}

std::vector<NamedFile> SimulateOptions::Outputs(int index) const {
  std::vector<NamedFile> outputs = {{"--out", NumberedPath(out, index, count)}};
  if (!truth_out.empty()) outputs.push_back({"--truth", NumberedPath(truth_out, index, count)});
  return outputs;
}

}  // namespace pendulum
