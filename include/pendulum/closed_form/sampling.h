// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/base/warning.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Relative error allowed for the frequency predicted from a rig. A rig's inertia from masses and lengths has an error
/// of some ten percent.
inline constexpr double kExpectedWithin = 0.15;

/// How a recording was sampled compared with the motion of the pendulum. Times and frequencies are on the recording's
/// clock.
struct Sampling {
  double rate_hz = 0;      ///< 1 / median interval.
  double jitter = 0;       ///< s, scatter of the intervals: 1.4826 times their median deviation.
  int gaps = 0;            ///< Intervals in which readings are missing.
  double longest_gap = 0;  ///< s
  /// Of the swing: the rig's frequency if it aliases or the apparent one is unknown, otherwise the apparent one. 0:
  /// unknown.
  double frequency_hz = 0;
  /// 0 if the frequency is unknown. nyquist_margin is (rate / 2) / frequency; below 1 the swing aliases.
  double samples_per_period = 0, nyquist_margin = 0;
  /// Peak-to-peak values of the largest swing and of the last period (at least 8 samples), in levels of the resolution;
  /// 0 without a resolution.
  double start_counts = 0, end_counts = 0;
  Eigen::Index saturated = 0;                                          ///< Readings at an end of the sensor's range.
  std::optional<double> apparent_frequency_hz, expected_frequency_hz;  ///< From the turning points, and from the rig.
};

/// The frequency [Hz] that samples of an oscillation appear to have: |f - k rate| for the nearest k, at most rate / 2
/// (MODEL.md eq. (6.13)). Shannon, Proc. IRE 37:10 (1949).
double ApparentFrequency(double frequency_hz, double rate_hz);

/// Whether two frequencies in [low, high] Hz can give the same equally spaced samples. This is so if [2 low / rate, 2
/// high / rate] contains an integer: frequencies on both sides of it mirror each other (MODEL.md eq. (6.14)).
bool CanAliasWithinRange(double low_hz, double high_hz, double rate_hz);

/// Describes the sampling of the samples used. half_period [s] comes from the turning points; for an aliased swing it
/// is an apparent one. expected_frequency [Hz] is the rig's at small amplitudes.
Sampling DescribeSampling(const Recording& used, std::optional<double> half_period,
                          std::optional<double> expected_frequency);

/// Problems of the sampling: aliased, nearly_aliased, samples_near_period (one or two samples per period),
/// slow_sampling, few_counts, gaps, jitter. Each message states the problem, its size and what to do.
std::vector<Warning> SamplingWarnings(const Sampling& sampling);

}  // namespace pendulum
