// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "pendulum/base/parallel.h"
#include "sample_kernel.h"

namespace pendulum {

/// Brings the stretches of a trajectory, as they are traced, to the samples of a recording, block by block: kBlock
/// consecutive samples, whatever the stretches. Blocks are worked on by as many threads as there are; what they give
/// (Part) is added up in their order, so that a sum does not depend on the number of threads.
template <int W, int R, typename Part>
class BlockSamples {
 public:
  /// What a stretch says of the samples from `first` on, up to the next one's first.
  struct Piece {
    double start = 0;
    std::size_t first = 0;
    Polynomials<W> polynomials;
  };

  void Restart(std::span<const double> time, int threads) {
    time_ = time;
    threads_ = ThreadsOrCores(threads);
    used_ = 0;
    next_ = done_ = 0;
  }

  /// A piece for the samples before `end` that no piece was for yet, or null when there are none.
  Piece* Add(double start, double end) {
    std::size_t next = next_;
    while (next < time_.size() && time_[next] < end) ++next;
    if (next == next_) return nullptr;
    if (used_ == pieces_.size()) pieces_.emplace_back();
    Piece& piece = pieces_[used_++];
    piece.start = start;
    piece.first = next_;
    next_ = next;
    return &piece;
  }

  bool is_complete() const { return next_ == time_.size(); }

  /// Works on full blocks once there are enough of them to share, or `all` there are: evaluates rows 0 to W - 1 of
  /// each, calls work(SampleBlock<R>&, first sample, count, Part&), then add(Part) in the blocks' order.
  template <typename Work, typename Add>
  void Flush(bool all, const Work& work, const Add& add) {
    constexpr std::size_t kMostPieces = 4096;
    const std::size_t ready = all ? (next_ - done_ + kBlock - 1) / kBlock : (next_ - done_) / kBlock;
    const std::size_t wanted = threads_ == 1 ? 1 : kShare * static_cast<std::size_t>(threads_);
    if (ready == 0 || (!all && ready < wanted && used_ < kMostPieces)) return;
    if (parts_.size() < ready) parts_.resize(ready);
    const auto one = [&](int b) {
      const std::size_t first = done_ + static_cast<std::size_t>(b) * kBlock;
      WorkOn(first, std::min<std::size_t>(kBlock, next_ - first), work, parts_[static_cast<std::size_t>(b)]);
    };
    const int worth = static_cast<int>(std::max<std::size_t>(ready / kShare, 1));
    ParallelFor(static_cast<int>(ready), std::min(worth, threads_), std::ref(one));
    for (std::size_t b = 0; b < ready; ++b) add(parts_[b]);
    done_ = std::min(done_ + ready * kBlock, next_);
    const auto left = PieceOf(done_);
    used_ = static_cast<std::size_t>(std::move(left, End(), pieces_.begin()) - pieces_.begin());
  }

 private:
  static constexpr std::size_t kShare = 128;  ///< Blocks that are worth a thread: some hundred microseconds.

  auto End() { return pieces_.begin() + static_cast<std::ptrdiff_t>(used_); }

  auto PieceOf(std::size_t sample) {
    if (sample == next_) return End();
    return std::ranges::upper_bound(pieces_.begin(), End(), sample, {}, &Piece::first) - 1;
  }

  template <typename Work>
  void WorkOn(std::size_t first, std::size_t count, const Work& work, Part& part) {
    SampleBlock<R> block;
    std::array<double, kBlockStride> tau{};
    for (auto piece = PieceOf(first); piece != End() && piece->first < first + count; ++piece) {
      const std::size_t begin = std::max(piece->first, first);
      const std::size_t end = std::min(piece + 1 == End() ? next_ : (piece + 1)->first, first + count);
      for (std::size_t i = begin; i < end; ++i) tau[i - begin] = time_[i] - piece->start;
      EvaluateAt(piece->polynomials, tau.data(), static_cast<int>(end - begin), block.row[0].data() + (begin - first));
    }
    work(block, first, static_cast<int>(count), part);
  }

  std::span<const double> time_;
  int threads_ = 1;
  std::vector<Piece> pieces_;  ///< The first used_ of them; the others are room.
  std::size_t used_ = 0;
  std::size_t next_ = 0;  ///< The first sample that no piece was for.
  std::size_t done_ = 0;  ///< The first sample that was not worked on.
  std::vector<Part> parts_;
};

}  // namespace pendulum
