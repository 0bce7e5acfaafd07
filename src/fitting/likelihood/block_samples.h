// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "fitting/likelihood/sample_kernel.h"
#include "pendulum/base/parallel.h"

namespace pendulum {

/// Evaluates the segments of a trajectory at the samples of a recording, in blocks of kBlock consecutive samples that
/// do not depend on the segments. For a long recording, segments are stored until there are enough blocks for several
/// threads. The results of the blocks (Part) are added in order, so a sum does not depend on the number of threads. A
/// block has R rows; EvaluateAt fills the first rows.
template <typename T, bool kRelease, int R, typename Part>
class BlockSamples {
 public:
  void Restart(std::span<const double> time, int threads) {
    time_ = time;
    threads_ = time.size() < 2 * kBlocksPerThread * kBlock ? 1 : ThreadsOrCores(threads);
    samples_per_second_ = time.size() < 2 ? 0 : static_cast<double>(time.size() - 1) / (time.back() - time.front());
    stored_ = 0;
    next_ = done_ = 0;
  }

  /// Evaluates the segment at the samples before its end that no earlier segment covered. For each complete block it
  /// calls work(SampleBlock<R>&, first sample, count, Part&), then add(Part).
  template <typename Work, typename Add>
  void AddSegment(const Segment<T>& segment, const Work& work, const Add& add) {
    const std::size_t first = next_;
    next_ = FirstNotBefore(segment.end);
    if (next_ == first) return;
    if (threads_ > 1) {
      StoreSegment(segment, first);
      WorkOnFullBlocks(work, add);
      return;
    }
    for (std::size_t begin = first; begin < next_;) {
      const std::size_t block = begin / kBlock * kBlock;
      const std::size_t end = std::min(next_, block + kBlock);
      Evaluate(segment, begin, end, block_, block);
      begin = end;
      if (end < std::min(time_.size(), block + kBlock)) break;
      work(block_, block, static_cast<int>(end - block), part_);
      add(part_);
    }
  }

  bool is_complete() const { return next_ == time_.size(); }

 private:
  static constexpr std::size_t kBlocksPerThread = 128;  ///< Work of some hundred microseconds.

  /// A segment and the first sample it covers; it covers samples up to the first one of the next segment.
  struct StoredSegment {
    std::size_t first = 0;
    Segment<T> segment;
  };

  /// Index of the first sample from next_ on that is not before `end` [s]. Starts from the position it would have with
  /// even spacing.
  std::size_t FirstNotBefore(double end) const {
    if (next_ == time_.size() || !(time_[next_] < end)) return next_;
    const double guess = (end - time_[next_]) * samples_per_second_;
    std::size_t sample = next_ + static_cast<std::size_t>(std::min(guess, static_cast<double>(time_.size() - next_)));
    while (sample > next_ && !(time_[sample - 1] < end)) --sample;
    while (sample < time_.size() && time_[sample] < end) ++sample;
    return sample;
  }

  /// Evaluates samples `begin` to end - 1 of the block that starts with sample `first`.
  void Evaluate(const Segment<T>& segment, std::size_t begin, std::size_t end, SampleBlock<R>& block,
                std::size_t first) const {
    double* const rows = block.row[0].data() + (begin - first);
    EvaluateAt<kRelease>(segment, &time_[begin], static_cast<int>(end - begin), rows);
  }

  void StoreSegment(const Segment<T>& segment, std::size_t first) {
    if (stored_ == segments_.size()) segments_.emplace_back();
    segments_[stored_++] = {first, segment};
  }

  /// Works on all full blocks once there are enough of them, and on the remainder after the last sample.
  template <typename Work, typename Add>
  void WorkOnFullBlocks(const Work& work, const Add& add) {
    constexpr std::size_t kMaxStored = 4096;
    const std::size_t ready = is_complete() ? (next_ - done_ + kBlock - 1) / kBlock : (next_ - done_) / kBlock;
    const std::size_t wanted = kBlocksPerThread * static_cast<std::size_t>(threads_);
    if (ready == 0 || (!is_complete() && ready < wanted && stored_ < kMaxStored)) return;
    if (parts_.size() < ready) parts_.resize(ready);
    const auto one = [&](int b) {
      const std::size_t first = done_ + static_cast<std::size_t>(b) * kBlock;
      WorkOn(first, std::min<std::size_t>(kBlock, next_ - first), work, parts_[static_cast<std::size_t>(b)]);
    };
    const int useful_threads = static_cast<int>(std::max<std::size_t>(ready / kBlocksPerThread, 1));
    ParallelFor(static_cast<int>(ready), std::min(useful_threads, threads_), std::ref(one));
    for (std::size_t b = 0; b < ready; ++b) add(parts_[b]);
    done_ = std::min(done_ + ready * kBlock, next_);
    const auto left = StoredSegmentFor(done_);
    stored_ = static_cast<std::size_t>(std::move(left, End(), segments_.begin()) - segments_.begin());
  }

  auto End() { return segments_.begin() + static_cast<std::ptrdiff_t>(stored_); }

  auto StoredSegmentFor(std::size_t sample) {
    if (sample == next_) return End();
    return std::ranges::upper_bound(segments_.begin(), End(), sample, {}, &StoredSegment::first) - 1;
  }

  template <typename Work>
  void WorkOn(std::size_t first, std::size_t count, const Work& work, Part& part) {
    SampleBlock<R> block;
    for (auto stored = StoredSegmentFor(first); stored != End() && stored->first < first + count; ++stored) {
      const std::size_t begin = std::max(stored->first, first);
      const std::size_t end = std::min(stored + 1 == End() ? next_ : (stored + 1)->first, first + count);
      Evaluate(stored->segment, begin, end, block, first);
    }
    work(block, first, static_cast<int>(count), part);
  }

  std::span<const double> time_;
  int threads_ = 1;
  double samples_per_second_ = 0;
  std::size_t next_ = 0;  ///< The first sample that no segment has covered yet.
  SampleBlock<R> block_;
  Part part_{};
  std::size_t done_ = 0;                 ///< The first sample not yet worked on, if segments are stored.
  std::vector<StoredSegment> segments_;  ///< Only the first stored_ are in use; the remaining ones are spare memory.
  std::size_t stored_ = 0;
  std::vector<Part> parts_;
};

}  // namespace pendulum
