// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/time_limit.h"

namespace pendulum {

TimeLimit::TimeLimit(std::chrono::milliseconds limit)
    : limit_(limit), thread_([this](const std::stop_token& stop) { Work(stop); }) {}

TimeLimit::Watch::Watch(TimeLimit& limit, const std::stop_token& other)
    : limit_(limit), number_(limit.Begin(*this)), other_(other, [this] { source_.request_stop(); }) {}

TimeLimit::Watch::~Watch() {
  const std::scoped_lock lock(limit_.mutex_);
  limit_.running_.erase(number_);
}

std::uint64_t TimeLimit::Begin(Watch& watch) {
  const std::scoped_lock lock(mutex_);
  running_.emplace(next_, Running{Clock::now() + limit_, &watch});
  if (all_stopped_ || limit_ <= std::chrono::milliseconds::zero()) watch.source_.request_stop();
  changed_.notify_one();
  return next_++;
}

void TimeLimit::StopAll() {
  const std::scoped_lock lock(mutex_);
  all_stopped_ = true;
  for (const auto& [number, running] : running_) running.watch->source_.request_stop();
}

void TimeLimit::Work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    std::uint64_t due = next_;  // the first one that was not stopped
    Clock::time_point end = Clock::time_point::max();
    for (const auto& [number, running] : running_) {
      if (running.watch->source_.stop_requested()) continue;
      due = number;
      end = running.end;
      break;
    }
    if (end == Clock::time_point::max()) {
      changed_.wait(lock, stop, [&] { return next_ != due; });
    } else if (Clock::now() < end) {
      changed_.wait_until(lock, stop, end, [] { return false; });
    } else if (const auto found = running_.find(due); found != running_.end()) {
      found->second.watch->source_.request_stop();
    }
  }
}

}  // namespace pendulum
