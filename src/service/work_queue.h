// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace pendulum::wire {

/// Runs work on a few threads, first come, first served, with a limit for waiting work. For any thread.
class WorkQueue {
 public:
  /// Throws std::system_error if no thread can be started.
  WorkQueue(std::size_t threads, std::size_t max_waiting);
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;
  WorkQueue(WorkQueue&&) = delete;
  WorkQueue& operator=(WorkQueue&&) = delete;
  ~WorkQueue();

  /// Queues work. False if all threads are busy and the queue is full, or if it is closed. `work` must not throw.
  bool Offer(std::function<void()> work);

  /// Drops waiting work and returns when running work is done.
  void Close();

  std::size_t waiting() const;
  std::size_t running() const;

 private:
  void Run();

  std::size_t most_ = 0;  ///< Limit for running and waiting work.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::size_t running_ = 0;
  bool is_closed_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace pendulum::wire
