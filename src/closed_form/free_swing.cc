// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/free_swing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <Eigen/QR>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/extrema.h"
#include "pendulum/closed_form/period.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The turning points of a recording and what they say about each half swing; half swing i goes from turn i to i + 1.
struct HalfSwings {
  const Recording& recording;
  double noise = 0;
  double threshold = 0;
  std::vector<Extremum> turns = {};
  std::vector<double> zero = {};       // at each turn
  std::vector<double> amplitude = {};  // of each turn
  double half_period = 0;              // s, of a small swing

  std::size_t size() const { return turns.size() - 1; }

  /// What a half swing from this turn takes over one of a small swing.
  double Stretch(std::size_t turn) const {
    constexpr double kNearTop = 3.0;
    if (recording.quantity == Quantity::kRate) return 1;
    return PeriodRatio(std::min(amplitude[turn], kNearTop));
  }

  /// A rise or a band that noise explains.
  double Tolerance(std::size_t turn) const { return 0.05 * amplitude[turn] + 3 * noise + 2 * recording.resolution; }
};

/// The zero near each turn: the median of (e_{i-1} + 2 e_i + e_{i+1}) / 4 over four turns to either side, so that it
/// may drift.
std::vector<double> LocalZeros(const std::vector<Extremum>& turns) {
  constexpr std::ptrdiff_t kNeighbours = 4;
  const auto last = static_cast<std::ptrdiff_t>(turns.size()) - 2;
  std::vector<double> zeros;
  for (std::ptrdiff_t i = 0; i <= last + 1; ++i) {
    const std::ptrdiff_t centre =
        std::clamp<std::ptrdiff_t>(i, std::min(1 + kNeighbours, last), std::max<std::ptrdiff_t>(last - kNeighbours, 1));
    std::vector<double> near;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(centre - kNeighbours, 1);
         j <= std::min(centre + kNeighbours, last); ++j) {
      near.push_back(0.25 * (turns[j - 1].value + 2 * turns[j].value + turns[j + 1].value));
    }
    zeros.push_back(Median(std::move(near)));
  }
  return zeros;
}

HalfSwings Tabulate(const Recording& recording) {
  HalfSwings halves{recording};
  halves.noise = SuccessiveDifferenceNoise(recording);
  halves.threshold = TurningThreshold(recording, halves.noise);
  halves.turns = FindTurns(recording, halves.threshold);
  if (halves.turns.size() < 3) return halves;
  halves.zero = LocalZeros(halves.turns);
  std::vector<double> durations;
  for (std::size_t i = 0; i < halves.turns.size(); ++i) {
    halves.amplitude.push_back(std::abs(halves.turns[i].value - halves.zero[i]));
  }
  for (std::size_t i = 0; i < halves.size(); ++i) {
    durations.push_back((halves.turns[i + 1].time - halves.turns[i].time) / halves.Stretch(i));
  }
  halves.half_period = Median(std::move(durations));
  return halves;
}

enum class Verdict { kFree, kFreeAfterHold, kGains, kIrregular };

/// Whether the samples leave out so much of a half swing that turning points may be missing in it.
bool HasGap(const HalfSwings& halves, std::size_t i) {
  constexpr double kLongest = 0.4;
  const Eigen::VectorXd& time = halves.recording.time;
  for (Index k = halves.turns[i].sample; k < halves.turns[i + 1].sample; ++k) {
    if (time[k + 1] - time[k] > kLongest * halves.half_period) return true;
  }
  return false;
}

/// Duration of half swing i over that of a small one.
double RelativeDuration(const HalfSwings& halves, std::size_t i) {
  const double stretch = 0.5 * (halves.Stretch(i) + halves.Stretch(i + 1));
  return (halves.turns[i + 1].time - halves.turns[i].time) / (halves.half_period * stretch);
}

/// How much longer half swing i is than the median of its neighbours, and what it may be by their scatter.
struct Slip {
  double deviation = 0;
  double limit = kUnlimited;
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();
};

Slip SlipOf(const HalfSwings& halves, std::size_t i) {
  constexpr std::size_t kNeighbours = 6;
  constexpr double kLeast = 0.025;
  constexpr double kDeviations = 10;
  std::vector<double> near;
  for (std::size_t j = i - std::min(i, kNeighbours); j < std::min(i + kNeighbours + 1, halves.size()); ++j) {
    if (j != i) near.push_back(RelativeDuration(halves, j));
  }
  if (near.size() < kNeighbours) return {};
  const double typical = Median(near);
  for (double& duration : near) duration = std::abs(duration - typical);
  return {RelativeDuration(halves, i) - typical, std::max(kLeast, kDeviations * Median(std::move(near)))};
}

/// Whether time slips in half swing i: samples were lost, or the pendulum was touched. A turning point that is found a
/// little late makes the next half swing as much shorter, and is none.
bool Slips(const HalfSwings& halves, std::size_t i) {
  const Slip slip = SlipOf(halves, i);
  const auto stays = [&](double neighbour) { return std::abs(slip.deviation + neighbour) > slip.limit; };
  return stays(0) && (i == 0 || stays(SlipOf(halves, i - 1).deviation)) &&
         (i + 1 == halves.size() || stays(SlipOf(halves, i + 1).deviation));
}

/// Whether the amplitude grows in half swing i and stays so: one turning point alone may be an outlier, and at the
/// edges of a gap there are two that are none.
bool Gains(const HalfSwings& halves, std::size_t i, bool near_gap) {
  const auto amplitude = halves.amplitude.begin();
  const auto at = static_cast<std::ptrdiff_t>(i);
  const auto turns = static_cast<std::ptrdiff_t>(halves.turns.size());
  const std::ptrdiff_t follow = near_gap ? 4 : 3;
  const double before = *std::max_element(amplitude + std::max<std::ptrdiff_t>(at - 1, 0), amplitude + at + 1);
  const double after = *std::min_element(amplitude + at + 1, amplitude + std::min(at + follow, turns));
  return after > before + halves.Tolerance(i);
}

/// Whether half swing i loses far more amplitude than those around it: it was braked.
bool IsBraked(const HalfSwings& halves, std::size_t i) {
  constexpr std::size_t kNeighbours = 4;
  constexpr double kFarMore = 2.5;
  std::vector<double> losses;
  for (std::size_t j = i - std::min(i, kNeighbours); j < std::min(i + kNeighbours + 1, halves.size()); ++j) {
    if (j != i) losses.push_back(halves.amplitude[j] - halves.amplitude[j + 1]);
  }
  if (losses.size() < kNeighbours) return false;
  const double typical = std::max(Median(std::move(losses)), 0.0);
  // One turning point alone may be an outlier.
  const double before = i > 0 ? std::min(halves.amplitude[i - 1], halves.amplitude[i]) : halves.amplitude[i];
  const double after = i + 2 < halves.turns.size() ? std::max(halves.amplitude[i + 1], halves.amplitude[i + 2])
                                                   : halves.amplitude[i + 1];
  return before - after > kFarMore * typical + halves.Tolerance(i);
}

Verdict Judge(const HalfSwings& halves, std::size_t i) {
  const bool near_gap =
      HasGap(halves, i) || (i > 0 && HasGap(halves, i - 1)) || (i + 1 < halves.size() && HasGap(halves, i + 1));
  if (near_gap) return Gains(halves, i, true) ? Verdict::kGains : Verdict::kFree;
  const double zero = 0.5 * (halves.zero[i] + halves.zero[i + 1]);
  if ((halves.turns[i].value > zero) == (halves.turns[i + 1].value > zero)) return Verdict::kIrregular;
  if (Gains(halves, i, false)) return Verdict::kGains;
  constexpr double kShortest = 0.5;
  constexpr double kLongest = 1.5;
  const double duration = RelativeDuration(halves, i);
  if (duration > kLongest) return Verdict::kFreeAfterHold;
  // Where a hand has raised it the half swing may begin with a hold, and is longer by the end of that.
  const bool may_be_held = i == 0 || Gains(halves, i - 1, false);
  const bool irregular = duration < kShortest || (!may_be_held && Slips(halves, i)) || (i > 0 && IsBraked(halves, i));
  return irregular ? Verdict::kIrregular : Verdict::kFree;
}

/// A run of free half swings: turns [first, last].
struct Run {
  std::size_t first;
  std::size_t last;
};

std::vector<Run> FreeRuns(const HalfSwings& halves, const std::vector<Verdict>& verdicts) {
  constexpr std::size_t kFewest = 2;
  std::vector<Run> runs;
  std::size_t first = 0;
  const auto close = [&](std::size_t last) {
    if (last >= first + kFewest) runs.push_back({first, last});
  };
  for (std::size_t i = 0; i < halves.size(); ++i) {
    const bool free = verdicts[i] == Verdict::kFree || (verdicts[i] == Verdict::kFreeAfterHold);
    if (verdicts[i] == Verdict::kFreeAfterHold && i > first) {
      close(i);
      first = i;
    }
    if (free) continue;
    close(i);
    first = i + 1;
  }
  close(halves.size());
  return runs;
}

/// The first of the samples up to `sample` that all read within `band` of `level`.
Index FirstWithin(const Recording& recording, Index sample, double level, double band) {
  while (sample > 0 && std::abs(recording.value[sample - 1] - level) <= band) --sample;
  return sample;
}

Index LastWithin(const Recording& recording, Index sample, double level, double band) {
  while (sample + 1 < recording.size() && std::abs(recording.value[sample + 1] - level) <= band) ++sample;
  return sample;
}

/// How a swing begins.
struct Beginning {
  Index sample;
  std::string why;
};

/// Whether samples [first, last] read one value: no creep beyond three standard deviations of noise, no more scatter
/// than twice the noise.
bool IsSteady(const HalfSwings& halves, Index first, Index last) {
  const Recording& recording = halves.recording;
  const Index count = last - first + 1;
  Eigen::MatrixX2d basis(count, 2);
  basis << Eigen::ArrayXd::Ones(count), Eigen::ArrayXd::LinSpaced(count, 0, 1);
  const Eigen::VectorXd value = recording.value.segment(first, count);
  const Eigen::Vector2d line = basis.colPivHouseholderQr().solve(value);
  const double scatter = (value - basis * line).norm() / std::sqrt(static_cast<double>(count));
  const double noise = std::max({halves.noise, recording.resolution, 1e-2 * halves.threshold});
  return std::abs(line[1]) < 3 * noise && scatter < 2 * noise;
}

/// The end of a hold that is steady, or the moment it ends: a hand that moves holds nothing.
Beginning SteadyPart(const HalfSwings& halves, Index first, Index last) {
  constexpr Index kFewest = 8;
  // The release lies somewhere within the band too.
  const Index held = first + 7 * (last - first) / 10;
  for (Index begin = first; held - begin >= kFewest; begin += (held - begin + 1) / 2) {
    if (IsSteady(halves, begin, held)) return {begin, "held, then released"};
  }
  return {last, "after the release: the hold before it is not steady"};
}

/// The hold that the first turn of a run lies in, if it is one: the reading stays near it for longer than a swing does.
std::optional<Beginning> HoldBefore(const HalfSwings& halves, std::size_t turn) {
  const Recording& recording = halves.recording;
  const bool rate = recording.quantity == Quantity::kRate;
  // A rate is held at its zero, a quarter period before its first turn.
  const double level = rate ? halves.zero[turn] : halves.turns[turn].value;
  const double band = 0.05 * halves.amplitude[turn] + 5 * halves.noise + 2 * recording.resolution;
  Index end = halves.turns[turn].sample;
  if (rate) {
    while (end > 0 && std::abs(recording.value[end] - level) > band) --end;
    if (halves.turns[turn].time - recording.time[end] > halves.half_period) return std::nullopt;
  }
  const Index begin = FirstWithin(recording, end, level, band);
  const double natural = 0.25 * halves.half_period * halves.Stretch(turn);
  const double dwell = recording.time[LastWithin(recording, end, level, band)] - recording.time[begin];
  if (dwell < (rate ? 1.0 : 2.0) * natural || begin == end) return std::nullopt;
  return SteadyPart(halves, begin, LastWithin(recording, end, level, band));
}

/// After a fall from near the upright: the next turning point.
std::optional<Beginning> AfterTheFall(const HalfSwings& halves, std::size_t turn) {
  constexpr double kUpright = 165 * kRadFromDeg;
  if (halves.recording.quantity != Quantity::kAngle || !(halves.amplitude[turn] > kUpright)) return std::nullopt;
  return Beginning{halves.turns[turn + 1].sample,
                   "after the fall from " + NumberText(halves.amplitude[turn] / kRadFromDeg, 3) +
                       " deg, where the smallest push decides when it falls and the release tells nothing"};
}

Beginning Begin(const HalfSwings& halves, const Run& run) {
  const Recording& recording = halves.recording;
  if (auto fallen = AfterTheFall(halves, run.first)) return *fallen;
  if (auto hold = HoldBefore(halves, run.first)) return *hold;
  const double before = halves.turns[run.first].time - recording.time[0];
  const bool near_start = run.first <= 1 && before <= 1.1 * halves.half_period * halves.Stretch(run.first);
  const bool within = std::abs(recording.value[0] - halves.zero[run.first]) <=
                      halves.amplitude[run.first] + halves.Tolerance(run.first);
  if (near_start && within) return {0, "the recording begins in motion"};
  return {halves.turns[run.first].sample, "the first turning point after the pendulum was moved otherwise"};
}

/// Amplitude of the oscillation of one small-swing period in the samples [first, first + count), over its standard
/// error.
double AmplitudeOverError(const HalfSwings& halves, Index first, Index count) {
  const Recording& recording = halves.recording;
  const Eigen::ArrayXd phase =
      kPi / halves.half_period * (recording.time.segment(first, count).array() - recording.time[first]);
  Eigen::MatrixX3d basis(count, 3);
  basis << Eigen::ArrayXd::Ones(count), phase.cos(), phase.sin();
  const Eigen::Vector3d c = basis.colPivHouseholderQr().solve(recording.value.segment(first, count));
  // A reading that stands still has no noise at all; what a turn must stand out by gives a scale.
  const double noise = std::max({halves.noise, 0.3 * recording.resolution, 1e-2 * halves.threshold});
  return std::hypot(c[1], c[2]) / (noise * std::sqrt(2.0 / static_cast<double>(count)));
}

/// The sample up to which the reading moves, looking one period at a time from `sample` to `limit`.
Index EndOfMotion(const HalfSwings& halves, Index sample, Index limit) {
  constexpr double kMoves = 5;
  constexpr Index kFewest = 6;
  const Recording& recording = halves.recording;
  Index end = sample;
  while (sample < limit) {
    Index next = sample;
    while (next < limit && recording.time[next] - recording.time[sample] < 2 * halves.half_period) ++next;
    if (next - sample < kFewest || AmplitudeOverError(halves, sample, next - sample) > kMoves) end = next;
    sample = next;
  }
  return end;
}

/// Whether the swing goes on after turn `last` as little as no friction would have it: the next turning point is
/// missing though time was left for two.
bool IsStopped(const HalfSwings& halves, std::size_t last, Index limit) {
  if (last == 0) return false;
  const double time_left = halves.recording.time[limit] - halves.turns[last].time;
  const double next = halves.amplitude[last] - 1.5 * (halves.amplitude[last - 1] - halves.amplitude[last]);
  return time_left > 3 * halves.half_period * halves.Stretch(last) && next > halves.threshold + halves.Tolerance(last);
}

/// How a swing ends.
struct Ending {
  Index sample;
  std::string why;
};

Ending End(const HalfSwings& halves, const Run& run) {
  const Recording& recording = halves.recording;
  const Index turn = halves.turns[run.last].sample;
  const bool disturbed = run.last < halves.size();
  Index limit = recording.size() - 1;
  if (disturbed) {
    // A rest before what comes next belongs to the swing.
    limit = halves.turns[run.last + 1].sample;
    const Index rest = std::min(turn + (limit - turn) / 2, limit);
    const double band = 0.05 * halves.amplitude[run.last] + 5 * halves.noise + 2 * recording.resolution;
    const double pause = recording.time[limit] - recording.time[turn];
    if (pause < 3 * halves.half_period * halves.Stretch(run.last)) {
      return {turn, "the last turning point before the pendulum is moved otherwise"};
    }
    limit = LastWithin(recording, rest, recording.value[rest], band);
  }
  if (IsStopped(halves, run.last, limit)) return {turn, "the last turning point before the pendulum is stopped"};
  const Index end = EndOfMotion(halves, turn, limit);
  const double rest = recording.time[limit] - recording.time[end];
  if (rest <= 6 * halves.half_period) {
    return {limit, disturbed ? "before the pendulum is moved otherwise" : "the end of the recording"};
  }
  Index sample = end;
  while (recording.time[sample] - recording.time[end] < 2 * halves.half_period) ++sample;
  return {sample, "at rest from about " + NumberText(recording.time[end], 4) + " s"};
}

FreeSwing MakeSwing(const HalfSwings& halves, const Run& run) {
  FreeSwing swing;
  const Beginning beginning = Begin(halves, run);
  const Ending ending = End(halves, run);
  swing.from = halves.recording.time[beginning.sample];
  swing.to = halves.recording.time[ending.sample];
  swing.begins = beginning.why;
  swing.ends = ending.why;
  swing.half_period = halves.half_period;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    swing.turns.push_back(halves.turns[i].time);
    swing.amplitude = std::max(swing.amplitude, halves.amplitude[i]);
  }
  return swing;
}

tl::unexpected<Status> NoSwing(const std::string& sentence) {
  return Error(StatusCode::kFailedPrecondition, sentence + "; choose a window of free swing with --from and --to");
}

double MedianOf(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return Median(std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count)));
}

/// Median amplitude of the last third of turns [first, last] over that of the first.
double Decay(const HalfSwings& halves, std::size_t first, std::size_t last) {
  const std::size_t third = std::max<std::size_t>((last - first + 1) / 3, 1);
  return MedianOf(halves.amplitude, last + 1 - third, third) / MedianOf(halves.amplitude, first, third);
}

/// Whether the amplitude goes down over turns [first, last]: clearly, or by three of its standard errors. Where the
/// recording begins is no turning point.
bool Decays(const HalfSwings& halves, std::size_t first, std::size_t last) {
  first = std::max<std::size_t>(first, 1);
  constexpr double kClearly = 0.95;
  constexpr Index kFewest = 6;
  const auto count = static_cast<Index>(last - first + 1);
  if (count < kFewest || Decay(halves, first, last) < kClearly) return true;
  const Eigen::VectorXd amplitude = Eigen::Map<const Eigen::VectorXd>(halves.amplitude.data() + first, count);
  Eigen::MatrixX3d basis(count, 3);
  const Eigen::ArrayXd index = Eigen::ArrayXd::LinSpaced(count, -1, 1);
  // Turns to either side differ by what the zero is off.
  basis << Eigen::ArrayXd::Ones(count), index,
      Eigen::ArrayXd::NullaryExpr(count, [](Index i) { return i % 2 ? 1 : -1; });
  const Eigen::Vector3d c = basis.colPivHouseholderQr().solve(amplitude);
  const double scatter = (amplitude - basis * c).norm() / std::sqrt(static_cast<double>(count - 3));
  return c[1] < -3 * scatter / index.matrix().norm() && c[1] < 0;
}

/// Share of the half swings in which the amplitude climbs, by at least a tenth over three half swings or more. Where
/// the recording begins is no turning point.
double ShareOfClimbs(const HalfSwings& halves) {
  constexpr std::size_t kFewest = 3;
  std::size_t climbing = 0;
  std::size_t low = 1;
  std::size_t high = 1;
  const auto close = [&] {
    const bool climbs = halves.amplitude[high] > 1.1 * halves.amplitude[low] + halves.Tolerance(low);
    if (climbs && high >= low + kFewest) climbing += high - low;
  };
  for (std::size_t i = 2; i < halves.turns.size(); ++i) {
    if (halves.amplitude[i] >= halves.amplitude[high]) {
      high = i;
    } else if (halves.amplitude[i] < 0.95 * halves.amplitude[high] || halves.amplitude[i] < halves.amplitude[low]) {
      close();
      low = high = i;
    }
  }
  close();
  return static_cast<double>(climbing) / static_cast<double>(halves.size());
}

/// What is no free swing though it turns again and again: an error, or a swing that beats.
Result<std::optional<FreeSwing>> Unfree(const HalfSwings& halves, const std::vector<Run>& runs) {
  constexpr double kMostClimbs = 0.2;
  constexpr double kDecayed = 0.7;
  constexpr std::size_t kFewest = 6;
  const std::size_t turns = halves.turns.size();
  const auto longest = std::ranges::max_element(runs, {}, [](const Run& run) { return run.last - run.first; });
  const std::size_t free = longest == runs.end() ? 0 : longest->last - longest->first + 1;
  const bool climbs = ShareOfClimbs(halves) > kMostClimbs;
  if (!climbs && 2 * free >= turns) {
    if (Decays(halves, longest->first, longest->last)) return std::nullopt;
    return NoSwing("the amplitude does not decay over " + std::to_string(free - 1) +
                   " half swings: the pendulum is driven, or its friction is too small to see");
  }
  const double largest = *std::ranges::max_element(halves.amplitude);
  const bool scattered = 3 * free < turns && (free < kFewest || halves.amplitude[longest->first] < 0.5 * largest);
  if (!climbs && !scattered) return std::nullopt;
  if (Decay(halves, 0, turns - 1) > kDecayed) {
    if (climbs) return NoSwing("the amplitude climbs again and again and does not decay: the pendulum is driven");
    return NoSwing("of " + std::to_string(turns) + " turning points no more than " + std::to_string(free) +
                   " follow each other as a free swing's do, in equal times and with less and "
                   "less amplitude: the pendulum was moved by hand or motor, or held at one angle after another");
  }
  FreeSwing swing = MakeSwing(halves, {0, turns - 1});
  swing.beats = true;
  return swing;
}

}  // namespace

Result<std::vector<FreeSwing>> FindFreeSwings(const Recording& recording) {
  const HalfSwings halves = Tabulate(recording);
  if (halves.turns.size() < 3) {
    const Result<std::vector<Extremum>> extrema = FindExtrema(recording);
    return tl::unexpected(extrema ? Status{StatusCode::kFailedPrecondition, "no turning points"} : extrema.error());
  }
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < halves.size(); ++i) verdicts.push_back(Judge(halves, i));
  const std::vector<Run> runs = FreeRuns(halves, verdicts);
  const Result<std::optional<FreeSwing>> unfree = Unfree(halves, runs);
  if (!unfree) return tl::unexpected(unfree.error());
  if (*unfree) return std::vector<FreeSwing>{**unfree};
  std::vector<FreeSwing> swings;
  for (const Run& run : runs) swings.push_back(MakeSwing(halves, run));
  if (swings.empty()) return NoSwing("no two half swings follow each other that lose amplitude and cross the zero");
  return swings;
}

}  // namespace pendulum
