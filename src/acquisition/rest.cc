// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/rest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pendulum {
namespace {

constexpr double kBlockSeconds = 0.1, kLongestBlockSeconds = 0.25;
constexpr int kBlockSamples = 8;  // or fewer where these would take longer
constexpr double kLeastTurn = 5;  // counts: what goes back less than that is noise

}  // namespace

double RestDetector::Block::VarianceOfMean() const {
  return count < 2 ? 0 : std::max(0.0, squares / count - Mean() * Mean()) / (count - 1);
}

void RestDetector::Take(double time, double counts) {
  const double duration = open_.count >= kBlockSamples ? kBlockSeconds : kLongestBlockSeconds;
  if (open_.count > 0 && time - open_.time >= duration) Close();
  if (open_.count == 0) open_.time = time;
  open_.sum += counts;
  open_.squares += counts * counts;
  ++open_.count;
}

void RestDetector::Close() {
  FollowTurns(open_.Mean());
  blocks_.push_back(open_);
  while (open_.time - blocks_.front().time > kRestSeconds) {
    is_window_full_ = true;
    blocks_.pop_front();
  }
  open_ = Block();
}

void RestDetector::FollowTurns(double mean) {
  if (!is_begun_) extreme_ = mean;
  is_begun_ = true;
  if (direction_ == 0) {
    if (std::abs(mean - extreme_) < kLeastTurn) return;
    direction_ = mean > extreme_ ? 1 : -1;
  }
  if (direction_ * (mean - extreme_) >= 0) {
    extreme_ = mean;
  } else if (direction_ * (extreme_ - mean) >= kLeastTurn) {
    turns_.push_back(extreme_);
    if (turns_.size() > kTurns) turns_.pop_front();
    direction_ = -direction_;
    extreme_ = mean;
  }
}

bool RestDetector::IsAtRest() const {
  if (!HasSwung() || !is_window_full_) return false;
  double low = blocks_.front().Mean(), high = low, sum = 0, variance = 0;
  for (const Block& block : blocks_) {
    low = std::min(low, block.Mean());
    high = std::max(high, block.Mean());
    sum += block.Mean();
    variance += block.VarianceOfMean();
  }
  const auto count = static_cast<double>(blocks_.size());
  constexpr double kRounding = 1.5, kDeviations = 5;  // counts; of the mean of a block, between the largest and least
  if (high - low > kRounding + kDeviations * std::sqrt(variance / count)) return false;
  const double rest = sum / count;
  for (std::size_t i = 1; i < turns_.size(); ++i) {
    if ((turns_[i] - rest) * (turns_[i - 1] - rest) >= 0) return false;
  }
  return true;
}

}  // namespace pendulum
