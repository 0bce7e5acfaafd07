// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_progress.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <unistd.h>

#include "pendulum/base/format.h"
#include "pendulum/base/staged_file.h"

namespace pendulum {
namespace {

constexpr std::chrono::milliseconds kRedraw{200};

}  // namespace

std::string DurationText(double seconds) {
  constexpr long kMinute = 60, kHour = 3600;
  const long whole = std::lround(seconds);
  const auto two = [](long number) { return (number < 10 ? "0" : "") + std::to_string(number); };
  if (whole < kMinute) return std::to_string(whole) + " s";
  if (whole < kHour) return std::to_string(whole / kMinute) + " min " + two(whole % kMinute) + " s";
  return std::to_string(whole / kHour) + " h " + two(whole % kHour / kMinute) + " min";
}

std::string ProgressText(const RefitCounts& counts, double seconds) {
  constexpr int kDigits = 3;
  const auto done = static_cast<double>(counts.done());
  const double share = counts.runs > 0 ? done / static_cast<double>(counts.runs) : 1;
  std::string text = std::to_string(counts.done()) + " of " + std::to_string(counts.runs) + " runs (" +
                     std::to_string(static_cast<int>(100 * share)) + " %)";
  if (seconds > 0 && done > 0) {
    const double rate = done / seconds;
    text += ", " + NumberText(rate, kDigits) + " a second, " +
            DurationText(static_cast<double>(counts.runs - counts.done()) / rate) + " left";
  }
  if (counts.unfitted > 0) text += ", " + std::to_string(counts.unfitted) + " could not be fitted";
  return text;
}

RefitProgress::RefitProgress(std::string name, int descriptor, std::chrono::milliseconds between)
    : name_(std::move(name)),
      descriptor_(descriptor),
      is_terminal_(::isatty(descriptor) == 1),
      between_(is_terminal_ ? kRedraw : between) {}

void RefitProgress::Show(const RefitCounts& counts, Clock::time_point now) {
  if (now - last_ < between_) return;
  last_ = now;
  const std::string text = ProgressText(counts, std::chrono::duration<double>(now - begin_).count());
  if (!is_terminal_) {
    WriteAll(descriptor_, name_ + ": " + text + "\n");
    return;
  }
  constexpr int kWidth = 20;
  const auto full = static_cast<std::size_t>(counts.runs > 0 ? kWidth * counts.done() / counts.runs : kWidth);
  WriteAll(descriptor_, "\r[" + std::string(full, '#') + std::string(kWidth - full, '.') + "] " + text + "\x1b[K");
  has_drawn_ = true;
}

void RefitProgress::Finish() {
  if (std::exchange(has_drawn_, false)) WriteAll(descriptor_, "\r\x1b[K");
}

}  // namespace pendulum
