// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

/// What of a recording in progress is shown, in memory that does not grow with it.
namespace pendulum {

/// A sample: time [s] and value, in the unit of the recording.
struct LivePoint {
  double time, value;
};

/// The samples with the least and the largest value of some that follow each other; of equal ones the first and the
/// last.
struct LiveExtremes {
  explicit LiveExtremes(LivePoint only) : least(only), largest(only) {}

  void Take(const LiveExtremes& next) {
    if (next.least.value < least.value) least = next.least;
    if (next.largest.value >= largest.value) largest = next.largest;
  }

  /// Appends them in the order they came, none that is not behind the last.
  void AppendTo(std::vector<LivePoint>& points) const {
    const bool is_falling = largest.time < least.time;
    for (const LivePoint& point : {is_falling ? largest : least, is_falling ? least : largest}) {
      if (points.empty() || points.back().time < point.time) points.push_back(point);
    }
  }

  LivePoint least, largest;
};

/// A whole run, however long, in at most kMostPoints points, with its first, its last, and the extremes of blocks of
/// samples, which grow with it.
class WholeRun {
 public:
  static constexpr std::size_t kMostPoints = 4000;

  void Take(LivePoint point) {
    if (!first_) first_ = point;
    last_ = point;
    if (!blocks_.empty() && in_last_ < block_size_) {
      blocks_.back().Take(LiveExtremes(point));
      ++in_last_;
      return;
    }
    if (blocks_.size() == kMostBlocks) Merge();
    blocks_.emplace_back(point);
    in_last_ = 1;
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
  static constexpr std::size_t kMostBlocks = kMostPoints / 2 - 2;  // even, and room for the ends

  void Merge() {
    for (std::size_t i = 0; i < blocks_.size(); i += 2) {
      blocks_[i].Take(blocks_[i + 1]);
      blocks_[i / 2] = blocks_[i];
    }
    blocks_.erase(blocks_.begin() + kMostBlocks / 2, blocks_.end());
    block_size_ *= 2;
  }

  std::vector<LiveExtremes> blocks_;
  std::size_t block_size_ = 2, in_last_ = 0;  // samples; of two a block keeps both
  std::optional<LivePoint> first_;
  LivePoint last_{};
};

/// Of samples as they come at most fifty a second of their time: each one while they are few, else the extremes of
/// short blocks. Every point is paid for with a fiftieth of a second.
class SparsePoints {
 public:
  /// Appends what is settled by now.
  void Take(LivePoint point, std::vector<LivePoint>& points) {
    if (block_ && point.time >= paid_until_ + 2 * kPrice) Flush(points);
    if (block_) {
      block_->Take(LiveExtremes(point));
    } else if (!has_begun_ || point.time >= paid_until_) {
      points.push_back(point);
      paid_until_ = point.time + kPrice;
      has_begun_ = true;
    } else {
      block_.emplace(point);
    }
  }

  /// Appends what is left, where nothing follows for now.
  void Flush(std::vector<LivePoint>& points) {
    if (!block_) return;
    block_->AppendTo(points);
    paid_until_ += 2 * kPrice;
    block_.reset();
  }

 private:
  static constexpr double kPrice = 0.02;  // s

  std::optional<LiveExtremes> block_;  // from paid_until_ on, for the time of two points
  double paid_until_ = 0;              // s
  bool has_begun_ = false;
};

}  // namespace pendulum
