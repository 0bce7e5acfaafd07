// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

/// Points of a recording in progress for a plot, in bounded memory.
namespace pendulum {

/// A sample: time [s] and value, in the unit of the recording.
struct LivePoint {
  double time, value;
};

/// The samples with the smallest and the largest value in a block of successive samples. Of equal values the smallest
/// is the first one and the largest the last one.
struct LiveExtremes {
  explicit LiveExtremes(LivePoint only) : least(only), largest(only) {}

  /// Includes the extremes of the samples that follow.
  void Include(const LiveExtremes& next) {
    if (next.least.value < least.value) least = next.least;
    if (next.largest.value >= largest.value) largest = next.largest;
  }

  /// Appends both points in the order of their times; skips a point that is not later than the last one in `points`.
  void AppendTo(std::vector<LivePoint>& points) const {
    const bool is_falling = largest.time < least.time;
    for (const LivePoint& point : {is_falling ? largest : least, is_falling ? least : largest}) {
      if (points.empty() || points.back().time < point.time) points.push_back(point);
    }
  }

  LivePoint least, largest;
};

/// A whole run of any length in at most kMaxPoints points: the first, the last, and the extremes of blocks of samples.
/// The block size grows with the run.
class WholeRun {
 public:
  static constexpr std::size_t kMaxPoints = 4000;

  void Add(LivePoint point) {
    if (!first_) first_ = point;
    last_ = point;
    if (!blocks_.empty() && in_last_block_ < block_size_) {
      blocks_.back().Include(LiveExtremes(point));
      ++in_last_block_;
      return;
    }
    if (blocks_.size() == kMaxBlocks) Merge();
    blocks_.emplace_back(point);
    in_last_block_ = 1;
  }

  std::vector<LivePoint> Points() const {
    std::vector<LivePoint> points;
    if (!first_) return points;
    points.push_back(*first_);
    for (const LiveExtremes& block : blocks_) block.AppendTo(points);
    if (points.back().time < last_.time) points.push_back(last_);
    return points;
  }

 private:
  static constexpr std::size_t kMaxBlocks = kMaxPoints / 2 - 2;  // even; leaves room for the first and the last point

  void Merge() {
    for (std::size_t i = 0; i < blocks_.size(); i += 2) {
      blocks_[i].Include(blocks_[i + 1]);
      blocks_[i / 2] = blocks_[i];
    }
    blocks_.erase(blocks_.begin() + kMaxBlocks / 2, blocks_.end());
    block_size_ *= 2;
  }

  std::vector<LiveExtremes> blocks_;
  std::size_t block_size_ = 2, in_last_block_ = 0;  // samples; a block of two loses none
  std::optional<LivePoint> first_;
  LivePoint last_{};
};

/// Reduces incoming samples to at most fifty per second of recording time: all samples at low rates, otherwise the
/// extremes of short blocks. Each point stands for a fiftieth of a second.
class SparsePoints {
 public:
  /// Adds a sample and appends the finished points to `points`.
  void Add(LivePoint point, std::vector<LivePoint>& points) {
    if (block_ && point.time >= next_point_time_ + 2 * kPointInterval) Flush(points);
    if (block_) {
      block_->Include(LiveExtremes(point));
    } else if (!has_begun_ || point.time >= next_point_time_) {
      points.push_back(point);
      next_point_time_ = point.time + kPointInterval;
      has_begun_ = true;
    } else {
      block_.emplace(point);
    }
  }

  /// Appends the unfinished block. Call it if no more samples follow for now.
  void Flush(std::vector<LivePoint>& points) {
    if (!block_) return;
    block_->AppendTo(points);
    next_point_time_ += 2 * kPointInterval;
    block_.reset();
  }

 private:
  static constexpr double kPointInterval = 0.02;  // s

  std::optional<LiveExtremes> block_;  // starts at next_point_time_ and lasts for the time of two points
  double next_point_time_ = 0;         // s
  bool has_begun_ = false;
};

}  // namespace pendulum
