// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <stop_token>
#include <thread>

namespace pendulum {

/// Requests a stop of work that exceeds a time limit. For any thread.
class TimeLimit {
 public:
  /// With a limit of 0, a stop is requested before the work begins.
  explicit TimeLimit(std::chrono::milliseconds limit);
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  TimeLimit(TimeLimit&&) = delete;
  TimeLimit& operator=(TimeLimit&&) = delete;
  ~TimeLimit() = default;

  /// Limits one piece of work, from construction to destruction.
  class Watch {
   public:
    /// `other`: a further reason to stop.
    explicit Watch(TimeLimit& limit, const std::stop_token& other = {});
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    Watch(Watch&&) = delete;
    Watch& operator=(Watch&&) = delete;
    ~Watch();

    /// A stop is requested at the time limit, by StopAll, or by the other reason.
    std::stop_token token() const { return source_.get_token(); }

   private:
    friend class TimeLimit;
    TimeLimit& limit_;
    std::stop_source source_;
    std::uint64_t number_;
    std::stop_callback<std::function<void()>> other_;  // last member: it uses source_
  };

  /// Stops all current and future work.
  void StopAll();

  std::chrono::milliseconds limit() const { return limit_; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Running {
    Clock::time_point end;
    Watch* watch;
  };

  std::uint64_t Begin(Watch& watch);
  void Work(const std::stop_token& stop);

  std::chrono::milliseconds limit_;
  std::mutex mutex_;  // for all members below
  std::condition_variable_any changed_;
  std::map<std::uint64_t, Running> running_;  // In the order of ends, because all have the same limit.
  std::uint64_t next_ = 0;
  bool all_stopped_ = false;
  std::jthread thread_;  // last member, so it is joined before the others are destroyed
};

}  // namespace pendulum
