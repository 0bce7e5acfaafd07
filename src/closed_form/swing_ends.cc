// SPDX-License-Identifier: Apache-2.0
#include "closed_form/swing_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/steady.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The first of the consecutive samples up to `sample` that all lie within `band` of `level`.
Index FirstWithin(const Recording& recording, Index sample, double level, double band) {
  while (sample > 0 && std::abs(recording.value[sample - 1] - level) <= band) --sample;
  return sample;
}

Index LastWithin(const Recording& recording, Index sample, double level, double band) {
  while (sample + 1 < recording.size() && std::abs(recording.value[sample + 1] - level) <= band) ++sample;
  return sample;
}

/// Whether samples [first, last] show one value.
bool IsSteadyBetween(const Recording& recording, const TurningPointTable& table, Index first, Index last) {
  return IsSteady(recording.value.segment(first, last - first + 1),
                  std::max({table.noise, recording.resolution, 1e-2 * table.threshold}));
}

/// The swing begins with the steady part at the end of a hold. If no part is steady, the hand was moving, and the swing
/// begins where the hold ends.
Beginning SteadyPart(const Recording& recording, const TurningPointTable& table, Index first, Index last) {
  constexpr Index kMinSamples = 8;
  // The last samples within the band may follow the release, so only the first 70 % count as held.
  const Index held = first + 7 * (last - first) / 10;
  for (Index begin = first; held - begin >= kMinSamples; begin += (held - begin + 1) / 2) {
    if (IsSteadyBetween(recording, table, begin, held)) return {begin, {WindowBegin::Reason::kHeld}, last + 1};
  }
  return {last, {WindowBegin::Reason::kUnsteadyHold}, last, first, held};
}

/// The hold at the first turning point of a run, if the reading stays near this point for longer than in a swing.
std::optional<Beginning> HoldBefore(const Recording& recording, const TurningPointTable& table, std::size_t turn) {
  const bool rate = recording.quantity == Quantity::kRate;
  // For a rate the hold is at its zero, a quarter period before its first turning point.
  const double level = rate ? table.ZeroAt(turn) : table.points[turn].value;
  const double band = 0.05 * table.Amplitude(turn) + 5 * table.noise + 2 * recording.resolution;
  Index end = table.points[turn].sample;
  if (rate) {
    while (end > 0 && std::abs(recording.value[end] - level) > band) --end;
    if (table.points[turn].time - recording.time[end] > table.half_period) return std::nullopt;
  }
  const Index begin = FirstWithin(recording, end, level, band);
  const double natural = 0.25 * table.half_period * table.Stretch(turn);
  const double dwell = recording.time[LastWithin(recording, end, level, band)] - recording.time[begin];
  if (dwell < (rate ? 1.0 : 2.0) * natural || begin == end) return std::nullopt;
  return SteadyPart(recording, table, begin, LastWithin(recording, end, level, band));
}

/// After turns over the top, or a fall from near the upright, the swing begins at the next turning point. Such a fall
/// contains no information on the release.
std::optional<Beginning> BeginAfterFall(const TurningPointTable& table, std::size_t turn) {
  constexpr double kUpright = 165 * kRadFromDeg;
  constexpr double kOverTheTop = 185 * kRadFromDeg;
  const bool angle = table.quantity == Quantity::kAngle && table.is_calibrated;
  if (!angle || !(table.Amplitude(turn) > kUpright)) return std::nullopt;
  const Index next = table.points[turn + 1].sample;
  if (table.Amplitude(turn) > kOverTheTop) return Beginning{next, {WindowBegin::Reason::kAfterTurns}};
  return Beginning{next, {WindowBegin::Reason::kAfterFall, table.Amplitude(turn) / kRadFromDeg}};
}

/// Fits an oscillation with the period of small swings to samples [first, first + count). Returns its amplitude divided
/// by its standard error.
double AmplitudeOverError(const Recording& recording, const TurningPointTable& table, Index first, Index count) {
  const Eigen::ArrayXd phase =
      kPi / table.half_period * (recording.time.segment(first, count).array() - recording.time[first]);
  Eigen::MatrixX3d basis(count, 3);
  basis << Eigen::ArrayXd::Ones(count), phase.cos(), phase.sin();
  const Eigen::Vector3d c = basis.colPivHouseholderQr().solve(recording.value.segment(first, count));
  // A constant reading shows no noise at all; the threshold of turning points then gives a scale.
  const double noise = std::max({table.noise, 0.3 * recording.resolution, 1e-2 * table.threshold});
  return std::hypot(c[1], c[2]) / (noise * std::sqrt(2.0 / static_cast<double>(count)));
}

/// The last sample at which the reading moves; checks one period at a time from `sample` to `limit`.
Index EndOfMotion(const Recording& recording, const TurningPointTable& table, Index sample, Index limit) {
  constexpr double kMoves = 5;
  constexpr Index kMinSamples = 6;
  Index end = sample;
  while (sample < limit) {
    Index next = sample;
    while (next < limit && recording.time[next] - recording.time[sample] < 2 * table.half_period) ++next;
    if (next - sample < kMinSamples || AmplitudeOverError(recording, table, sample, next - sample) > kMoves) end = next;
    sample = next;
  }
  return end;
}

/// Whether the pendulum was stopped after turning point `last`: the next turning point is missing although there was
/// time for two, and it would have been visible.
bool IsStopped(const Recording& recording, const TurningPointTable& table, std::size_t last, Index limit) {
  if (last == 0) return false;
  const double time_left = recording.time[limit] - table.points[last].time;
  const double next = table.Amplitude(last) - 1.5 * (table.Amplitude(last - 1) - table.Amplitude(last));
  return time_left > 3 * table.half_period * table.Stretch(last) && next > table.threshold + table.Tolerance(last);
}

}  // namespace

Beginning FindBeginning(const Recording& recording, const TurningPointTable& table, const TurningPointRun& run) {
  if (auto after_fall = BeginAfterFall(table, run.first)) return *after_fall;
  if (auto hold = HoldBefore(recording, table, run.first)) return *hold;
  const double before = table.points[run.first].time - recording.time[0];
  const bool near_start = run.first <= 1 && before <= 1.1 * table.half_period * table.Stretch(run.first);
  const bool within =
      std::abs(recording.value[0] - table.ZeroAt(run.first)) <= table.Amplitude(run.first) + table.Tolerance(run.first);
  if (near_start && within) return {0, {WindowBegin::Reason::kInMotion}};
  return {table.points[run.first].sample, {WindowBegin::Reason::kAfterMove}};
}

Ending FindEnding(const Recording& recording, const TurningPointTable& table, const TurningPointRun& run) {
  const Index turn = table.points[run.last].sample;
  // The hand that moves the pendulum afterwards may have held it before, so a standstill does not belong to the swing.
  if (run.last < table.half_swings()) return {turn, {WindowEnd::Reason::kBeforeMove}};
  const Index limit = recording.size() - 1;
  if (IsStopped(recording, table, run.last, limit)) return {turn, {WindowEnd::Reason::kBeforeStop}};
  const Index end = EndOfMotion(recording, table, turn, limit);
  if (recording.time[limit] - recording.time[end] <= 6 * table.half_period)
    return {limit, {WindowEnd::Reason::kEndOfRecording}};
  Index sample = end;
  while (recording.time[sample] - recording.time[end] < 2 * table.half_period) ++sample;
  return {sample, {WindowEnd::Reason::kAtRest, recording.time[end]}};
}

}  // namespace pendulum
