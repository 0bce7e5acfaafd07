// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/quantity_text.h"

#include <cmath>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"

namespace pendulum {

std::string ValueText(const Distribution& distribution, double value) {
  constexpr int kFewest = 3, kMost = 6;
  const double median = distribution.median;
  if (median == 0 || !(distribution.std_dev > 0)) return NumberText(value, kMost);
  const Rounding rounding = PdgRounding(median, distribution.std_dev);
  const bool is_enough = SignificantDigits(median, rounding) >= kFewest;
  return RoundedText(value, is_enough ? rounding : SignificantRounding(median, kFewest));
}

std::string SpreadText(const std::optional<double>& size) {
  constexpr int kDigits = 2;
  if (!size) return "-";
  return *size > 0 ? RoundedText(*size, SignificantRounding(*size, kDigits)) : "0";
}

std::string DistanceText(double z) {
  constexpr int kDigits = 3;
  return std::isfinite(z) ? NumberText(z, kDigits) : "-";
}

std::string RatioText(double ratio) {
  constexpr int kDigits = 3;
  return std::isfinite(ratio) ? NumberText(ratio, kDigits) : "-";
}

}  // namespace pendulum
