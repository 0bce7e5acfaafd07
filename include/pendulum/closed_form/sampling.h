// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/recording/recording.h"

namespace pendulum {

/// A rig's inertia from masses and lengths is good to some ten percent: its frequency to this share.
inline constexpr double kExpectedWithin = 0.15;

/// How a recording was sampled, beside how fast the pendulum swings. Times and frequencies are those of its clock.
struct Sampling {
  double rate_hz = 0;       ///< One over the median interval.
  double jitter = 0;        ///< s, scatter of the intervals: 1.4826 times their median deviation.
  int gaps = 0;             ///< Intervals in which readings are missing.
  double longest_gap = 0;   ///< s
  double frequency_hz = 0;  ///< Of the swing: expected where that aliases, else seen; 0: unknown.
  /// 0: unknown frequency. nyquist_margin is (rate / 2) / frequency; below 1 the swing aliases.
  double samples_per_period = 0, nyquist_margin = 0;
  /// Peak to peak in resolutions, 0 without one: the largest swing; the last period (8 samples at least).
  double start_counts = 0, end_counts = 0;
  Eigen::Index saturated = 0;                                      ///< Readings at an end of the sensor's range.
  std::optional<double> seen_frequency_hz, expected_frequency_hz;  ///< Of the turning points; of the rig.
};

/// The frequency [Hz] at which samples of one frequency seem to swing: |f - k rate| for the nearest k, at most rate / 2
/// (MODEL.md eq. (44)). Shannon, Proc. IRE 37:10 (1949).
double ApparentFrequency(double frequency_hz, double rate_hz);

/// Whether two frequencies of [low, high] Hz may look the same at even samples: [2 low / rate, 2 high / rate] holds an
/// integer, where the frequencies to both sides of it mirror each other (MODEL.md eq. (45)).
bool HoldsMirror(double low_hz, double high_hz, double rate_hz);

/// Measures the sampling of the samples that were used. half_period [s] as the turning points show it, which of an
/// aliased swing is an apparent one; expected_frequency [Hz] of the rig at small amplitudes.
Sampling DescribeSampling(const Recording& used, std::optional<double> half_period,
                          std::optional<double> expected_frequency);

/// What a user should change: aliased, nearly_aliased, once_a_cycle (and twice), slow_sampling, few_counts, gaps,
/// jitter; each says what, how much and what to do.
std::vector<Warning> SamplingWarnings(const Sampling& sampling);

}  // namespace pendulum
