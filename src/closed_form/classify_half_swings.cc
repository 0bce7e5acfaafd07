// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/classify_half_swings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pendulum/base/median.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Whether samples are missing for such a large part of half swing i that turning points may be missing.
bool HasGap(const Recording& recording, const TurningPointTable& table, std::size_t i) {
  constexpr double kLongest = 0.4;
  const Eigen::VectorXd& time = recording.time;
  for (Index k = table.points[i].sample; k < table.points[i + 1].sample; ++k) {
    if (time[k + 1] - time[k] > kLongest * table.half_period) return true;
  }
  return false;
}

/// Duration of half swing i, divided by that of a small one.
double RelativeDuration(const TurningPointTable& table, std::size_t i) {
  const double stretch = 0.5 * (table.Stretch(i) + table.Stretch(i + 1));
  return (table.points[i + 1].time - table.points[i].time) / (table.half_period * stretch);
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
/// successor to check. Its slip counts only if the amplitude of the last turning point is above the threshold, because
/// the time of a turning point just before standstill is uncertain.
bool HasTimeSlip(const TurningPointTable& table, std::size_t i) {
  const Slip slip = SlipOf(table, i);
  const auto stays = [&](double neighbour) { return std::abs(slip.deviation + neighbour) > slip.limit; };
  if (!stays(0) || (i > 0 && !stays(SlipOf(table, i - 1).deviation))) return false;
  if (i + 1 == table.half_swings()) return table.Amplitude(i + 1) > table.threshold;
  return stays(SlipOf(table, i + 1).deviation);
}

/// Whether the amplitude grows in half swing i and stays larger. A single turning point may be an outlier; at the edges
/// of a gap, two may be outliers.
bool GainsAmplitude(const TurningPointTable& table, std::size_t i, bool near_gap) {
  const std::size_t end = std::min<std::size_t>(i + (near_gap ? 4 : 3), table.points.size());
  const double before = std::max(table.Amplitude(i > 0 ? i - 1 : 0), table.Amplitude(i));
  double after = table.Amplitude(i + 1);
  for (std::size_t k = i + 2; k < end; ++k) after = std::min(after, table.Amplitude(k));
  return after > before + table.Tolerance(i);
}

/// Whether half swing i loses far more amplitude than its neighbours, that is, was braked.
bool IsBraked(const TurningPointTable& table, std::size_t i) {
  constexpr std::size_t kNeighbours = 4;
  constexpr double kFarMore = 2.5;
  std::vector<double> losses;
  for (std::size_t j = i - std::min(i, kNeighbours); j < std::min(i + kNeighbours + 1, table.half_swings()); ++j) {
    if (j != i) losses.push_back(table.Amplitude(j) - table.Amplitude(j + 1));
  }
  if (losses.size() < kNeighbours) return false;
  const double typical = std::max(Median(std::move(losses)), 0.0);
  // A single turning point may be an outlier.
  const double after =
      i + 2 < table.points.size() ? std::max(table.Amplitude(i + 1), table.Amplitude(i + 2)) : table.Amplitude(i + 1);
  const double before = i > 0 ? std::min(table.Amplitude(i - 1), table.Amplitude(i)) : table.Amplitude(i);
  return before - after > kFarMore * typical + table.Tolerance(i);
}

Verdict Classify(const Recording& recording, const TurningPointTable& table, std::size_t i) {
  const bool near_gap = HasGap(recording, table, i) || (i > 0 && HasGap(recording, table, i - 1)) ||
                        (i + 1 < table.half_swings() && HasGap(recording, table, i + 1));
  if (near_gap) return GainsAmplitude(table, i, true) ? Verdict::kGains : Verdict::kFree;
  const double zero = 0.5 * (table.ZeroAt(i) + table.ZeroAt(i + 1));
  if ((table.points[i].value > zero) == (table.points[i + 1].value > zero)) return Verdict::kIrregular;
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

std::vector<Verdict> ClassifyHalfSwings(const Recording& recording, const TurningPointTable& table) {
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < table.half_swings(); ++i) verdicts.push_back(Classify(recording, table, i));
  return verdicts;
}

}  // namespace pendulum
