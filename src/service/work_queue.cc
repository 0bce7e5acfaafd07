// SPDX-License-Identifier: Apache-2.0
#include "service/work_queue.h"

#include <system_error>
#include <utility>

namespace pendulum::wire {

WorkQueue::WorkQueue(std::size_t threads, std::size_t max_waiting) {
  threads_.reserve(threads);
  try {
    while (threads_.size() < threads) threads_.emplace_back([this] { Run(); });
  } catch (const std::system_error&) {
    // Continues with the threads that could be started.
  }
  most_ = threads_.empty() ? 0 : threads_.size() + max_waiting;
}

WorkQueue::~WorkQueue() { Close(); }

bool WorkQueue::Offer(std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  if (is_closed_ || waiting_.size() + running_ >= most_) return false;
  waiting_.push_back(std::move(work));
  changed_.notify_one();
  return true;
}

void WorkQueue::Close() {
  std::deque<std::function<void()>> dropped;  // destroyed without the lock, before the wait for running work
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    dropped.swap(waiting_);
    changed_.notify_all();
  }
  dropped.clear();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

std::size_t WorkQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

std::size_t WorkQueue::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

void WorkQueue::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return is_closed_ || !waiting_.empty(); });
    if (is_closed_) return;
    std::function<void()> work = std::move(waiting_.front());
    waiting_.pop_front();
    ++running_;
    lock.unlock();
    work();
    work = nullptr;  // releases its objects before it counts as done
    lock.lock();
    --running_;
  }
}

}  // namespace pendulum::wire
