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

/// Continues an angle across the jumps of a sensor that begins again after a turn.
void Unwrap(Recording& recording) {
  Eigen::VectorXd& value = recording.value;
  // Such a sensor shows no more than one turn, and a step after the jump is taken out is no longer one itself.
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
  recording.range.reset();  // of an angle within a turn
  recording.warnings.push_back(
      {"unwrapped", std::to_string(jumps) +
                        " jumps by a whole turn, where the sensor begins again, were taken out: the angle is continued"});
}

/// Keeps the samples that are marked, and nothing else.
void KeepOnly(const std::vector<bool>& kept, Recording& recording) {
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

/// The least step that readings make: their resolution, or what a tenth of the changes stays below.
double LeastStep(const Recording& recording) {
  std::vector<double> steps;
  for (Index i = 1; i < recording.size(); ++i) {
    const double step = std::abs(recording.value[i] - recording.value[i - 1]);
    if (step > 0) steps.push_back(step);
  }
  if (steps.empty()) return recording.resolution;
  const auto tenth = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 10);
  std::nth_element(steps.begin(), tenth, steps.end());
  return std::max(*tenth, recording.resolution);
}

/// Leaves out readings that repeat the one before while those around them move on: where a tracker repeats most of its
/// values all of them, else only three and more in a row.
void LeaveOutStale(double least_step, Recording& recording) {
  constexpr Index kReach = 4;
  constexpr double kMoves = 3;  // least steps from one sample to the next
  constexpr double kMostly = 0.25;
  constexpr Index kFewestInARow = 3;
  const Eigen::VectorXd& value = recording.value;
  const Index last = recording.size() - 1;
  const auto is_stale = [&](Index i) {
    const Index from = std::max<Index>(i - kReach, 0);
    const Index to = std::min(i + kReach, last);
    const bool moves = std::abs(value[to] - value[from]) > kMoves * least_step * static_cast<double>(to - from);
    return std::pair(moves, moves && value[i] == value[i - 1]);
  };
  Index moving = 0;
  Index repeats = 0;
  for (Index i = 1; i <= last; ++i) {
    const auto [moves, stale] = is_stale(i);
    moving += moves ? 1 : 0;
    repeats += stale ? 1 : 0;
  }
  const bool mostly = static_cast<double>(repeats) > kMostly * static_cast<double>(moving);
  std::vector<bool> kept(static_cast<std::size_t>(recording.size()), true);
  Index left_out = 0;
  for (Index i = 1; i <= last;) {
    Index end = i;
    while (end <= last && is_stale(end).second) ++end;
    if (end - i >= (mostly ? 1 : kFewestInARow)) {
      std::fill(kept.begin() + i, kept.begin() + end, false);
      left_out += end - i;
    }
    i = std::max(end, i + 1);
  }
  if (left_out == 0 || recording.size() - left_out < kMinimumSamples) return;
  KeepOnly(kept, recording);
  recording.warnings.push_back({"stale_values", std::to_string(left_out) +
                                                    " readings only repeat the one before while the pendulum moves on; "
                                                    "they are left out"});
}

/// Distance of each reading to the line through its two neighbours: median over blocks, and the largest of three blocks
/// around a sample.
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

/// The reading at sample i if the line through samples a and b went on.
double Extrapolated(const Recording& recording, Index a, Index b, Index i) {
  const double slope = (recording.value[b] - recording.value[a]) / (recording.time[b] - recording.time[a]);
  return recording.value[b] + slope * (recording.time[i] - recording.time[b]);
}

/// Leaves out readings that neither the two before nor the two after lead to: a kick or a release is led to by one side.
void LeaveOutSpikes(double least_step, Recording& recording) {
  constexpr double kFar = 16;   // medians: about 8 standard deviations of an extrapolation
  constexpr double kSteps = 6;
  constexpr Index kMostInARow = 4;
  constexpr Index kMostOf = 10;
  const LocalScale scale(recording);
  const Eigen::VectorXd& value = recording.value;
  std::vector<bool> kept(static_cast<std::size_t>(recording.size()), true);
  Index left_out = 0;
  for (Index i = 2; i + 2 < recording.size(); ++i) {
    const double far = kFar * scale.At(i) + kSteps * least_step;
    const auto is_far = [&](double predicted) { return std::abs(value[i] - predicted) > far; };
    if (!is_far(Extrapolated(recording, i - 2, i - 1, i)) || !is_far(Extrapolated(recording, i + 2, i + 1, i))) continue;
    kept[static_cast<std::size_t>(i)] = false;
    ++left_out;
  }
  if (left_out == 0) return;
  (void)kMostInARow;
  if (left_out * kMostOf > recording.size()) {
    recording.warnings.push_back({"many_spikes", std::to_string(left_out) + " readings stand far from their "
                                                                            "neighbours, too many to leave out"});
    return;
  }
  KeepOnly(kept, recording);
  recording.warnings.push_back(
      {"spikes", std::to_string(left_out) + " readings far from their neighbours on both sides are left out"});
}

}  // namespace

Recording RepairValues(Recording recording) {
  Unwrap(recording);
  const double least_step = LeastStep(recording);
  LeaveOutStale(least_step, recording);
  LeaveOutSpikes(least_step, recording);
  return recording;
}

}  // namespace pendulum
