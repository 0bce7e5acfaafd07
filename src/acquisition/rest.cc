// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/rest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pendulum {
namespace {

constexpr double kBlockSeconds = 0.1, kLongestBlockSeconds = 0.25;
constexpr int kBlockSamples = 8;  // fewer if these take longer than kLongestBlockSeconds
constexpr double kMinTurn = 5;    // counts: smaller reversals are noise

}  // namespace

/// Limited to kMaxVariance: no potentiometer is noisier, so a larger variance is motion.
double RestDetector::Block::Variance() const {
  constexpr double kMaxVariance = 16;  // counts²
  if (count < 2) return kMaxVariance;
  return std::clamp((squares - count * Mean() * Mean()) / (count - 1), 0.0, kMaxVariance);
}

void RestDetector::AddSample(double time, double counts) {
  const double duration = open_.count >= kBlockSamples ? kBlockSeconds : kLongestBlockSeconds;
  if (open_.count > 0 && time - open_.time >= duration) Close();
  if (open_.count == 0) open_.time = time;
  open_.sum += counts;
  open_.squares += counts * counts;
  open_.low = open_.count == 0 ? counts : std::min(open_.low, counts);
  open_.high = open_.count == 0 ? counts : std::max(open_.high, counts);
  ++open_.count;
}

void RestDetector::Close() {
  TrackTurningPoints(open_.Mean());
  blocks_.push_back(open_);
  while (open_.time - blocks_.front().time > kRestSeconds) blocks_.pop_front();
  open_ = Block();
}

void RestDetector::TrackTurningPoints(double mean) {
  if (!is_begun_) extreme_ = mean;
  is_begun_ = true;
  if (direction_ == 0) {
    if (std::abs(mean - extreme_) < kMinTurn) return;
    direction_ = mean > extreme_ ? 1 : -1;
  }
  if (direction_ * (mean - extreme_) >= 0) {
    extreme_ = mean;
  } else if (direction_ * (extreme_ - mean) >= kMinTurn) {
    turns_.push_back(extreme_);
    if (turns_.size() > kTurns) turns_.pop_front();
    direction_ = -direction_;
    extreme_ = mean;
  }
}

bool RestDetector::IsAtRest() const {
  if (!HasSwung() || blocks_.empty()) return false;
  if (blocks_.back().time - blocks_.front().time < kRestSeconds - 2 * kLongestBlockSeconds) return false;
  const Block& first = blocks_.front();
  double low = first.Mean(), high = low, lowest = first.low, highest = first.high, sum = 0, variance = 0, samples = 0;
  for (const Block& block : blocks_) {
    low = std::min(low, block.Mean());
    high = std::max(high, block.Mean());
    lowest = std::min(lowest, block.low);
    highest = std::max(highest, block.high);
    sum += block.Mean();
    variance += block.Variance();
    samples += block.count;
  }
  const auto count = static_cast<double>(blocks_.size());
  // Rounding can spread the means of blocks by kRounding counts and single readings by twice that. Noise adds several
  // standard deviations of a mean or of a reading.
  constexpr double kRounding = 1.5, kDeviationsOfMeans = 5, kDeviations = 8;
  const double noise = std::sqrt(variance / count);
  if (high - low > kRounding + kDeviationsOfMeans * noise / std::sqrt(samples / count)) return false;
  if (highest - lowest > 2 * kRounding + kDeviations * noise) return false;
  const double rest = sum / count;
  for (std::size_t i = 1; i < turns_.size(); ++i) {
    if ((turns_[i] - rest) * (turns_[i - 1] - rest) >= 0) return false;
  }
  return true;
}

}  // namespace pendulum
