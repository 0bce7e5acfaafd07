// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <pendulum_logger/frame.h>

#include "pendulum/acquisition/device_clock.h"

namespace pendulum {

/// The reading of the converter at its reference voltage and above, counts.
inline constexpr int kFullScaleCounts = (1 << pendulum_logger::kAdcBits) - 1;

/// When a logger samples: one conversion every `period` ticks; a sample is the sum of `oversample` conversions.
struct SamplingRate {
  std::uint16_t period = 10000;
  std::uint8_t oversample = 1;

  std::int64_t Ticks() const { return std::int64_t{period} * oversample; }  ///< Ticks between samples.
  double Hz() const { return static_cast<double>(pendulum_logger::kTickHz) / static_cast<double>(Ticks()); }
};

/// The possible rate nearest to `hz`. std::nullopt if there is none: a logger makes 32 to 8000 conversions per second.
std::optional<SamplingRate> NearestRate(double hz, int oversample);

/// The losses of a run.
struct RunLosses {
  std::int64_t samples = 0;      ///< All missing samples: in gaps of the time stamps, and after the last sample.
  std::uint32_t dropped = 0;     ///< Samples that the logger dropped because the line was too slow.
  std::uint32_t late = 0;        ///< Conversions that could not start in time.
  std::int64_t on_line = 0;      ///< Samples lost on the line, from frame numbers or the reported total.
  int contradicting_frames = 0;  ///< Frames left out: their CRC is right, but they are impossible in this run.
  bool is_end_known = false;     ///< The logger has reported how many samples it sent.
};

/// The samples of a run, assembled from frames in the order of arrival. Sample times come from the logger's timer, so a
/// lost frame leaves a gap and does not shift later samples.
class ReceivedRun {
 public:
  explicit ReceivedRun(const SamplingRate& rate) : rate_(rate) {}

  /// Adds a frame that was completely received at `host_time` [s]. Returns false and ignores the frame if it
  /// contradicts the run: it is not later than the previous samples, much later than the host's time allows, off the
  /// grid of conversions, or contains more counts than the converter can give.
  bool AddFrame(const pendulum_logger::Data& frame, double host_time);

  void SetEnd(const pendulum_logger::End& end) { end_ = end; }

  /// Keeps the first `samples` samples and forgets later ones and the losses after them. Do not add frames afterwards.
  void KeepFirst(std::size_t samples);

  /// Keeps the samples before `time` [s on the logger's clock], like KeepFirst.
  void KeepUntil(double time);

  std::size_t size() const { return ticks_.size(); }

  /// Time since the first sample, s on the logger's clock.
  double Time(std::size_t sample) const;

  /// The mean of the sample's conversions, counts.
  double Counts(std::size_t sample) const;

  /// Whether at least one of the sample's conversions is at an end of the converter's range.
  bool IsSaturated(std::size_t sample) const;

  RunLosses Losses() const;

  const SamplingRate& rate() const { return rate_; }

  /// One entry for each frame: when its last sample was taken, and when the frame was received.
  const std::vector<Arrival>& arrivals() const { return arrivals_; }

 private:
  /// The missing samples before a sample.
  struct Gap {
    std::size_t sample;
    std::int64_t missing, on_line;
  };

  bool Fits(const pendulum_logger::Data& frame, double host_time) const;
  void NoteGap(const pendulum_logger::Data& frame);
  int LargestSum() const { return kFullScaleCounts * rate_.oversample; }

  SamplingRate rate_;
  std::vector<std::int64_t> ticks_;  // N, since the first sample
  std::vector<std::uint16_t> sums_;  // N
  std::vector<Arrival> arrivals_;
  std::vector<Gap> gaps_;
  std::uint32_t last_tick_ = 0;      // tick of the last sample, modulo 2^32
  std::uint16_t next_sequence_ = 0;  // expected number of the next frame
  std::uint32_t dropped_ = 0, late_ = 0;
  std::int64_t found_dropped_ = 0;  // Dropped samples that gaps explain so far; drops may be reported before their gap.
  int contradicting_ = 0;
  std::optional<pendulum_logger::End> end_;
  bool is_trimmed_ = false;
};

}  // namespace pendulum
