// SPDX-License-Identifier: Apache-2.0
#include "tools/progress_line.h"

#include <cmath>

#include "pendulum/base/staged_file.h"
#include "tools/output.h"

namespace pendulum {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(250);

double SecondsBetween(ProgressLine::Clock::time_point from, ProgressLine::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

std::string DurationText(double seconds) {
  constexpr long kMinute = 60, kHour = 3600;
  const long whole = std::lround(seconds);
  const auto two = [](long number) { return (number < 10 ? "0" : "") + std::to_string(number); };
  if (whole < kMinute) return std::to_string(whole) + " s";
  if (whole < kHour) return std::to_string(whole / kMinute) + " min " + two(whole % kMinute) + " s";
  return std::to_string(whole / kHour) + " h " + two(whole % kHour / kMinute) + " min";
}

std::string ProgressLineText(const ProgressStep& step, double elapsed, double in_step, std::size_t columns) {
  std::string text = step.what.empty() ? "working" : step.what;
  if (step.total > 1) text += " (" + std::to_string(step.done) + " of " + std::to_string(step.total) + " done)";
  text += ", " + DurationText(elapsed);
  if (step.done > 0 && step.done < step.total) {
    text += ", about " + DurationText(in_step / step.done * (step.total - step.done)) + " left";
  }
  return text.size() <= columns ? text : text.substr(0, columns);
}

ProgressLine::ProgressLine(int descriptor, std::chrono::milliseconds delay) : descriptor_(descriptor), delay_(delay) {
  if (CanRedraw(descriptor)) thread_ = std::jthread([this](const std::stop_token& stop) { Redraw(stop); });
}

ProgressLine::~ProgressLine() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  if (has_drawn_) WriteAll(descriptor_, "\r\x1b[K");
}

void ProgressLine::Show(const ProgressStep& step) {
  const std::lock_guard lock(mutex_);
  const bool continues = step.total > 0 && step.total == step_.total && step.done >= step_.done;
  if (!continues) step_begin_ = Clock::now();
  step_ = step;
}

void ProgressLine::Redraw(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto never = [] { return false; };
  for (auto wait = delay_; !stop.stop_requested(); wait = kRedraw) {
    changed_.wait_for(lock, stop, wait, never);
    if (stop.stop_requested()) return;
    const auto now = Clock::now();
    const std::size_t columns = SizeOfTerminal(descriptor_).columns;
    const std::string text =
        ProgressLineText(step_, SecondsBetween(begin_, now), SecondsBetween(step_begin_, now), columns - 1);
    has_drawn_ = true;
    lock.unlock();  // a terminal that takes no text must not stop the computation
    WriteAll(descriptor_, "\r" + text + "\x1b[K");
    lock.lock();
  }
}

}  // namespace pendulum
