// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/low_band.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "pendulum/base/median.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The mean of the readings within length / 2 of each sample.
VectorXd MovingMean(const VectorXd& time, const VectorXd& value, double length) {
  const Index count = time.size();
  VectorXd mean(count);
  // Sums relative to the first reading, so that a large zero does not cost digits.
  double sum = 0;
  Index first = 0;
  Index end = 0;
  for (Index i = 0; i < count; ++i) {
    while (end < count && time[end] - time[i] <= 0.5 * length) sum += value[end++] - value[0];
    while (time[i] - time[first] > 0.5 * length) sum -= value[first++] - value[0];
    mean[i] = value[0] + sum / static_cast<double>(end - first);
  }
  return mean;
}

/// What LowBand removes, without the part of the swing in it: the high band of the high band.
VectorXd HighBand(const Recording& recording, double length) {
  Recording high = recording;
  for (int pass = 0; pass < 2; ++pass) high.value -= LowBand(high, length).value;
  return high.value;
}

/// The vibration in one block of samples.
struct Block {
  Index first, end;
  double rms;
};

/// Blocks of two periods of the vibration within [from, to].
std::vector<Block> BlocksOf(const Recording& recording, const VectorXd& high, double length, double from, double to) {
  constexpr Index kMinSamples = 6;
  std::vector<Block> blocks;
  const VectorXd& time = recording.time;
  for (Index i = 0; i < time.size();) {
    Index end = i;
    while (end < time.size() && time[end] - time[i] < 2 * length) ++end;
    if (time[i] >= from && time[end - 1] <= to && end - i >= kMinSamples) {
      blocks.push_back({i, end, std::sqrt(high.segment(i, end - i).squaredNorm() / static_cast<double>(end - i))});
    }
    i = end;
  }
  return blocks;
}

/// Hz, from the typical time between changes of sign in the blocks where the vibration is strongest.
double FrequencyOf(const VectorXd& time, const VectorXd& high, const std::vector<Block>& blocks) {
  constexpr double kStrong = 0.4;
  const double least = kStrong * std::ranges::max_element(blocks, {}, &Block::rms)->rms;
  std::vector<double> intervals;
  for (const Block& block : blocks) {
    if (block.rms < least) continue;
    std::optional<double> last;
    for (Index i = block.first + 1; i < block.end; ++i) {
      if ((high[i] > 0) == (high[i - 1] > 0)) continue;
      const double change = time[i - 1] + (time[i] - time[i - 1]) * high[i - 1] / (high[i - 1] - high[i]);
      if (last) intervals.push_back(change - *last);
      last = change;
    }
  }
  return intervals.empty() ? 0 : 0.5 / Median(std::move(intervals));
}

}  // namespace

Recording LowBand(const Recording& recording, double length) {
  Recording low = recording;
  for (int pass = 0; pass < 2; ++pass) low.value = MovingMean(low.time, low.value, length);
  return low;
}

double FastestPeriod(const TurningPointTable& table) {
  std::vector<double> durations;
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    durations.push_back(table.points[i + 1].time - table.points[i].time);
  }
  const auto quarter = durations.begin() + static_cast<std::ptrdiff_t>(durations.size() / 4);
  std::nth_element(durations.begin(), quarter, durations.end());
  return 2 * *quarter;
}

void LeaveOutVibration(const Recording& recording, double noise, double length, FreeSwing& swing) {
  constexpr double kVisible = 3;        // times the noise
  constexpr double kSmall = 0.01;       // of the swing's amplitude
  constexpr std::size_t kMinTurns = 5;  // that remain
  const VectorXd high = HighBand(recording, length);
  const std::vector<Block> blocks = BlocksOf(recording, high, length, swing.from, swing.to);
  if (blocks.empty()) return;
  const double least = std::max(kVisible * noise, kSmall * swing.amplitude);
  const auto strong = [&](const Block& block) { return block.rms > least; };
  const auto last = std::find_if(blocks.rbegin(), blocks.rend(), strong);
  if (last == blocks.rend()) return;
  // The vibration is often strongest before the swing.
  const double frequency =
      FrequencyOf(recording.time, high, BlocksOf(recording, high, length, recording.time[0], swing.to));
  const double end = recording.time[std::min(last->end, recording.size() - 1)];
  const auto turn = std::ranges::lower_bound(swing.turns, end);
  const auto left = static_cast<std::size_t>(swing.turns.end() - turn);
  if (left >= kMinTurns && 2 * left >= swing.turns.size()) {
    swing.from = *turn;
    swing.begins = {WindowBegin::Reason::kAfterVibration, 0, frequency};
    swing.heights.erase(swing.heights.begin(), swing.heights.begin() + (turn - swing.turns.begin()));
    swing.turns.erase(swing.turns.begin(), turn);
    return;
  }
  double sum = 0;
  for (const Block& block : blocks) sum += block.rms * block.rms / static_cast<double>(blocks.size());
  swing.vibration = Vibration{frequency, std::sqrt(2 * sum)};
}

}  // namespace pendulum
