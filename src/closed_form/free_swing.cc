// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/free_swing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/QR>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/classify_half_swings.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The runs of free half swings.
std::vector<TurningPointRun> FreeRuns(const TurningPointTable& table, const std::vector<Verdict>& verdicts) {
  constexpr std::size_t kMinHalfSwings = 2;
  std::vector<TurningPointRun> runs;
  std::size_t first = 0;
  const auto close = [&](std::size_t last) {
    if (last >= first + kMinHalfSwings) runs.push_back({first, last});
  };
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    const bool free = verdicts[i] == Verdict::kFree || (verdicts[i] == Verdict::kFreeAfterHold);
    if (verdicts[i] == Verdict::kFreeAfterHold && i > first) {
      close(i);
      first = i;
    }
    if (free) continue;
    close(i);
    first = i + 1;
  }
  close(table.half_swings());
  return runs;
}

/// The first of the consecutive samples up to `sample` that all lie within `band` of `level`.
Index FirstWithin(const Recording& recording, Index sample, double level, double band) {
  while (sample > 0 && std::abs(recording.value[sample - 1] - level) <= band) --sample;
  return sample;
}

Index LastWithin(const Recording& recording, Index sample, double level, double band) {
  while (sample + 1 < recording.size() && std::abs(recording.value[sample + 1] - level) <= band) ++sample;
  return sample;
}

/// Where and why a swing begins.
struct Beginning {
  Index sample;
  WindowBegin why;
  Index after_hold = sample;
};

/// Whether samples [first, last] show one value: drift below three standard deviations of the noise, and scatter below
/// twice the noise.
bool IsSteady(const Recording& recording, const TurningPointTable& table, Index first, Index last) {
  const Index count = last - first + 1;
  Eigen::MatrixX2d basis(count, 2);
  basis << Eigen::ArrayXd::Ones(count), Eigen::ArrayXd::LinSpaced(count, 0, 1);
  const Eigen::VectorXd value = recording.value.segment(first, count);
  const Eigen::Vector2d line = basis.colPivHouseholderQr().solve(value);
  const double scatter = (value - basis * line).norm() / std::sqrt(static_cast<double>(count));
  const double noise = std::max({table.noise, recording.resolution, 1e-2 * table.threshold});
  return std::abs(line[1]) < 3 * noise && scatter < 2 * noise;
}

/// The swing begins with the steady part at the end of a hold. If no part is steady, the hand was moving, and the swing
/// begins where the hold ends.
Beginning SteadyPart(const Recording& recording, const TurningPointTable& table, Index first, Index last) {
  constexpr Index kMinSamples = 8;
  // The last samples within the band may follow the release, so only the first 70 % count as held.
  const Index held = first + 7 * (last - first) / 10;
  for (Index begin = first; held - begin >= kMinSamples; begin += (held - begin + 1) / 2) {
    if (IsSteady(recording, table, begin, held)) return {begin, {WindowBegin::Reason::kHeld}, last + 1};
  }
  return {last, {WindowBegin::Reason::kUnsteadyHold}};
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

/// Where and why a swing ends.
struct Ending {
  Index sample;
  WindowEnd why;
};

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

FreeSwing MakeSwing(const Recording& recording, const TurningPointTable& table, const TurningPointRun& run) {
  FreeSwing swing;
  const Beginning beginning = FindBeginning(recording, table, run);
  const Ending ending = FindEnding(recording, table, run);
  swing.from = recording.time[beginning.sample];
  swing.to = recording.time[ending.sample];
  swing.after_hold = recording.time[std::min(beginning.after_hold, recording.size() - 1)];
  swing.begins = beginning.why;
  swing.ends = ending.why;
  swing.half_period = table.half_period;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    swing.turns.push_back(table.points[i].time);
    swing.amplitude = std::max(swing.amplitude, table.Amplitude(i));
  }
  return swing;
}

/// An acceleration jumps at the release, and no sample gives the instant of the release. The hold is therefore left
/// out.
void RemoveHolds(std::vector<FreeSwing>& swings) {
  for (FreeSwing& swing : swings) {
    if (swing.begins.reason != WindowBegin::Reason::kHeld) continue;
    swing.from = swing.after_hold;
    swing.begins = {WindowBegin::Reason::kAccelerationJump};
  }
}

tl::unexpected<Status> NoSwing(const std::string& sentence) {
  return Error(StatusCode::kFailedPrecondition, sentence + "; choose a window of free swing with --from and --to");
}

double MedianOf(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return Median(std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count)));
}

/// Median amplitude of the last third of turning points [first, last], divided by that of the first third.
double Decay(const TurningPointTable& table, std::size_t first, std::size_t last) {
  const std::size_t third = std::max<std::size_t>((last - first + 1) / 3, 1);
  const std::vector<double> amplitude = table.Amplitudes();
  return MedianOf(amplitude, last + 1 - third, third) / MedianOf(amplitude, first, third);
}

/// Whether the amplitude decreases over turning points [first, last], either clearly or by three standard errors. Skips
/// point 0, which may be the start of the recording.
bool Decays(const TurningPointTable& table, std::size_t first, std::size_t last) {
  first = std::max<std::size_t>(first, 1);
  constexpr double kClearly = 0.95;
  constexpr Index kMinPoints = 6;
  const auto count = static_cast<Index>(last - first + 1);
  if (count < kMinPoints || Decay(table, first, last) < kClearly) return true;
  const auto amplitude_at = [&](Index i) { return table.Amplitude(first + static_cast<std::size_t>(i)); };
  const Eigen::VectorXd amplitude = Eigen::VectorXd::NullaryExpr(count, amplitude_at);
  Eigen::MatrixX3d basis(count, 3);
  const Eigen::ArrayXd index = Eigen::ArrayXd::LinSpaced(count, -1, 1);
  // An error of the zero makes the amplitudes on both sides differ.
  basis << Eigen::ArrayXd::Ones(count), index,
      Eigen::ArrayXd::NullaryExpr(count, [](Index i) { return i % 2 ? 1 : -1; });
  const Eigen::Vector3d c = basis.colPivHouseholderQr().solve(amplitude);
  const double scatter = (amplitude - basis * c).norm() / std::sqrt(static_cast<double>(count - 3));
  return c[1] < -3 * scatter / index.matrix().norm() && c[1] < 0;
}

/// Share of the half swings that belong to a rise of the amplitude by at least a tenth over three or more half swings.
/// Skips point 0, which may be the start of the recording.
double RisingShare(const TurningPointTable& table) {
  constexpr std::size_t kMinRise = 3;
  std::size_t climbing = 0;
  std::size_t low = 1;
  std::size_t high = 1;
  const auto close = [&] {
    const bool climbs = table.Amplitude(high) > 1.1 * table.Amplitude(low) + table.Tolerance(low);
    if (climbs && high >= low + kMinRise) climbing += high - low;
  };
  for (std::size_t i = 2; i < table.points.size(); ++i) {
    if (table.Amplitude(i) >= table.Amplitude(high)) {
      high = i;
    } else if (table.Amplitude(i) < 0.95 * table.Amplitude(high) || table.Amplitude(i) < table.Amplitude(low)) {
      close();
      low = high = i;
    }
  }
  close();
  return static_cast<double>(climbing) / static_cast<double>(table.half_swings());
}

/// Returns an error if the turning points are not a free swing, a swing if it beats, and otherwise std::nullopt.
Result<std::optional<FreeSwing>> ClassifyOtherMotion(const Recording& recording, const TurningPointTable& table,
                                                     const std::vector<TurningPointRun>& runs) {
  constexpr double kMaxRisingShare = 0.2;
  constexpr double kDecayed = 0.7;
  constexpr std::size_t kMinFreePoints = 6;
  const std::size_t turns = table.points.size();
  const auto longest =
      std::ranges::max_element(runs, {}, [](const TurningPointRun& run) { return run.last - run.first; });
  const std::size_t free = longest == runs.end() ? 0 : longest->last - longest->first + 1;
  const bool climbs = RisingShare(table) > kMaxRisingShare;
  if (!climbs && 2 * free >= turns) {
    if (Decays(table, longest->first, longest->last)) return std::nullopt;
    return Error(StatusCode::kFailedPrecondition, "the amplitude does not decay over " + std::to_string(free - 1) +
                                                      " half swings: the pendulum is driven, or its friction is too "
                                                      "small to see; give --from and --to to fit this window anyway");
  }
  const double largest = std::ranges::max(table.Amplitudes());
  const bool scattered = 3 * free < turns && (free < kMinFreePoints || table.Amplitude(longest->first) < 0.5 * largest);
  if (!climbs && !scattered) return std::nullopt;
  // A motion that begins near standstill and grows was not released.
  const bool from_standstill = climbs && table.Amplitude(1) < 0.35 * largest;
  if (from_standstill || Decay(table, 0, turns - 1) > kDecayed) {
    if (climbs) return NoSwing("the amplitude rises repeatedly: the pendulum is driven");
    return NoSwing("of " + std::to_string(turns) + " turning points no more than " + std::to_string(free) +
                   " in a row belong to a free swing, with equal times between them and decreasing amplitude: the "
                   "pendulum was moved by hand or motor, or held at one angle after another");
  }
  FreeSwing swing = MakeSwing(recording, table, {0, turns - 1});
  swing.has_beats = true;
  return swing;
}

/// The largest amplitude of turning points outside all runs. Runs are in time order.
double LargestOutside(const TurningPointTable& table, const std::vector<TurningPointRun>& runs) {
  double largest = 0;
  auto run = runs.begin();
  for (std::size_t i = 1; i < table.points.size(); ++i) {
    while (run != runs.end() && run->last < i) ++run;
    const bool inside = run != runs.end() && i >= run->first;
    if (!inside) largest = std::max(largest, table.Amplitude(i));
  }
  return largest;
}

/// A pendulum's swing beyond the upright on both sides is impossible; most likely the unit is wrong.
Result<void> CheckUnit(const TurningPointTable& table) {
  constexpr double kMaxAngle = 3.3;  // rad
  const bool angle = table.quantity == Quantity::kAngle && table.is_calibrated;
  const double typical = Median(table.Amplitudes());
  if (!angle || typical < kMaxAngle) return {};
  return Error(StatusCode::kFailedPrecondition,
               "the reading swings by " + NumberText(typical, 3) + " rad (" + NumberText(typical / kRadFromDeg, 3) +
                   " deg) to both sides, but beyond 180 deg a pendulum goes over the "
                   "top; check the unit of the column in the header or in --unit, or give "
                   "--gravity linear for a spring or wire");
}

}  // namespace

Result<std::vector<FreeSwing>> FindFreeSwings(const Recording& recording, bool is_spring) {
  if (HasTurningPointView(recording)) {
    Result<std::vector<FreeSwing>> swings = FindFreeSwings(TurningPointView(recording), is_spring);
    if (swings && recording.quantity == Quantity::kAcceleration) RemoveHolds(*swings);
    return swings;
  }
  const TurningPointTable table = FindAllTurningPoints(recording);
  if (table.points.size() < 3) {
    const Result<TurningPointTable> found = FindTurningPoints(recording);
    return tl::unexpected(found ? Status{StatusCode::kFailedPrecondition, "no turning points"} : found.error());
  }
  if (!is_spring) {
    if (const Result<void> unit = CheckUnit(table); !unit) return tl::unexpected(unit.error());
  }
  const std::vector<Verdict> verdicts = ClassifyHalfSwings(recording, table);
  const std::vector<TurningPointRun> runs = FreeRuns(table, verdicts);
  const Result<std::optional<FreeSwing>> other_motion = ClassifyOtherMotion(recording, table, runs);
  if (!other_motion) return tl::unexpected(other_motion.error());
  if (*other_motion) return std::vector<FreeSwing>{**other_motion};
  std::vector<FreeSwing> swings;
  const double outside = LargestOutside(table, runs);
  for (const TurningPointRun& run : runs) {
    swings.push_back(MakeSwing(recording, table, run));
    swings.back().amplitude_outside = outside;
  }
  if (swings.empty()) return NoSwing("there are no two successive half swings that lose amplitude and cross the zero");
  return swings;
}

}  // namespace pendulum
