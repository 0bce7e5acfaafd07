// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "pendulum/fitting/likelihood/noise.h"

/// The likelihood of the mean of n rounded readings (MODEL.md eq. (7.9) to (7.11)), in units of a count.
namespace pendulum {

/// From this σ on, in counts, rounding is independent noise: the expectation of a rounded reading differs from the
/// value by at most exp(-2π²σ²)/π = 2.6e-4 count. With 8 readings from 0.4 and with 32 from 0.3, the sum is taken for a
/// normal variable that has its expectation and variance.
inline constexpr double kContinuousSigma = 0.6;

/// A mean as the sum of its readings in whole counts from a level, and how it was taken.
struct CountSum {
  double sum = 0;                             ///< Whole number.
  int readings = 1;                           ///< n
  WindowMotion motion;                        ///< Counts.
  double low = -kInfinity, high = kInfinity;  ///< Whole counts: the ends of the sensor's range.
};

/// The sum for the mean y, in the unit of the noise; a mean that was rounded further is the nearest sum. Requires
/// kAveraged noise of one sample.
CountSum CountSumOf(const NoiseModel& noise, double y);

/// The value m of the middle of the window in counts from the level.
inline double InCounts(const NoiseModel& noise, double m) {
  return (m - noise.averaging.level) / noise.averaging.count;
}

/// Log-probability of a sum at the value x [counts], with the derivatives with respect to x and λ = ln σ.
/// `information` and the others are those of NoiseLikelihood.
///
/// Sums that are impossible, because each reading would be off by many σ, have the probability of an outlier: 1e-13
/// times a bell of 0.3 count. So the logarithm is finite and has a slope towards the sum.
NoiseLikelihood CountSumLikelihood(const CountSum& sum, double x, double sigma);

/// The same without the derivatives with respect to λ: log, score and information.
NoiseLikelihood CountSumSlope(const CountSum& sum, double x, double sigma);

/// The same without derivatives.
double CountSumLog(const CountSum& sum, double x, double sigma);

/// Probabilities of less than this sum, and of at most this sum.
NoiseModel::Distribution CountSumDistribution(const CountSum& sum, double x, double sigma);

/// Distance in counts from the value x to the nearest one at which a reading without noise would change; 0 if readings
/// without noise would not have this sum.
double CountSumMargin(const CountSum& sum, double x);

}  // namespace pendulum
