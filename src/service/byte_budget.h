// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <utility>

namespace pendulum::wire {

/// Limit for the bytes of bodies in memory, over all connections. For any thread.
class ByteBudget {
 public:
  explicit ByteBudget(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  bool is_full() const { return taken_ >= max_bytes_; }
  bool is_exceeded() const { return taken_ > max_bytes_; }  ///< Only answers can exceed the limit.
  std::size_t taken() const { return taken_; }

 private:
  friend class HeldBytes;

  std::size_t max_bytes_;
  std::atomic<std::size_t> taken_ = 0;
};

/// The part of a budget that one body uses, until destruction.
class HeldBytes {
 public:
  explicit HeldBytes(ByteBudget& budget) : budget_(&budget) {}
  HeldBytes(HeldBytes&& other) noexcept : budget_(other.budget_), bytes_(std::exchange(other.bytes_, 0)) {}
  HeldBytes& operator=(HeldBytes&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  HeldBytes(const HeldBytes&) = delete;
  HeldBytes& operator=(const HeldBytes&) = delete;
  ~HeldBytes() { Release(); }

  /// Takes more bytes; false, without a change, if the budget has too few.
  bool Take(std::size_t bytes) {
    if (budget_->taken_.fetch_add(bytes) + bytes > budget_->max_bytes_) {
      budget_->taken_ -= bytes;
      return false;
    }
    bytes_ += bytes;
    return true;
  }

  /// Takes more bytes without a check: the answer already exists.
  void Add(std::size_t bytes) {
    budget_->taken_ += bytes;
    bytes_ += bytes;
  }

  void Release() { budget_->taken_ -= std::exchange(bytes_, 0); }

 private:
  ByteBudget* budget_;
  std::size_t bytes_ = 0;
};

}  // namespace pendulum::wire
