// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <pendulum_logger/frame.h>

#include "pendulum/acquisition/device_clock.h"

namespace pendulum {

/// What a logger's converter shows of its reference voltage and beyond, counts.
inline constexpr int kFullScaleCounts = (1 << pendulum_logger::kAdcBits) - 1;

/// When a logger samples: a conversion every `period` ticks, `oversample` of them added up to a sample.
struct SamplingRate {
  std::uint16_t period = 10000;
  std::uint8_t oversample = 1;

  std::int64_t Ticks() const { return std::int64_t{period} * oversample; }  ///< Between samples.
  double Hz() const { return static_cast<double>(pendulum_logger::kTickHz) / static_cast<double>(Ticks()); }
};

/// The rate of so many samples a second that the logger comes nearest to; none where it cannot: it makes 32 to 8000
/// conversions a second.
std::optional<SamplingRate> NearestRate(double hz, int oversample);

/// What is missing in a run.
struct RunLosses {
  std::int64_t samples = 0;      ///< All that are missing: by time stamps, and behind the last one by the End.
  std::uint32_t dropped = 0;     ///< Of them, in the logger: the line was too slow.
  std::uint32_t late = 0;        ///< Conversions that could not begin in time.
  std::int64_t on_line = 0;      ///< Of them, on the way: by the numbers of the frames, or by what the logger sent.
  int contradicting_frames = 0;  ///< Left out: right by their CRC, and impossible in this run.
  bool is_end_known = false;     ///< The logger has said how many it sent.
};

/// The samples of a run, put together from frames as they come. Their times are those the logger's timer had when it
/// triggered them, so a frame that is lost leaves a gap and moves nothing.
class ReceivedRun {
 public:
  explicit ReceivedRun(const SamplingRate& rate) : rate_(rate) {}

  /// Takes a frame that was complete at that time of the host [s]; false, and nothing is taken, where it contradicts
  /// the run: not later than the samples before, much later than the host's time allows, off the grid of conversions,
  /// or more than the converter can give.
  bool Take(const pendulum_logger::Data& frame, double host_time);

  void TakeEnd(const pendulum_logger::End& end) { end_ = end; }

  /// Forgets the samples behind the first so many, and what was lost behind them. Nothing is taken after that.
  void KeepFirst(std::size_t samples);

  /// The same for the samples from that time on [s on the logger's clock].
  void KeepUntil(double time);

  std::size_t size() const { return ticks_.size(); }

  /// Since the first sample, s on the logger's clock.
  double Time(std::size_t sample) const;

  /// The mean of a sample's conversions.
  double Counts(std::size_t sample) const;

  /// Whether one of the sample's conversions at least is an end of what the converter can show.
  bool IsSaturated(std::size_t sample) const;

  RunLosses Losses() const;

  const SamplingRate& rate() const { return rate_; }

  /// When the last sample of each frame was taken, and when the frame had come.
  const std::vector<Arrival>& arrivals() const { return arrivals_; }

 private:
  /// What is missing before a sample.
  struct Gap {
    std::size_t sample;
    std::int64_t missing, on_line;
  };

  bool Fits(const pendulum_logger::Data& frame, double host_time) const;
  void NoteGap(const pendulum_logger::Data& frame);
  int LargestSum() const { return kFullScaleCounts * rate_.oversample; }

  SamplingRate rate_;
  std::vector<std::int64_t> ticks_;  // N, since the first
  std::vector<std::uint16_t> sums_;  // N
  std::vector<Arrival> arrivals_;
  std::vector<Gap> gaps_;
  std::uint32_t last_tick_ = 0;      // of the last sample, modulo 2^32
  std::uint16_t next_sequence_ = 0;  // of the next frame
  std::uint32_t dropped_ = 0, late_ = 0;
  std::int64_t found_dropped_ = 0;  // of those dropped, how many the gaps have shown: a frame may tell of them before
  int contradicting_ = 0;
  std::optional<pendulum_logger::End> end_;
  bool is_trimmed_ = false;
};

}  // namespace pendulum
