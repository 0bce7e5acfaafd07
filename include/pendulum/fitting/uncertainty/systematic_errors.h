// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace pendulum {

/// What systematic errors come from.
enum class ErrorSource { kRig, kCalibration, kClock, kSensor, kInconstancy, kFrictionLaw };

inline constexpr std::array kErrorSources = {ErrorSource::kRig,         ErrorSource::kCalibration,
                                             ErrorSource::kClock,       ErrorSource::kSensor,
                                             ErrorSource::kInconstancy, ErrorSource::kFrictionLaw};

/// "rig", "calibration", "clock", "sensor", "inconstancy", "friction_law".
std::string_view ErrorSourceName(ErrorSource source);

/// The systematic errors of one quantity: a standard deviation for each source, in the quantity's unit. Sources are
/// independent of each other.
class SystematicErrors {
 public:
  double Of(ErrorSource source) const { return std_dev_[static_cast<std::size_t>(source)]; }

  /// The errors by which recordings of one rig differ although nothing outside them does: parameters that change, and
  /// friction of another law.
  double OfMotion() const;

  /// Adds an independent error of the source in quadrature. std_dev >= 0
  void Add(ErrorSource source, double std_dev);

  /// The errors of this quantity times a factor.
  SystematicErrors Scaled(double factor) const;

  /// All sources in quadrature; absent if no source has an error.
  std::optional<double> Total() const;

 private:
  std::array<double, kErrorSources.size()> std_dev_{};
};

/// The statistical and the systematic error in quadrature. Absent if there is no statistical error, because a total
/// without it would be too small.
std::optional<double> TotalStdError(const std::optional<double>& std_error, const SystematicErrors& systematic);

enum class IntervalEnd { kLower, kUpper };

/// An end of the total 95 % interval: the distance from the estimate to this end of the statistical interval, and 1.96
/// systematic errors, in quadrature. Absent if the statistical interval has no such end.
std::optional<double> TotalIntervalEnd(IntervalEnd end, double estimate, const std::optional<double>& end95,
                                       const SystematicErrors& systematic);

}  // namespace pendulum
