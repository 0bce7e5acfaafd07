// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/repair_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr double kTurn = 2 * kPi;

bool IsCalibratedAngle(const Recording& recording) {
  return recording.quantity == Quantity::kAngle && (recording.unit == "rad" || recording.unit == "deg");
}

/// Makes an angle continuous if the sensor wraps around after a turn.
void Unwrap(Recording& recording) {
  Eigen::VectorXd& value = recording.value;
  // The readings of such a sensor span at most one turn. A step is a jump if less than a quarter turn remains when
  // whole turns are removed from it.
  constexpr double kRounding = 1.01;
  if (!IsCalibratedAngle(recording) || value.maxCoeff() - value.minCoeff() > kTurn * kRounding) return;
  Index jumps = 0;
  double turns = 0;
  double before = value[0];
  for (Index i = 1; i < value.size(); ++i) {
    const double step = value[i] - before;
    before = value[i];
    const double jump = std::round(step / kTurn);
    if (std::abs(step) > kPi && std::abs(step - jump * kTurn) < 0.5 * kPi) {
      turns -= jump;
      ++jumps;
    }
    value[i] += turns * kTurn;
  }
  if (jumps == 0) return;
  recording.range.reset();  // it was the range of an angle within one turn
  recording.warnings.push_back(
      {"unwrapped",
       std::to_string(jumps) +
           " jumps by a whole turn, where the sensor's range begins again, were removed, so the angle is continuous"});
}

/// Keeps only the marked samples.
void KeepMarkedSamples(const std::vector<bool>& kept, Recording& recording) {
  Index count = 0;
  for (Index i = 0; i < recording.size(); ++i) {
    if (!kept[static_cast<std::size_t>(i)]) continue;
    recording.time[count] = recording.time[i];
    recording.value[count] = recording.value[i];
    ++count;
  }
  recording.time.conservativeResize(count);
  recording.value.conservativeResize(count);
}

/// The smallest step between readings: the quantile `share` of the changes, but at least the resolution.
double SmallestStep(const Recording& recording, double share) {
  std::vector<double> steps;
  steps.reserve(static_cast<std::size_t>(recording.size()));
  for (Index i = 1; i < recording.size(); ++i) {
    const double step = std::abs(recording.value[i] - recording.value[i - 1]);
    if (step > 0) steps.push_back(step);
  }
  if (steps.empty()) return recording.resolution;
  const auto least = steps.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(steps.size()));
  std::nth_element(steps.begin(), least, steps.end());
  return std::max(*least, recording.resolution);
}

/// Counts runs of at least three readings equal to the extreme of all readings that are entered and left at a similar
/// speed: clipped tops of a swing. A hold may be entered at speed, but is left slowly.
Index CountFlatTops(const Eigen::VectorXd& value, double extreme, double smallest_step) {
  constexpr Index kMinReadings = 3;
  constexpr double kAtSpeed = 3, kSimilar = 3;
  Index tops = 0;
  for (Index i = 1; i + 1 < value.size(); ++i) {
    if (value[i] != extreme || value[i - 1] == extreme) continue;
    Index end = i;
    while (end < value.size() && value[end] == extreme) ++end;
    if (end == value.size()) break;
    // The step beside the run may be a part of one.
    const double entry = std::abs(value[std::max<Index>(i - 2, 0)] - extreme);
    const double exit = std::abs(value[std::min(end + 1, value.size() - 1)] - extreme);
    const bool is_symmetric = std::max(entry, exit) < kSimilar * std::min(entry, exit);
    if (end - i >= kMinReadings && is_symmetric && std::min(entry, exit) > kAtSpeed * smallest_step) ++tops;
    i = end;
  }
  return tops;
}

/// Uses an extreme at which swings are clipped as an end of the sensor's range. A range from the file may be that of
/// the converter, of which the sensor reaches only a part.
void DetectSaturation(double smallest_step, Recording& recording) {
  constexpr Index kMinTops = 3;
  const double high = recording.value.maxCoeff();
  const double low = recording.value.minCoeff();
  const bool at_high = CountFlatTops(recording.value, high, smallest_step) >= kMinTops;
  const bool at_low = CountFlatTops(recording.value, low, smallest_step) >= kMinTops;
  if (!at_high && !at_low) return;
  if (!recording.range) recording.range = SensorRange{2 * low - high, 2 * high - low};
  if (at_low) recording.range->low = low;
  if (at_high) recording.range->high = high;
}

/// Warns if there are rows only where the value changes: steps of one size, never zero, at unequal intervals.
void WarnOfEventRows(double smallest_step, Recording& recording) {
  constexpr double kSame = 1e-3;
  constexpr double kMinSingleShare = 0.3;
  constexpr double kNever = 0.002;
  constexpr double kUneven = 1.5;
  double single = 0;
  double none = 0;
  std::vector<double> intervals;
  intervals.reserve(static_cast<std::size_t>(recording.size()));
  for (Index i = 1; i < recording.size(); ++i) {
    const double step = std::abs(recording.value[i] - recording.value[i - 1]);
    single += std::abs(step - smallest_step) < kSame * smallest_step ? 1 : 0;
    none += step == 0 ? 1 : 0;
    intervals.push_back(recording.time[i] - recording.time[i - 1]);
  }
  const auto steps = static_cast<double>(intervals.size());
  std::ranges::sort(intervals);
  const bool uneven = intervals[intervals.size() * 9 / 10] > kUneven * intervals[intervals.size() / 10];
  if (!uneven || single < kMinSingleShare * steps || none > kNever * steps) return;
  recording.warnings.push_back({.code = "event_driven",
                                .finding = "the recording has rows only where the value changes",
                                .explanation = "the angle is then at the edge of its count, half a count from the "
                                               "middle, and the error bars ignore this shift",
                                .advice = "record at equal intervals if possible"});
}

constexpr Index kStaleReach = 6;  // samples on either side that are examined for stale readings

/// Readings that repeat the previous one although their neighbours change by many times the smallest step. amid_change:
/// the neighbours have a large range. amid_motion: the neighbours move far in one direction.
struct Repeats {
  std::vector<bool> amid_change;
  std::vector<bool> amid_motion;
  Index changing = 0;
  Index repeated = 0;
};

Repeats FindRepeats(double smallest_step, const Recording& recording) {
  constexpr double kChange = 12;  // smallest steps, over all neighbours
  constexpr double kMotion = 3;   // smallest steps from one sample to the next
  const Eigen::VectorXd& value = recording.value;
  const Index last = recording.size() - 1;
  Repeats repeats{std::vector<bool>(static_cast<std::size_t>(last + 1)), {}};
  repeats.amid_motion = repeats.amid_change;
  for (Index i = 1; i <= last; ++i) {
    const Index from = std::max<Index>(i - kStaleReach, 0);
    const Index to = std::min(i + kStaleReach, last);
    const auto near = value.segment(from, to - from + 1);
    const bool changes = near.maxCoeff() - near.minCoeff() > kChange * smallest_step;
    const bool moves = std::abs(value[to] - value[from]) > kMotion * smallest_step * static_cast<double>(to - from);
    const auto& range = recording.range;
    const bool cut_off = range && (value[i] <= range->low || value[i] >= range->high);
    const bool same = value[i] == value[i - 1] && !cut_off;
    repeats.changing += changes ? 1 : 0;
    repeats.repeated += changes && same ? 1 : 0;
    repeats.amid_change[static_cast<std::size_t>(i)] = changes && same;
    repeats.amid_motion[static_cast<std::size_t>(i)] = moves && same;
  }
  return repeats;
}

/// Whether readings change both before sample `first` and after sample `last`. At the end of a hold and where
/// a pendulum stops, they change on one side only.
bool ChangesOnBothSides(const Eigen::VectorXd& value, Index first, Index last, double smallest_step) {
  constexpr double kChange = 3;  // smallest steps
  const double before = value[first - 1] - value[std::max<Index>(first - 1 - kStaleReach, 0)];
  const double after = value[std::min(last + kStaleReach, value.size() - 1)] - value[last];
  return std::min(std::abs(before), std::abs(after)) > kChange * smallest_step;
}

/// Leaves out stale readings: all of them if a tracker repeats many values, otherwise only three or more in a row
/// during motion.
void RemoveStaleReadings(double smallest_step, Recording& recording) {
  constexpr double kMaxRepeatedShare = 0.25;
  constexpr std::size_t kMinConsecutive = 3;
  const Repeats repeats = FindRepeats(smallest_step, recording);
  const bool many = static_cast<double>(repeats.repeated) > kMaxRepeatedShare * static_cast<double>(repeats.changing);
  const std::vector<bool>& stale = many ? repeats.amid_change : repeats.amid_motion;
  std::vector<bool> kept(stale.size(), true);
  Index left_out = 0;
  for (std::size_t i = 1; i < stale.size();) {
    std::size_t end = i;
    while (end < stale.size() && stale[end]) ++end;
    const auto first = static_cast<Index>(i), last = static_cast<Index>(end) - 1;
    if (many ? end > i
             : end - i >= kMinConsecutive && ChangesOnBothSides(recording.value, first, last, smallest_step)) {
      std::fill(kept.begin() + static_cast<std::ptrdiff_t>(i), kept.begin() + static_cast<std::ptrdiff_t>(end), false);
      left_out += static_cast<Index>(end - i);
    }
    i = std::max(end, i + 1);
  }
  if (left_out == 0 || recording.size() - left_out < kMinimumSamples) return;
  KeepMarkedSamples(kept, recording);
  recording.warnings.push_back(
      {.code = "stale_values",
       .finding = std::to_string(left_out) + " readings only repeat the previous one while the pendulum moves",
       .explanation = "they are left out"});
}

/// The scale of the distances of readings to the line through their two neighbours. Stores the median of each block;
/// At() returns the largest median of the three blocks around a sample.
class LocalScale {
 public:
  explicit LocalScale(const Recording& recording) {
    for (Index begin = 1; begin + 1 < recording.size(); begin += kBlock) {
      std::vector<double> distance;
      for (Index i = begin; i < std::min(begin + kBlock, recording.size() - 1); ++i) {
        const double w = (recording.time[i] - recording.time[i - 1]) / (recording.time[i + 1] - recording.time[i - 1]);
        distance.push_back(
            std::abs(recording.value[i] - (1 - w) * recording.value[i - 1] - w * recording.value[i + 1]));
      }
      medians_.push_back(Median(std::move(distance)));
    }
  }

  double At(Index i) const {
    const auto block = static_cast<std::size_t>((i - 1) / kBlock);
    const std::size_t first = block == 0 ? 0 : block - 1;
    const std::size_t last = std::min(block + 1, medians_.size() - 1);
    return *std::max_element(medians_.begin() + static_cast<std::ptrdiff_t>(first),
                             medians_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  }

 private:
  static constexpr Index kBlock = 32;
  std::vector<double> medians_;
};

/// The reading at sample i extrapolated along the line through samples a and b.
double Extrapolated(const Recording& recording, Index a, Index b, Index i) {
  const double slope = (recording.value[b] - recording.value[a]) / (recording.time[b] - recording.time[a]);
  return recording.value[b] + slope * (recording.time[i] - recording.time[b]);
}

/// Marks readings that neither the two previous nor the two following ones predict. A reading at a kick or a release is
/// predicted from one side.
struct Spikes {
  std::vector<bool> kept;
  Index count = 0;
};

Spikes FindSpikes(double smallest_step, const Recording& recording) {
  constexpr double kSigmaPerMedian = 1.21;  // standard deviation of Gaussian noise / median of the distances
  constexpr double kSteps = 2.5;
  const double deviations = 2 * std::sqrt(2 * std::log(static_cast<double>(recording.size()))) + 0.5;
  const double far_in_medians = kSigmaPerMedian * deviations;
  const LocalScale scale(recording);
  const Eigen::VectorXd& value = recording.value;
  std::vector<bool> kept(static_cast<std::size_t>(recording.size()), true);
  Index left_out = 0;
  for (Index i = 2; i + 2 < recording.size(); ++i) {
    const double far = far_in_medians * scale.At(i) + kSteps * smallest_step;
    const auto is_far = [&](double predicted) { return std::abs(value[i] - predicted) > far; };
    if (!is_far(Extrapolated(recording, i - 2, i - 1, i)) || !is_far(Extrapolated(recording, i + 2, i + 1, i)))
      continue;
    kept[static_cast<std::size_t>(i)] = false;
    ++left_out;
  }
  return {std::move(kept), left_out};
}

void RemoveSpikes(double smallest_step, Recording& recording) {
  constexpr int kMaxPasses = 4;  // the neighbours of a spike are examined again without the spike
  constexpr Index kMinSamplesPerRemoved = 10;
  Spikes spikes = FindSpikes(smallest_step, recording);
  if (spikes.count == 0) return;
  Recording without = recording;
  Index left_out = 0;
  for (int pass = 0; pass < kMaxPasses && spikes.count > 0; ++pass) {
    if (without.size() - spikes.count < kMinimumSamples) break;
    KeepMarkedSamples(spikes.kept, without);
    left_out += spikes.count;
    spikes = FindSpikes(smallest_step, without);
  }
  if (left_out * kMinSamplesPerRemoved > recording.size()) {
    recording.warnings.push_back(
        {"many_spikes", std::to_string(left_out) + " readings are far from their neighbours, too many to leave out"});
    return;
  }
  recording = std::move(without);
  const std::string message =
      left_out == 1 ? "1 reading far from its neighbours on both sides is left out"
                    : std::to_string(left_out) + " readings far from their neighbours on both sides are left out";
  recording.warnings.push_back({"spikes", message});
}

}  // namespace

Recording RepairValues(Recording recording) {
  Unwrap(recording);
  DetectSaturation(SmallestStep(recording, 0.01), recording);
  WarnOfEventRows(SmallestStep(recording, 0.1), recording);
  RemoveStaleReadings(SmallestStep(recording, 0.01), recording);
  RemoveSpikes(SmallestStep(recording, 0.1), recording);
  return recording;
}

}  // namespace pendulum
