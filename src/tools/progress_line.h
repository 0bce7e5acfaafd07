// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "pendulum/base/progress.h"

namespace pendulum {

/// Says on a terminal what a long computation does, how far it is and how long it still takes. The line appears after
/// two seconds, is redrawn four times a second and is cleared at the end. Nothing is written where lines cannot be
/// redrawn: to a file, a pipe or a terminal without cursor control.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  /// `descriptor`: for the output, such as STDERR_FILENO. `delay`: time without a line at first.
  explicit ProgressLine(int descriptor, std::chrono::milliseconds delay = std::chrono::seconds(2));
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// Clears the line.
  ~ProgressLine();

  /// Sets what the line shows. Any thread may call it.
  void Show(const ProgressStep& step);

  /// A sink that shows each step. It must not be called after the line's end.
  ProgressSink Sink() {
    return [this](const ProgressStep& step) { Show(step); };
  }

 private:
  void Redraw(const std::stop_token& stop);

  const int descriptor_;
  const std::chrono::milliseconds delay_;
  const Clock::time_point begin_ = Clock::now();
  std::mutex mutex_;
  ProgressStep step_;                      // guarded by mutex_, as the next two
  Clock::time_point step_begin_ = begin_;  // of the first of its parts
  bool has_drawn_ = false;
  std::condition_variable_any changed_;
  std::jthread thread_;
};

/// A duration as text: "42 s", "3 min 05 s", "2 h 10 min".
std::string DurationText(double seconds);

/// "fitting stribeck (2 of 5 done), 12 s, about 18 s left", at most `columns` wide. elapsed: since the computation
/// began; in_step: since its present step began [s].
std::string ProgressLineText(const ProgressStep& step, double elapsed, double in_step, std::size_t columns);

}  // namespace pendulum
