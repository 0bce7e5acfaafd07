// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/received_run.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pendulum {
namespace {

namespace wire = pendulum_logger;

std::span<const std::uint16_t> Sums(const wire::Data& frame) { return {frame.sums, frame.count}; }

/// A step above half the range of the 32-bit tick counter, 18 minutes, could also be a step back.
constexpr std::uint32_t kLongestGap = std::uint32_t{1} << 31;

/// How far a logger's clock may get ahead of the host's from one frame to the next, s. The host may have read the
/// previous frame late.
constexpr double kMaxAhead = 30;

constexpr std::uint16_t kSaturated = 65535;  // largest value of the counters in a frame

}  // namespace

std::optional<SamplingRate> NearestRate(double hz, int oversample) {
  if (oversample < 1 || oversample > wire::kMaxOversample || !(hz > 0)) return std::nullopt;
  const double period = std::round(wire::kTickHz / (hz * oversample));
  if (!(period >= wire::kMinPeriod && period <= wire::kMaxPeriod)) return std::nullopt;
  return SamplingRate{static_cast<std::uint16_t>(period), static_cast<std::uint8_t>(oversample)};
}

bool ReceivedRun::Fits(const wire::Data& frame, double host_time) const {
  if (frame.count == 0 || std::ranges::any_of(Sums(frame), [&](int sum) { return sum > LargestSum(); })) return false;
  if (ticks_.empty()) return true;
  const std::uint32_t step = frame.tick - last_tick_;
  const double ahead = static_cast<double>(step) / wire::kTickHz - (host_time - arrivals_.back().host_time);
  return step >= rate_.Ticks() && step < kLongestGap && step % rate_.period == 0 && ahead < kMaxAhead;
}

/// Records the samples missing before an accepted frame. Before the first frame, their number follows from the frame
/// number, later from the ticks. If frame numbers are missing, the samples were lost on the line, except those that the
/// logger reports as dropped.
void ReceivedRun::NoteGap(const wire::Data& frame) {
  const auto frames = static_cast<std::uint16_t>(frame.sequence - next_sequence_);
  std::int64_t missing = std::int64_t{frames} * wire::BlockSize(static_cast<std::uint32_t>(rate_.Ticks()));
  if (!ticks_.empty()) {
    const std::uint32_t step = frame.tick - last_tick_;
    missing = std::max<std::int64_t>(0, (step + rate_.Ticks() / 2) / rate_.Ticks() - 1);
  }
  if (missing == 0) return;
  const bool is_all_dropped = frames == 0 && frame.dropped == kSaturated;
  const std::int64_t unfound = is_all_dropped ? missing : frame.dropped - found_dropped_;
  const std::int64_t dropped = std::clamp<std::int64_t>(unfound, 0, missing);
  gaps_.push_back({size(), missing, frames == 0 ? 0 : missing - dropped});
  found_dropped_ += dropped;
}

bool ReceivedRun::AddFrame(const wire::Data& frame, double host_time) {
  if (!Fits(frame, host_time)) {
    ++contradicting_;
    return false;
  }
  NoteGap(frame);
  std::int64_t tick = ticks_.empty() ? 0 : ticks_.back() + std::int64_t{frame.tick - last_tick_};
  for (const std::uint16_t sum : Sums(frame)) {
    ticks_.push_back(tick);
    sums_.push_back(sum);
    tick += rate_.Ticks();
  }
  last_tick_ = static_cast<std::uint32_t>(frame.tick + (frame.count - 1) * rate_.Ticks());
  next_sequence_ = static_cast<std::uint16_t>(frame.sequence + 1);
  dropped_ = std::max<std::uint32_t>(dropped_, frame.dropped);
  late_ = std::max<std::uint32_t>(late_, frame.late);
  arrivals_.push_back({Time(size() - 1), host_time});
  return true;
}

double ReceivedRun::Time(std::size_t sample) const { return static_cast<double>(ticks_[sample]) / wire::kTickHz; }

double ReceivedRun::Counts(std::size_t sample) const { return static_cast<double>(sums_[sample]) / rate_.oversample; }

bool ReceivedRun::IsSaturated(std::size_t sample) const {
  return sums_[sample] < rate_.oversample || sums_[sample] > LargestSum() - rate_.oversample;
}

void ReceivedRun::KeepFirst(std::size_t samples) {
  if (samples >= size()) return;
  ticks_.resize(samples);
  sums_.resize(samples);
  std::erase_if(gaps_, [samples](const Gap& gap) { return gap.sample >= samples; });
  is_trimmed_ = true;
}

void ReceivedRun::KeepUntil(double time) {
  const double step = 1 / rate_.Hz();
  std::size_t samples = size();
  while (samples > 0 && Time(samples - 1) > time - 0.5 * step) --samples;
  if (samples == size()) return;
  const auto across = std::ranges::find(gaps_, samples, &Gap::sample);
  Gap gap = across == gaps_.end() ? Gap{samples, 0, 0} : *across;
  KeepFirst(samples);
  const double due = std::ceil(time / step - 0.5) - (samples == 0 ? 0 : std::round(Time(samples - 1) / step) + 1);
  gap.missing = std::min(gap.missing, static_cast<std::int64_t>(due));
  gap.on_line = std::min(gap.on_line, gap.missing);
  if (gap.missing > 0) gaps_.push_back(gap);
}

/// Losses after the last sample cause no gap; only End reports them.
RunLosses ReceivedRun::Losses() const {
  RunLosses losses{0, 0, late_, 0, contradicting_, end_.has_value()};
  for (const Gap& gap : gaps_) {
    losses.samples += gap.missing;
    losses.on_line += gap.on_line;
  }
  losses.dropped = static_cast<std::uint32_t>(std::min<std::int64_t>(dropped_, losses.samples - losses.on_line));
  if (is_trimmed_) return losses;
  losses.dropped = end_ ? end_->dropped : dropped_;
  losses.samples += std::max<std::int64_t>(0, losses.dropped - found_dropped_);
  if (!end_) return losses;
  losses.late = end_->late;
  const std::int64_t on_line = std::int64_t{end_->samples} - static_cast<std::int64_t>(size());
  losses.samples += std::max<std::int64_t>(0, on_line - losses.on_line);
  losses.on_line = std::max<std::int64_t>(0, on_line);
  return losses;
}

}  // namespace pendulum
