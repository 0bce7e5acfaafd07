// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pendulum/base/median.h"
#include "pendulum/closed_form/period.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The zero near each turning point: the median of (e_{i-1} + 2 e_i + e_{i+1}) / 4 over four turning points on either
/// side, so that the zero may drift.
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

/// Whether samples are missing for such a large part of half swing i that turning points may be missing.
bool HasGap(const TurningPointTable& table, std::size_t i) {
  constexpr double kLongest = 0.4;
  const Eigen::VectorXd& time = table.recording.time;
  for (Index k = table.turns[i].sample; k < table.turns[i + 1].sample; ++k) {
    if (time[k + 1] - time[k] > kLongest * table.half_period) return true;
  }
  return false;
}

/// Duration of half swing i, divided by that of a small one.
double RelativeDuration(const TurningPointTable& table, std::size_t i) {
  const double stretch = 0.5 * (table.Stretch(i) + table.Stretch(i + 1));
  return (table.turns[i + 1].time - table.turns[i].time) / (table.half_period * stretch);
}

/// How much longer half swing i is than the median of its neighbours, and the limit that follows from their scatter.
struct Slip {
  double deviation = 0;
  double limit = kUnlimited;
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();
};

Slip SlipOf(const TurningPointTable& table, std::size_t i) {
  constexpr std::size_t kNeighbours = 6;
  constexpr double kMinSlip = 0.025;
  // With more half swings, the largest deviation by chance is larger.
  const double deviations = 6 + 2 * std::log(static_cast<double>(table.half_swings()));
  std::vector<double> near;
  for (std::size_t j = i - std::min(i, kNeighbours); j < std::min(i + kNeighbours + 1, table.half_swings()); ++j) {
    if (j != i) near.push_back(RelativeDuration(table, j));
  }
  if (near.size() < kNeighbours) return {};
  const double typical = Median(near);
  for (double& duration : near) duration = std::abs(duration - typical);
  return {RelativeDuration(table, i) - typical, std::max(kMinSlip, deviations * Median(std::move(near)))};
}

/// Whether time slips in half swing i: samples were lost, or the pendulum was touched. If a turning point is merely
/// located late, the next half swing is shorter by the same amount; that is not a slip. The last half swing has no
/// successor to check. Its turning point counts only if it stands out, because before a rest its time is uncertain.
bool HasTimeSlip(const TurningPointTable& table, std::size_t i) {
  const Slip slip = SlipOf(table, i);
  const auto stays = [&](double neighbour) { return std::abs(slip.deviation + neighbour) > slip.limit; };
  if (!stays(0) || (i > 0 && !stays(SlipOf(table, i - 1).deviation))) return false;
  if (i + 1 == table.half_swings()) return table.amplitude.back() > table.threshold;
  return stays(SlipOf(table, i + 1).deviation);
}

/// Whether the amplitude grows in half swing i and stays larger. A single turning point may be an outlier; at the edges
/// of a gap two may be.
bool GainsAmplitude(const TurningPointTable& table, std::size_t i, bool near_gap) {
  const auto amplitude = table.amplitude.begin();
  const auto at = static_cast<std::ptrdiff_t>(i);
  const auto turns = static_cast<std::ptrdiff_t>(table.turns.size());
  const std::ptrdiff_t follow = near_gap ? 4 : 3;
  const double before = *std::max_element(amplitude + std::max<std::ptrdiff_t>(at - 1, 0), amplitude + at + 1);
  const double after = *std::min_element(amplitude + at + 1, amplitude + std::min(at + follow, turns));
  return after > before + table.Tolerance(i);
}

/// Whether half swing i loses far more amplitude than its neighbours, that is, was braked.
bool IsBraked(const TurningPointTable& table, std::size_t i) {
  constexpr std::size_t kNeighbours = 4;
  constexpr double kFarMore = 2.5;
  std::vector<double> losses;
  for (std::size_t j = i - std::min(i, kNeighbours); j < std::min(i + kNeighbours + 1, table.half_swings()); ++j) {
    if (j != i) losses.push_back(table.amplitude[j] - table.amplitude[j + 1]);
  }
  if (losses.size() < kNeighbours) return false;
  const double typical = std::max(Median(std::move(losses)), 0.0);
  // A single turning point may be an outlier.
  const double after =
      i + 2 < table.turns.size() ? std::max(table.amplitude[i + 1], table.amplitude[i + 2]) : table.amplitude[i + 1];
  const double before = i > 0 ? std::min(table.amplitude[i - 1], table.amplitude[i]) : table.amplitude[i];
  return before - after > kFarMore * typical + table.Tolerance(i);
}

Verdict Classify(const TurningPointTable& table, std::size_t i) {
  const bool near_gap =
      HasGap(table, i) || (i > 0 && HasGap(table, i - 1)) || (i + 1 < table.half_swings() && HasGap(table, i + 1));
  if (near_gap) return GainsAmplitude(table, i, true) ? Verdict::kGains : Verdict::kFree;
  const double zero = 0.5 * (table.zero[i] + table.zero[i + 1]);
  if ((table.turns[i].value > zero) == (table.turns[i + 1].value > zero)) return Verdict::kIrregular;
  if (GainsAmplitude(table, i, false)) return Verdict::kGains;
  constexpr double kShortest = 0.5;
  constexpr double kLongest = 1.5;
  const double duration = RelativeDuration(table, i);
  if (duration > kLongest) return Verdict::kFreeAfterHold;
  // After a hand has raised the pendulum, the half swing may begin with the end of a hold and last longer.
  const bool may_be_held = i == 0 || GainsAmplitude(table, i - 1, false);
  const bool irregular =
      duration < kShortest || (!may_be_held && HasTimeSlip(table, i)) || (i > 0 && IsBraked(table, i));
  return irregular ? Verdict::kIrregular : Verdict::kFree;
}

}  // namespace

double TurningPointTable::Stretch(std::size_t turn) const {
  constexpr double kNearTop = 3.0;
  if (recording.quantity == Quantity::kRate || !recording.is_calibrated()) return 1;
  return PeriodRatio(std::min(amplitude[turn], kNearTop));
}

double TurningPointTable::Tolerance(std::size_t turn) const {
  return 0.05 * amplitude[turn] + 3 * noise + 2 * recording.resolution;
}

TurningPointTable TabulateTurningPoints(const Recording& recording) {
  TurningPointTable table{recording};
  table.noise = SuccessiveDifferenceNoise(recording);
  table.threshold = TurningThreshold(recording, table.noise);
  table.turns = FindTurningPoints(recording, table.threshold);
  if (table.turns.size() < 3) return table;
  table.zero = LocalZeros(table.turns);
  std::vector<double> durations;
  for (std::size_t i = 0; i < table.turns.size(); ++i) {
    table.amplitude.push_back(std::abs(table.turns[i].value - table.zero[i]));
  }
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    durations.push_back((table.turns[i + 1].time - table.turns[i].time) / table.Stretch(i));
  }
  table.half_period = Median(std::move(durations));
  return table;
}

std::vector<Verdict> ClassifyHalfSwings(const TurningPointTable& table) {
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < table.half_swings(); ++i) verdicts.push_back(Classify(table, i));
  return verdicts;
}

}  // namespace pendulum
