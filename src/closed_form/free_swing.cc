// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/free_swing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/QR>

#include "closed_form/driven_part.h"
#include "closed_form/long_gap.h"
#include "closed_form/swing_ends.h"
#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/classify_half_swings.h"
#include "pendulum/closed_form/low_band.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The amplitude at the end of a motion that decays, divided by that at its start, is less.
constexpr double kDecayed = 0.7;

/// A run of fewer turning points shows no decay.
constexpr std::size_t kMinFreePoints = 6;

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

FreeSwing MakeSwing(const Recording& recording, const TurningPointTable& table, const TurningPointRun& run) {
  FreeSwing swing;
  const Beginning beginning = FindBeginning(recording, table, run);
  const Ending ending = FindEnding(recording, table, run);
  swing.from = recording.time[beginning.sample];
  swing.to = recording.time[ending.sample];
  swing.after_hold = recording.time[std::min(beginning.after_hold, recording.size() - 1)];
  swing.hold_from = recording.time[beginning.hold_first];
  swing.hold_to = recording.time[beginning.hold_last];
  swing.begins = beginning.why;
  swing.ends = ending.why;
  swing.half_period = table.half_period;
  using enum WindowBegin::Reason;
  const bool is_after_fall = beginning.why.reason == kAfterFall || beginning.why.reason == kAfterTurns;
  const std::size_t first = run.first + (is_after_fall ? 1 : 0);  // the fall is no half swing
  for (std::size_t i = run.first; i <= run.last; ++i) {
    swing.amplitude = std::max(swing.amplitude, table.Amplitude(i));
    if (i < first) continue;
    if (i > first) swing.heights.push_back(std::abs(table.points[i].value - table.points[i - 1].value));
    swing.turns.push_back(table.points[i].time);
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

/// A weight for each half swing. Their sums decide what most of a recording shows.
using Weights = std::vector<double>;

Weights EqualWeights(const TurningPointTable& table) {
  Weights weights(table.half_swings(), 1.0);
  return weights;
}

/// Weights by size: duration times the square of the height. Small fast motion then counts little, however long it
/// lasts.
Weights SizeWeights(const TurningPointTable& table) {
  Weights weights;
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    const TurningPoint &from = table.points[i], &to = table.points[i + 1];
    weights.push_back((to.time - from.time) * std::pow(to.value - from.value, 2));
  }
  return weights;
}

/// The sum over half swings [first, last).
double SumOf(const Weights& weights, std::size_t first, std::size_t last) {
  return std::accumulate(weights.begin() + static_cast<std::ptrdiff_t>(first),
                         weights.begin() + static_cast<std::ptrdiff_t>(last), 0.0);
}

/// The half period of small swings of which at least half the weight is longer.
double WeightedHalfPeriod(const TurningPointTable& table, const Weights& weights) {
  std::vector<std::pair<double, double>> durations;  // with weights
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    durations.emplace_back((table.points[i + 1].time - table.points[i].time) / table.Stretch(i), weights[i]);
  }
  std::ranges::sort(durations);
  double left = 0.5 * SumOf(weights, 0, weights.size());
  for (const auto& [duration, weight] : durations) {
    left -= weight;
    if (left <= 0) return duration;
  }
  return durations.back().first;
}

/// Share of the half swings that belong to a rise of the amplitude by at least a tenth over three or more half swings.
/// Skips point 0, which may be the start of the recording.
double RisingShare(const TurningPointTable& table, const Weights& weights) {
  constexpr std::size_t kMinRise = 3;
  double climbing = 0;
  std::size_t low = 1;
  std::size_t high = 1;
  const auto close = [&] {
    const bool climbs = table.Amplitude(high) > 1.1 * table.Amplitude(low) + table.Tolerance(low);
    if (climbs && high >= low + kMinRise) climbing += SumOf(weights, low, high);
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
  return climbing / SumOf(weights, 0, weights.size());
}

/// The error of an amplitude that rises repeatedly. It proposes the last part if this decays to the end.
tl::unexpected<Status> Driven(const Recording& recording, const TurningPointTable& table,
                              const std::vector<TurningPointRun>& runs) {
  const std::string driven = "the amplitude rises repeatedly: the pendulum is driven";
  if (runs.empty() || runs.back().last + 1 != table.points.size()) return NoSwing(driven);
  const std::size_t first = EndOfDrive(table, runs.back()), last = runs.back().last;
  if (first + kMinFreePoints > last + 1 || Decay(table, first, last) > kDecayed) return NoSwing(driven);
  const double time = recording.time[table.points[first].sample];
  const std::string from = "--from " + NumberText(time, 6);
  return WithTry(Error(StatusCode::kFailedPrecondition, driven + "; if the drive ends at " + NumberText(time, 6) +
                                                            " s, " + from + " fits the decay after it"),
                 {from});
}

/// Returns an error if the turning points are not a free swing, a swing if it beats, and otherwise std::nullopt.
Result<std::optional<FreeSwing>> ClassifyOtherMotion(const Recording& recording, const TurningPointTable& table,
                                                     const std::vector<TurningPointRun>& runs, const Weights& weights) {
  constexpr double kMaxRisingShare = 0.2;
  const std::size_t turns = table.points.size();
  const auto weight = [&](const TurningPointRun& run) { return SumOf(weights, run.first, run.last); };
  const auto longest = std::ranges::max_element(runs, {}, weight);
  const std::size_t free = longest == runs.end() ? 0 : longest->last - longest->first + 1;
  // With equal weights, the shares are those of the turning points.
  const double all = SumOf(weights, 0, weights.size()) + weights.front();
  const double share = longest == runs.end() ? 0 : (weight(*longest) + weights[longest->first]) / all;
  const bool climbs = RisingShare(table, weights) > kMaxRisingShare;
  if (!climbs && 2 * share >= 1) {
    if (Decays(table, EndOfDrive(table, *longest), longest->last)) return std::nullopt;
    return Error(StatusCode::kFailedPrecondition, "the amplitude does not decay over " + std::to_string(free - 1) +
                                                      " half swings: the pendulum is driven, or its friction is too "
                                                      "small to see; give --from and --to to fit this window anyway");
  }
  const double largest = std::ranges::max(table.Amplitudes());
  const bool scattered = 3 * share < 1 && (free < kMinFreePoints || table.Amplitude(longest->first) < 0.5 * largest);
  if (!climbs && !scattered) return std::nullopt;
  // A motion that begins near standstill and grows was not released.
  const bool from_standstill = climbs && table.Amplitude(1) < 0.35 * largest;
  if (from_standstill || Decay(table, 0, turns - 1) > kDecayed) {
    if (climbs) return Driven(recording, table, runs);
    return NoSwing("of " + std::to_string(turns) + " turning points no more than " + std::to_string(free) +
                   " in a row belong to a free swing, with equal times between them and decreasing amplitude: the "
                   "pendulum was moved by hand or motor, or held at one angle after another");
  }
  FreeSwing swing = MakeSwing(recording, table, {0, turns - 1});
  swing.has_beats = true;
  return swing;
}

/// Begins each run after the drive that may have kept its amplitude. Returns which of them had one.
std::vector<bool> LeaveOutDrives(const TurningPointTable& table, std::vector<TurningPointRun>& runs) {
  std::vector<bool> had_drive;
  for (TurningPointRun& run : runs) {
    const std::size_t end = EndOfDrive(table, run);
    had_drive.push_back(end > run.first);
    run.first = end;
  }
  return had_drive;
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

/// A pendulum's swing beyond the upright on both sides is impossible; most likely the unit is wrong. The amplitude of a
/// rate is multiplied by half the period and divided by pi, as for a sine. For a pendulum that swings to 176 deg this
/// gives 6 rad.
Result<void> CheckUnit(const TurningPointTable& table) {
  constexpr double kMaxAngle = 3.3, kMaxFromRate = 6;  // rad
  const bool is_rate = table.quantity == Quantity::kRate;
  if (!table.is_calibrated || (table.quantity != Quantity::kAngle && !is_rate)) return {};
  const double typical = Median(table.Amplitudes());
  const double angle = is_rate ? typical * table.half_period / kPi : typical;
  if (angle < (is_rate ? kMaxFromRate : kMaxAngle)) return {};
  const std::string reading = is_rate ? "a rate of " + NumberText(typical, 3) + " rad/s means that the pendulum swings"
                                      : std::string("the reading swings");
  return Error(StatusCode::kFailedPrecondition,
               reading + " by " + NumberText(angle, 3) + " rad (" + NumberText(angle / kRadFromDeg, 3) +
                   " deg) to both sides, but beyond 180 deg a pendulum goes over the top; check the unit of the column "
                   "in the header or in --unit, or give --gravity linear for a spring or wire");
}

Result<std::vector<FreeSwing>> FindAmong(const Recording& recording, const TurningPointTable& table,
                                         const Weights& weights) {
  const std::vector<Verdict> verdicts = ClassifyHalfSwings(recording, table);
  std::vector<TurningPointRun> runs = FreeRuns(table, verdicts);
  ASSIGN_OR_RETURN(const std::optional<FreeSwing> other_motion, ClassifyOtherMotion(recording, table, runs, weights));
  if (other_motion) return std::vector<FreeSwing>{*other_motion};
  const std::vector<bool> after_drive = LeaveOutDrives(table, runs);
  std::vector<FreeSwing> swings;
  const double outside = LargestOutside(table, runs);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    swings.push_back(MakeSwing(recording, table, runs[i]));
    swings.back().amplitude_outside = outside;
    if (after_drive[i]) swings.back().begins = {WindowBegin::Reason::kAfterDrive};
  }
  if (swings.empty()) return NoSwing("there are no two successive half swings that lose amplitude and cross the zero");
  return swings;
}

/// Whether the largest motion is outside all swings.
bool AreSmall(const std::vector<FreeSwing>& swings) {
  constexpr double kLarger = 1.3;
  return std::ranges::all_of(
      swings, [](const FreeSwing& swing) { return swing.amplitude_outside > kLarger * swing.amplitude; });
}

/// The duration of the longest swing [s].
double LongestDuration(const std::vector<FreeSwing>& swings) {
  double longest = 0;
  for (const FreeSwing& swing : swings) longest = std::max(longest, swing.to - swing.from);
  return longest;
}

/// Whether the longest swing is a small part of the motion, as of a vibration that dies away.
bool AreShort(const std::vector<FreeSwing>& swings, const TurningPointTable& table) {
  constexpr double kShort = 0.25;  // of the motion
  return LongestDuration(swings) < kShort * (table.points.back().time - table.points.front().time);
}

/// The swings of a recording in which half swings are weighed by their size.
Result<std::vector<FreeSwing>> FindLarge(const Recording& recording, TurningPointTable table) {
  if (table.points.size() < 3) return NoSwing("there are too few turning points");
  const Weights weights = SizeWeights(table);
  table.half_period = WeightedHalfPeriod(table, weights);
  return FindAmong(recording, table, weights);
}

/// Whether swings are credible although most turning points are not theirs.
bool AreCredible(const Result<std::vector<FreeSwing>>& swings) {
  constexpr std::size_t kMinTurns = 6;
  return swings && !AreSmall(*swings) && std::ranges::none_of(*swings, &FreeSwing::has_beats) &&
         std::ranges::any_of(*swings, [](const FreeSwing& swing) { return swing.turns.size() >= kMinTurns; });
}

/// In the low band, a sudden change of the motion begins earlier and ends later by half the length of the mean.
void KeepAway(double length, FreeSwing& swing) {
  if (swing.begins.reason == WindowBegin::Reason::kAfterMove) swing.from += length;
  const bool is_touched =
      swing.ends.reason == WindowEnd::Reason::kBeforeMove || swing.ends.reason == WindowEnd::Reason::kBeforeStop;
  if (is_touched) swing.to -= length;
}

/// The swings that smaller or faster motion hides; std::nullopt if there are none.
std::optional<std::vector<FreeSwing>> FindHidden(const Recording& recording, const TurningPointTable& table) {
  constexpr double kLongest = 8, kStep = 1.5;  // times the fastest period
  const double fastest = FastestPeriod(table);
  Result<std::vector<FreeSwing>> swings = FindLarge(recording, table);
  double length = 0;
  for (double next = fastest; next < kLongest * fastest && !AreCredible(swings); next *= kStep) {
    length = next;
    const Recording low = LowBand(recording, length);
    swings = FindLarge(low, FindAllTurningPoints(low));
    // The low band keeps at least 41 % of the swing's amplitude.
    if (swings && swings->front().half_period < length) return std::nullopt;
  }
  if (!AreCredible(swings)) return std::nullopt;
  for (FreeSwing& swing : *swings) {
    KeepAway(length, swing);
    LeaveOutVibration(recording, table.noise, std::max(length, fastest), swing);
  }
  return *std::move(swings);
}

/// The swings of a recording without long gaps.
Result<std::vector<FreeSwing>> FindWithoutGaps(const Recording& recording, const TurningPointTable& table,
                                               bool is_spring) {
  if (table.points.size() < 3) {
    const Result<TurningPointTable> found = FindTurningPoints(recording);
    return tl::unexpected(found ? Status{StatusCode::kFailedPrecondition, "no turning points"} : found.error());
  }
  if (!is_spring) {
    RETURN_IF_ERROR(CheckUnit(table));
  }
  Result<std::vector<FreeSwing>> swings = FindAmong(recording, table, EqualWeights(table));
  constexpr double kMuchLonger = 2;
  const bool is_large = swings && !AreSmall(*swings);
  if (is_large && !AreShort(*swings, table)) return swings;
  std::optional<std::vector<FreeSwing>> hidden = FindHidden(recording, table);
  if (hidden && (!is_large || LongestDuration(*hidden) > kMuchLonger * LongestDuration(*swings))) {
    return *std::move(hidden);
  }
  return swings;
}

/// The swings of the parts between long gaps. If none has a swing, the error is that of the longest part.
Result<std::vector<FreeSwing>> FindBetweenGaps(const Recording& recording, std::vector<Index> gaps, bool is_spring) {
  const Index end = recording.size() - 1;
  gaps.push_back(end);
  std::vector<FreeSwing> swings;
  tl::unexpected<Status> error = NoSwing("the readings between gaps are too few");
  Index longest = 0;
  std::size_t i = 0;
  for (Index first = 0; const Index last : gaps) {
    const Result<Recording> part =
        SelectWindow(recording, recording.time[std::exchange(first, last + 1)], recording.time[last]);
    if (!part) continue;  // too few samples
    Result<std::vector<FreeSwing>> found = FindWithoutGaps(*part, FindAllTurningPoints(*part), is_spring);
    if (!found && part->size() > longest) error = tl::unexpected(found.error());
    longest = std::max(longest, part->size());
    if (found) std::ranges::move(*found, std::back_inserter(swings));
    for (; i < swings.size(); ++i) {
      FreeSwing& swing = swings[i];
      if (part->time[0] > recording.time[0] && swing.begins.reason == WindowBegin::Reason::kInMotion) {
        swing.begins = {WindowBegin::Reason::kAfterGap};
      }
      if (last < end && swing.ends.reason == WindowEnd::Reason::kEndOfRecording) {
        swing.ends = {WindowEnd::Reason::kBeforeGap, recording.time[last], recording.time[last + 1]};
      }
    }
  }
  if (swings.empty()) return error;
  return swings;
}

}  // namespace

Result<std::vector<FreeSwing>> FindFreeSwings(const Recording& recording, bool is_spring) {
  if (HasTurningPointView(recording)) {
    Result<std::vector<FreeSwing>> swings = FindFreeSwings(TurningPointView(recording), is_spring);
    if (swings && recording.quantity == Quantity::kAcceleration) RemoveHolds(*swings);
    return swings;
  }
  const TurningPointTable table = FindAllTurningPoints(recording);
  std::vector<Index> gaps = FindLongGaps(recording, table.half_period);
  if (gaps.empty()) return FindWithoutGaps(recording, table, is_spring);
  return FindBetweenGaps(recording, std::move(gaps), is_spring);
}

}  // namespace pendulum
