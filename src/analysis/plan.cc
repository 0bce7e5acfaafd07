// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "pendulum/analysis/cramer_rao.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

constexpr std::array kAmplitudeFactors = {0.25, 0.5, 1.0, 2.0};
constexpr std::array kDurationFactors = {0.5, 1.0, 2.0, 4.0};
constexpr std::array kOtherFactors = {0.25, 1.0, 4.0};

/// Time [s] and angle [rad] of the turning points from the release, or from the first one of a moving start, until
/// `end` [s]. The trajectory has a rate of exactly 0 at turning points.
std::vector<TurningPoint> TurningPoints(const SyntheticOptions& run, double end) {
  const bool released = run.start == StartKind::kRelease;
  const Start<double> start{run.start, released ? run.release_time : run.start_time,
                            released ? run.release_angle : run.initial_angle, released ? 0.0 : run.initial_rate};
  TraceOptions options;
  options.end = end;
  options.tolerance = 1e-12;
  std::vector<TurningPoint> turns;
  FrictionModels::Visit(run.model.friction, [&]<typename F>() {
    Pendulum<F, double> pendulum{run.model.gravity, run.parameters[0], {}};
    std::copy(run.parameters.begin() + 1, run.parameters.end(), pendulum.friction.begin());
    TraceTrajectory(pendulum, start, options, [&](const Segment<double>& segment) {
      if (segment.order > 0 && segment.angle[1] == 0) turns.push_back({segment.start, segment.angle[0]});
    });
  });
  return turns;
}

/// The largest |θ| without friction [rad]; std::nullopt if the pendulum goes over the top.
std::optional<double> Amplitude(const SyntheticOptions& run) {
  if (run.start == StartKind::kRelease) return std::abs(run.release_angle);
  const double rate = std::sqrt(run.parameters[0]) * run.initial_rate;  // in units of ω0
  const Gravity gravity = run.model.gravity;
  const double chord = std::hypot(gravity.Chord(run.initial_angle), rate);
  if (std::abs(run.initial_angle) >= gravity.top() || chord >= gravity.Chord(gravity.top())) return std::nullopt;
  return gravity.AngleOfChord(chord);
}

/// Scales the swing from one amplitude to another, at the same phase. Both amplitudes are positive.
SyntheticOptions WithAmplitude(SyntheticOptions run, double from, double to) {
  if (run.start == StartKind::kRelease) {
    run.release_angle = std::copysign(to, run.release_angle);
  } else {
    const Gravity gravity = run.model.gravity;
    const double factor = gravity.Chord(to) / gravity.Chord(from);
    run.initial_angle = gravity.AngleOfChord(factor * gravity.Chord(run.initial_angle));
    run.initial_rate *= factor;
  }
  return run;
}

void AddAmplitudes(const SyntheticOptions& base, std::vector<PlanRow>& rows) {
  const std::optional<double> amplitude = Amplitude(base);
  if (!amplitude || *amplitude == 0) return;
  const std::string_view name = base.start == StartKind::kRelease ? kReleaseAngle.name : "amplitude";
  for (const double factor : kAmplitudeFactors) {
    const double value = factor == 1 ? *amplitude : std::min(factor * *amplitude, kLargestPlannedAmplitude);
    if (factor > 1 && value <= *amplitude) continue;
    const SyntheticOptions run = factor == 1 ? base : WithAmplitude(base, *amplitude, value);
    rows.push_back({name, "rad", value, factor == 1, {}, {}, {}, run});
  }
}

/// Adds rows with multiples of one of the options.
void AddMultiples(const SyntheticOptions& base, std::string_view name, std::string_view unit,
                  double SyntheticOptions::*number, std::span<const double> factors, std::vector<PlanRow>& rows) {
  for (const double factor : factors) {
    SyntheticOptions run = base;
    run.*number *= factor;
    rows.push_back({name, unit, run.*number, factor == 1, {}, {}, {}, run});
  }
}

/// The rows without results.
std::vector<PlanRow> Rows(const SyntheticOptions& base) {
  std::vector<PlanRow> rows;
  AddAmplitudes(base, rows);
  AddMultiples(base, "duration", "s", &SyntheticOptions::duration, kDurationFactors, rows);
  AddMultiples(base, "rate", "Hz", &SyntheticOptions::sample_rate, kOtherFactors, rows);
  const std::string_view unit = base.quantity == Quantity::kAngle ? "rad" : "rad/s";
  if (base.resolution > 0) {
    AddMultiples(base, "resolution", unit, &SyntheticOptions::resolution, kOtherFactors, rows);
  }
  return rows;
}

/// The standard deviation of a reading's rounding (Widrow & Kollár, Quantization Noise, 2008).
double NoiseOfLevels(double resolution) { return resolution / std::sqrt(12.0); }

/// Noise-free readings repeat their rounding error throughout a hold, so the hold counts as one reading.
std::vector<std::optional<double>> StdErrors(SyntheticOptions run, const Eigen::VectorXd& time) {
  if (run.noise > 0) return CramerRaoBounds(run, time);
  run.noise = NoiseOfLevels(run.resolution);
  run.resolution = run.noise_correlation = run.noise_freedom = 0;
  Eigen::Index first = 0;
  while (run.start == StartKind::kRelease && first + 1 < time.size() && time[first + 1] <= run.release_time) ++first;
  return CramerRaoBounds(run, time.tail(time.size() - first));
}

void Predict(PlanRow& row) {
  const SyntheticOptions& run = row.run;
  const Result<Recording> recording = SimulateRecording(run);
  row.std_errors.resize(run.parameters.size() + 3);
  if (!recording) {
    row.reason = recording.error().message();
    return;
  }
  row.std_errors = StdErrors(run, recording->time);
  row.linear_bias = LinearInertiaBias(run, recording->time[recording->size() - 1]);
}

bool BiasExceedsError(const SyntheticOptions& run, const Eigen::VectorXd& time) {
  const std::optional<double> bias = LinearInertiaBias(run, time[time.size() - 1]);
  if (!bias) return false;
  const std::optional<double> error = StdErrors(run, time).front();
  return error && std::abs(*bias) > *error / run.parameters.front();
}

/// Halves the amplitude from the largest one until the bias no longer exceeds the error, then bisects within that
/// factor of 2.
std::optional<double> AmplitudeOfEqualBias(const SyntheticOptions& base, const Eigen::VectorXd& time) {
  constexpr double kSmallest = 1e-6;  // rad
  constexpr double kAccuracy = 1e-4;  // relative
  const std::optional<double> amplitude = Amplitude(base);
  if (!amplitude || *amplitude == 0) return std::nullopt;
  const auto exceeds = [&](double at) { return BiasExceedsError(WithAmplitude(base, *amplitude, at), time); };
  double high = kLargestPlannedAmplitude;
  if (!exceeds(high)) return std::nullopt;
  double low = 0.5 * high;
  for (; exceeds(low); low *= 0.5) {
    if (low < kSmallest) return std::nullopt;
    high = low;
  }
  while (high - low > kAccuracy * low) {
    const double middle = std::sqrt(low * high);
    (exceeds(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace

std::optional<double> LinearInertiaBias(const SyntheticOptions& run, double end) {
  const std::vector<TurningPoint> turns = TurningPoints(run, end);
  if (turns.size() < 3) return std::nullopt;
  const std::size_t periods = (turns.size() - 1) / 2;
  const TurningPoint &first = turns.front(), &last = turns[2 * periods];
  // After turns over the top, the angle no longer counts from the lowest position of the swing.
  if (std::abs(first.value) >= run.model.gravity.top()) return std::nullopt;
  const auto n = static_cast<double>(periods);
  const double damped_frequency = 2 * kPi * n / (last.time - first.time);
  const double decrement = std::log(first.value / last.value) / n;
  const double damping_ratio = decrement / std::hypot(2 * kPi, decrement);
  const double inertia = (1 - damping_ratio * damping_ratio) / (damped_frequency * damped_frequency);
  return inertia / run.parameters.front() - 1;
}

Result<Plan> MakePlan(const SyntheticOptions& base) {
  if (base.noise == 0 && base.resolution == 0) {
    return Error(StatusCode::kInvalidArgument,
                 "noise and resolution are both 0, so the standard errors would be 0; give one of them");
  }
  ASSIGN_OR_RETURN(const Recording recording, SimulateRecording(base));
  Plan plan;
  plan.parameters = ParametersOf(base);
  plan.truth = TrueParameters(base);
  plan.physical = base.parameters.size();
  if (base.noise == 0) plan.noise_of_levels = NoiseOfLevels(base.resolution);
  plan.rows = Rows(base);
  for (PlanRow& row : plan.rows) Predict(row);
  plan.amplitude_of_equal_bias = AmplitudeOfEqualBias(base, recording.time);
  return plan;
}

}  // namespace pendulum
