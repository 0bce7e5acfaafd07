// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include <Eigen/Core>

#include "recording/uniform_clock.h"

/// Stamps that were printed with a number of significant digits, so that their steps grow with the time.
namespace pendulum {

/// The unit of the last of `digits` significant digits of a number other than 0: 0.01 for 1.23 and 3 digits.
inline double LastUnit(double number, int digits) {
  return std::pow(10.0, std::floor(std::log10(std::abs(number)) + 1e-12) - digits + 1);
}

/// The least number of significant digits, 2 to 8, with which all numbers can be printed; std::nullopt if there is
/// none.
inline std::optional<int> SignificantDigits(const Eigen::VectorXd& numbers) {
  constexpr int kMinDigits = 2, kMaxDigits = 8;
  const auto needs_more = [](double number, int digits) {
    if (number == 0) return false;
    const double units = number / LastUnit(number, digits);
    return std::abs(units - std::round(units)) > 1e-6;
  };
  int digits = kMinDigits;
  for (const double number : numbers) {
    while (needs_more(number, digits)) {
      if (++digits > kMaxDigits) return std::nullopt;
    }
  }
  return digits;
}

enum class DigitsRule { kRounded, kTruncated };

/// The intervals of stamps with this number of significant digits. A stamp of 0 is exact.
inline StampIntervals IntervalsOfDigits(const Eigen::VectorXd& stamps, int digits, DigitsRule rule) {
  constexpr double kMargin = 1e-6;  // a stamp halfway between two numbers may be rounded up or down
  StampIntervals intervals{stamps, stamps};
  for (Eigen::Index i = 0; i < stamps.size(); ++i) {
    if (stamps[i] == 0) continue;
    const double unit = LastUnit(stamps[i], digits);
    double inner = unit / 2, outer = unit / 2;  // towards 0, and away from it
    if (rule == DigitsRule::kTruncated) {
      inner = 0;
      outer = unit;
    } else if (std::abs(stamps[i]) < 1.0000001 * unit * std::pow(10.0, digits - 1)) {
      inner = unit / 20;  // below a power of ten, the unit is ten times smaller
    }
    const bool is_negative = stamps[i] < 0;
    intervals.low[i] -= (is_negative ? outer : inner) + kMargin * unit;
    intervals.high[i] += (is_negative ? inner : outer) + kMargin * unit;
  }
  return intervals;
}

}  // namespace pendulum
