// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/sampling.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// With fewer samples per period, a turning point from a parabola through three samples is wrong by more than 1 % of
/// the amplitude.
constexpr double kMinPerPeriod = 8;

/// The recommended number of samples per period; turning points are then accurate to a thousandth of the amplitude.
constexpr double kGoodPerPeriod = 20;

/// With fewer levels peak to peak the amplitude is accurate only to some percent, regardless of the noise. Near rest
/// every swing has few levels.
constexpr double kMinCounts = 8;

/// If an interval is longer than this many typical intervals, readings are missing in it.
constexpr double kGap = 3;

/// If the jitter exceeds this share of the interval, methods that count samples instead of using time stamps fail.
constexpr double kMuchJitter = 0.1;

void DescribeIntervals(const Eigen::VectorXd& time, Sampling& sampling) {
  std::vector<double> intervals;
  for (Index i = 1; i < time.size(); ++i) intervals.push_back(time[i] - time[i - 1]);
  const double interval = Median(intervals);
  sampling.rate_hz = 1 / interval;
  for (const double step : intervals) {
    if (!(step > kGap * interval)) continue;
    ++sampling.gaps;
    sampling.longest_gap = std::max(sampling.longest_gap, step);
  }
  for (double& step : intervals) step = std::abs(step - interval);
  constexpr double kSigmaPerMedian = 1.4826;
  sampling.jitter = kSigmaPerMedian * Median(std::move(intervals));
}

void DescribeCounts(const Recording& used, Sampling& sampling) {
  constexpr Index kMinSamples = 8;
  const double q = used.resolution;
  const auto peak_to_peak = [](const auto& values) { return values.maxCoeff() - values.minCoeff(); };
  const auto in_period = static_cast<Index>(std::ceil(std::min(sampling.samples_per_period, 1e9)));
  const Index last = std::min(std::max(in_period, kMinSamples), used.size());
  if (q > 0) sampling.start_counts = std::round(peak_to_peak(used.value) / q);
  if (q > 0) sampling.end_counts = std::round(peak_to_peak(used.value.tail(last)) / q);
  if (!used.range) return;
  const auto [low, high] = *used.range;
  const double edge = q > 0 ? 0.5 * q : 1e-6 * (high - low);
  sampling.saturated = (used.value.array() >= high - edge || used.value.array() <= low + edge).count();
}

std::string Hz(double frequency) { return NumberText(frequency, 3) + " Hz"; }

std::string Advice(double frequency) { return "sample at least at " + Hz(kGoodPerPeriod * frequency); }

/// Explains why the readings appear to swing more slowly than the pendulum.
Warning AliasedWarning(const Sampling& sampling, double expected) {
  const double apparent = ApparentFrequency(expected, sampling.rate_hz);
  const double cycles = std::round(expected / sampling.rate_hz);
  constexpr double kStill = 0.01;  // of the rate: less than one swing in a hundred samples
  const bool still = apparent < kStill * sampling.rate_hz;
  std::string why = "between two samples the pendulum makes " + NumberText(expected / sampling.rate_hz, 3) +
                    " swings, and the samples do not show whole swings, so the readings seem to ";
  why += still ? "stand still"
               : "swing at |" + NumberText(expected, 3) + " - " + NumberText(cycles * sampling.rate_hz, 3) +
                     "| = " + Hz(apparent) + ", a period of " + NumberText(1 / apparent, 3) + " s";
  if (sampling.apparent_frequency_hz)
    why += " (" + NumberText(1 / *sampling.apparent_frequency_hz, 3) + " s in the readings)";
  return {.code = "aliased",
          .finding = "the expected frequency is " + Hz(expected) + ", but the readings were taken at " +
                     Hz(sampling.rate_hz) + ", less than two samples per swing",
          .explanation = why + "; periods and decrements from turning points are wrong",
          .advice = "use the fit; " + Advice(expected)};
}

void WarnOfAliasing(const Sampling& sampling, double expected, std::vector<Warning>& warnings) {
  const double low = (1 - kExpectedWithin) * expected;
  const double high = (1 + kExpectedWithin) * expected;
  if (expected > 0.5 * sampling.rate_hz) {
    warnings.push_back(AliasedWarning(sampling, expected));
  } else if (high > 0.5 * sampling.rate_hz) {
    warnings.push_back({.code = "nearly_aliased",
                        .finding = "the expected frequency is " + Hz(expected) + ", and the readings were taken at " +
                                   Hz(sampling.rate_hz) + ", hardly more than two samples per swing",
                        .advice = Advice(expected)});
  }
  if (!CanAliasWithinRange(low, high, sampling.rate_hz)) return;
  const double mirror = 0.5 * sampling.rate_hz * std::round(2 * expected / sampling.rate_hz);
  warnings.push_back({.code = "samples_near_period",
                      .finding = "sampled at " + Hz(sampling.rate_hz) + ", frequencies on both sides of " + Hz(mirror) +
                                 " look the same",
                      .explanation = "the pendulum's frequency, about " + Hz(expected) + ", may be on either side",
                      .advice = "sample faster, or at " + Hz(1.3 * sampling.rate_hz)});
}

void WarnOfTimes(const Sampling& sampling, std::vector<Warning>& warnings) {
  if (sampling.gaps > 0) {
    warnings.push_back({.code = "gaps",
                        .finding = "readings are missing in " + std::to_string(sampling.gaps) +
                                   (sampling.gaps == 1 ? " place" : " places") + ", for " +
                                   NumberText(sampling.longest_gap, 3) + " s at most",
                        .explanation = "the fit uses the time stamps and continues across these gaps, but turning "
                                       "points in them are missing"});
  }
  if (sampling.jitter * sampling.rate_hz > kMuchJitter) {
    warnings.push_back({.code = "jitter",
                        .finding = "the sampling intervals scatter by " + NumberText(1e3 * sampling.jitter, 3) +
                                   " ms about " + NumberText(1e3 / sampling.rate_hz, 3) + " ms",
                        .explanation = "the time stamps are used as they are",
                        .advice = "if the sensor was read at equal intervals and only stamped late, give --time_column "
                                  "none with --sample_rate_hz",
                        .flags = {"time_column", "sample_rate_hz"}});
  }
}

void WarnOfCounts(const Sampling& sampling, std::vector<Warning>& warnings) {
  if (!(sampling.start_counts > 0 && sampling.start_counts < kMinCounts)) return;
  warnings.push_back({.code = "few_counts",
                      .finding = "the swing spans only " + NumberText(sampling.start_counts) +
                                 " levels of the sensor at first and " + NumberText(sampling.end_counts) +
                                 " at the end, so turning points are inaccurate",
                      .advice = "release from a larger angle or use a sensor with a finer resolution"});
}

}  // namespace

double ApparentFrequency(double frequency_hz, double rate_hz) {
  return std::abs(frequency_hz - rate_hz * std::round(frequency_hz / rate_hz));
}

bool CanAliasWithinRange(double low_hz, double high_hz, double rate_hz) {
  return std::floor(2 * high_hz / rate_hz) >= std::max(std::ceil(2 * low_hz / rate_hz), 1.0);
}

Sampling DescribeSampling(const Recording& used, std::optional<double> half_period,
                          std::optional<double> expected_frequency) {
  Sampling sampling;
  DescribeIntervals(used.time, sampling);
  sampling.expected_frequency_hz = expected_frequency;
  if (half_period && *half_period > 0) sampling.apparent_frequency_hz = 0.5 / *half_period;
  // An aliased swing shows a wrong frequency.
  const double expected = expected_frequency.value_or(0);
  const bool aliases = (1 + kExpectedWithin) * expected > 0.5 * sampling.rate_hz;
  sampling.frequency_hz = aliases ? expected : sampling.apparent_frequency_hz.value_or(expected);
  if (sampling.frequency_hz > 0) {
    sampling.samples_per_period = sampling.rate_hz / sampling.frequency_hz;
    sampling.nyquist_margin = 0.5 * sampling.samples_per_period;
  }
  DescribeCounts(used, sampling);
  return sampling;
}

std::vector<Warning> SamplingWarnings(const Sampling& sampling) {
  std::vector<Warning> warnings;
  if (sampling.expected_frequency_hz) WarnOfAliasing(sampling, *sampling.expected_frequency_hz, warnings);
  const bool aliases = !warnings.empty();
  if (!aliases && sampling.frequency_hz > 0 && sampling.samples_per_period < kMinPerPeriod) {
    warnings.push_back(
        {.code = "slow_sampling",
         .finding = NumberText(sampling.samples_per_period, 2) +
                    " samples per period: turning points and closed-form estimates are inaccurate, but the fit is not",
         .advice = Advice(sampling.frequency_hz)});
  }
  WarnOfCounts(sampling, warnings);
  WarnOfTimes(sampling, warnings);
  return warnings;
}

}  // namespace pendulum
