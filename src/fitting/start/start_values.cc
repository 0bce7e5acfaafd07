// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/start_values.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/QR>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/energy_balance.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Properties of the held part of a recording.
struct Hold {
  double angle = 0;           ///< rad, release angle
  double release_time = 0;    ///< s, on the recording's clock
  double latest_release = 0;  ///< s, on the recording's clock
};

/// The recording relative to its zero, with its time scale.
struct Centred {
  const Recording& recording;
  const TurningPointTable& table;
  Gravity gravity;
  double natural_frequency;

  double Reading(Index i) const { return recording.value[i] - table.zero.value; }
  double FirstAmplitude() const { return table.Amplitude(table.Runs().front().first); }
  double Period(double amplitude) const { return 2 * kPi / natural_frequency * gravity.PeriodRatio(amplitude); }
  /// The first sample from `from` on whose sign differs from `sign`; N if there is none.
  Index FirstOnOtherSide(Index from, double sign) const {
    while (from < recording.size() && Reading(from) * sign >= 0) ++from;
    return from;
  }
};

/// Mean reading and largest distance from it over the samples [0, count).
std::pair<double, double> MeanAndSpread(const Centred& data, Index count) {
  const auto held = data.recording.value.head(count).array() - data.table.zero.value;
  const double mean = held.mean();
  return {mean, (held - mean).abs().maxCoeff()};
}

/// Index of the first sample at or after a time.
Index SampleAt(const Recording& recording, double time) {
  return std::lower_bound(recording.time.begin(), recording.time.end(), time) - recording.time.begin();
}

/// An instant at which the pendulum certainly falls. For an angle it is the first zero crossing, a quarter period after
/// the release; for a rate it is the first turn, half a period after the release.
struct Fall {
  double time;
  double periods;    // from the release to this instant
  double amplitude;  // rad, signed release angle
};

std::optional<Fall> FirstFall(const Centred& data) {
  const Recording& recording = data.recording;
  const bool is_rate = recording.quantity == Quantity::kRate;
  Index first = 0;
  if (is_rate) {
    const double half_peak = 0.5 * data.FirstAmplitude();
    while (first < recording.size() && std::abs(data.Reading(first)) < half_peak) ++first;
    if (first == recording.size()) return std::nullopt;
  }
  const double sign = data.Reading(first) > 0 ? 1 : -1;
  const Index after = data.FirstOnOtherSide(first, sign);
  if (after == recording.size() || after == 0) return std::nullopt;
  const double y0 = data.Reading(after - 1);
  const double y1 = data.Reading(after);
  const double step = recording.time[after] - recording.time[after - 1];
  const double time = recording.time[after - 1] + step * y0 / (y0 - y1);
  const double level = is_rate ? data.FirstAmplitude() : std::abs(data.Reading(0));
  const double amplitude = AngleAmplitude(recording.quantity, level, data.natural_frequency, data.gravity);
  return Fall{time, is_rate ? 0.5 : 0.25, is_rate ? -sign * amplitude : sign * amplitude};
}

/// The held part at the start, if there is one. The release time is calculated from the first fall. Before the release,
/// for at least a tenth of a period, the reading must stay within 5 % of the amplitude plus five standard deviations of
/// the noise. If `is_requested` is true, any samples before the release are accepted.
std::optional<Hold> FindHold(const Centred& data, bool is_requested) {
  const std::optional<Fall> fall = FirstFall(data);
  if (!fall) return std::nullopt;
  const Recording& recording = data.recording;
  const double release = fall->time - fall->periods * data.Period(fall->amplitude);
  const Index held = SampleAt(recording, release);
  constexpr Index kMinHeld = 3;
  const bool is_short = release - recording.time[0] < 0.1 * data.Period(0) || held < kMinHeld;
  if (held < 1 || (is_short && !is_requested)) return std::nullopt;
  // Strong friction makes the release appear later than it was, so only the first part of the hold is used.
  const Index certainly_held = std::max<Index>(7 * held / 10, 1);
  const auto [mean, spread] = MeanAndSpread(data, certainly_held);
  const double level = recording.quantity == Quantity::kAngle ? std::abs(mean) : data.FirstAmplitude();
  const double band = 0.05 * level + 5 * data.table.noise + 2 * recording.resolution;
  if (spread > band && !is_requested) return std::nullopt;
  // A pushed pendulum is not released: the held angle must be close to the amplitude of the first swing.
  const bool is_push = recording.quantity == Quantity::kAngle && level < 0.7 * data.FirstAmplitude();
  if (is_push && !is_requested) return std::nullopt;
  Index moving = SampleAt(recording, fall->time) - 1;
  while (moving > certainly_held && std::abs(data.Reading(moving - 1) - mean) > band) --moving;
  return Hold{recording.quantity == Quantity::kAngle ? mean : fall->amplitude, release, recording.time[moving]};
}

/// Reading and its slope at the first sample, from a parabola through the first sixth of a period (at least five
/// samples).
std::pair<double, double> InitialReading(const Centred& data) {
  const Recording& recording = data.recording;
  const Index count =
      std::clamp<Index>(SampleAt(recording, recording.time[0] + data.Period(0) / 6), 5, recording.size());
  const Eigen::ArrayXd t = recording.time.head(count).array() - recording.time[0];
  Eigen::MatrixX3d basis(count, 3);
  basis << Eigen::ArrayXd::Ones(count), t, t.square();
  const Eigen::VectorXd reading = recording.value.head(count).array() - data.table.zero.value;
  const Eigen::Vector3d c = basis.colPivHouseholderQr().solve(reading);
  return {c[0], c[1]};
}

/// Angle and rate at the first sample of a recording that begins in motion. For a rate sensor, the slope gives the sine
/// of the angle; the difference between the rate and its next peak gives the cosine.
std::pair<double, double> InitialState(const Centred& data) {
  const auto [reading, slope] = InitialReading(data);
  if (data.recording.quantity == Quantity::kAngle) return {reading, slope};
  const double square = data.natural_frequency * data.natural_frequency;
  const double torque = -slope / square;  // θ'' = -ω0² g(θ)
  const double peak = data.FirstAmplitude();
  const double lost = (peak * peak - reading * reading) / (2 * square);  // kinetic energy lost since the bottom
  return {data.gravity.AngleAt(torque, lost), reading};
}

}  // namespace

/// A held part gives the release angle (its mean) and the release time: a quarter period before the first crossing, or
/// half a period before the first turn of a rate. Otherwise a parabola through the first samples gives angle and rate.
Result<StartValues> EstimateStartValues(const Recording& recording, const MotionModel& model,
                                        std::optional<StartKind> choice) {
  ASSIGN_OR_RETURN(const TurningPointTable table, FindTurningPoints(recording));
  ASSIGN_OR_RETURN(const double frequency, NaturalFrequency(recording, table, model.gravity));
  StartValues values;
  values.natural_frequency = frequency;
  const double inertia = 1 / (values.natural_frequency * values.natural_frequency);
  if (!(inertia > 1e-30 && inertia < 1e30)) {
    return Error(StatusCode::kFailedPrecondition, "the period is " + NumberText(2 * kPi / values.natural_frequency, 3) +
                                                      " s, which is impossible for a pendulum; check the unit of time");
  }
  values.amplitude = AngleAmplitude(table.quantity, table.LargestAmplitude(), values.natural_frequency, model.gravity);
  values.parameters = {inertia};
  values.other_balances = BalanceEnergy(model, table, values.natural_frequency);
  values.energy_balance = values.other_balances.front();
  values.other_balances.erase(values.other_balances.begin());
  const std::vector<double> friction = FrictionFrom(values.energy_balance);
  values.parameters.insert(values.parameters.end(), friction.begin(), friction.end());

  const Centred data{recording, table, model.gravity, values.natural_frequency};
  const std::optional<Hold> hold =
      choice == StartKind::kMoving ? std::nullopt : FindHold(data, choice == StartKind::kRelease);
  if (choice == StartKind::kRelease && !hold) {
    return Error(StatusCode::kFailedPrecondition,
                 "the recording does not begin with a hold: the first swing shows that the release was before the "
                 "first sample; use --start moving");
  }
  if (hold) {
    values.start = StartKind::kRelease;
    values.latest_release = hold->latest_release - recording.time[0];
    const double release = std::min(hold->release_time - recording.time[0], values.latest_release);
    values.short_hold = release < 0.5 * data.Period(0);
    values.parameters.insert(values.parameters.end(), {hold->angle, release});
  } else {
    const auto [angle, rate] = InitialState(data);
    values.parameters.insert(values.parameters.end(), {angle, rate});
  }
  values.parameters.push_back(table.zero.value);
  return values;
}

}  // namespace pendulum
